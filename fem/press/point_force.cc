#include "fem/press/point_force.h"

#include <cmath>
#include <unsupported/Eigen/AutoDiff>

namespace densify::fem {

namespace {

using Active = Eigen::AutoDiffScalar<Vec10>;  // a number with its derivatives by F and the volume ratio

template <class Number>
using Tensor = Eigen::Matrix<Number, 3, 3>;

template <class Number>
Number determinant(const Tensor<Number>& a) {
  return a(0, 0) * (a(1, 1) * a(2, 2) - a(1, 2) * a(2, 1)) - a(0, 1) * (a(1, 0) * a(2, 2) - a(1, 2) * a(2, 0)) +
         a(0, 2) * (a(1, 0) * a(2, 1) - a(1, 1) * a(2, 0));
}

/// Of cofactors, so that a^-T = cofactors/determinant.
template <class Number>
Tensor<Number> cofactors(const Tensor<Number>& a) {
  Tensor<Number> c;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      const int k = (i + 1) % 3, l = (i + 2) % 3, m = (j + 1) % 3, n = (j + 2) % 3;
      c(i, j) = a(k, m) * a(l, n) - a(k, n) * a(l, m);
    }
  return c;
}

template <class Number>
Tensor<Number> product(const Tensor<Number>& a, const Tensor<Number>& b) {
  Tensor<Number> c;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) c(i, j) = a(i, 0) * b(0, j) + a(i, 1) * b(1, j) + a(i, 2) * b(2, j);
  return c;
}

template <class Number>
Tensor<Number> transposed(const Tensor<Number>& a) {
  Tensor<Number> t;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) t(i, j) = a(j, i);
  return t;
}

/// (1 - s w)^-1 (1 + s w) of a skew w, a rotation: by the angle of w with s = 1/2 (to third order), half of it with
/// 1/4.
template <class Number>
Tensor<Number> rotation(const Tensor<Number>& w, double s) {
  Tensor<Number> minus, plus;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      const double one = i == j ? 1.0 : 0.0;
      plus(i, j) = s * w(i, j) + one;
      minus(i, j) = -s * w(i, j) + one;
    }
  const Number inverse_determinant = 1.0 / determinant(minus);
  Tensor<Number> inverse = transposed(cofactors(minus));
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) inverse(i, j) = inverse(i, j) * inverse_determinant;
  return product(inverse, plus);
}

template <class Number>
struct Kinematics {
  Tensor<Number> half, full;           ///< rotations from the material's frame, at the middle and the end of the step
  Eigen::Matrix<Number, 6, 1> strain;  ///< in the material's frame

  Kinematics(const PointMotion& m, const Tensor<Number>& after, const Number& volume_after) {
    Tensor<Number> middle, change;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) {
        middle(i, j) = 0.5 * (after(i, j) + m.before(i, j));
        change(i, j) = after(i, j) - m.before(i, j);
      }
    const Number inverse_determinant = 1.0 / determinant(middle);
    Tensor<Number> gradient = product(change, transposed(cofactors(middle)));
    Tensor<Number> stretch, skew;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) gradient(i, j) = gradient(i, j) * inverse_determinant;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) {
        stretch(i, j) = 0.5 * (gradient(i, j) + gradient(j, i));
        skew(i, j) = 0.5 * (gradient(i, j) - gradient(j, i));
      }
    using std::log;
    const Number volume_change = log(volume_after / m.volume_before);
    const Number correction = (1.0 / 3.0) * (volume_change - (stretch(0, 0) + stretch(1, 1) + stretch(2, 2)));
    for (int i = 0; i < 3; ++i) stretch(i, i) = stretch(i, i) + correction;

    Tensor<Number> turned;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) turned(i, j) = Number(m.turned(i, j));
    half = product(rotation(skew, 0.25), turned);
    full = product(rotation(skew, 0.5), turned);
    const Tensor<Number> own = product(transposed(half), product(stretch, half));
    strain << own(0, 0), own(1, 1), own(2, 2), 2.0 * own(1, 2), 2.0 * own(0, 2), 2.0 * own(0, 1);
  }
};

}  // namespace

Vec9 cofactor_column(const Mat3& f) {
  const Mat3 c = cofactors<double>(f);
  return Eigen::Map<const Vec9>(c.data());
}

Mat9 cofactor_slope(const Mat3& f) {
  Mat9 h = Mat9::Zero();
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {  // f(k,m) f(l,n) - f(k,n) f(l,m), as in cofactors()
      const int k = (i + 1) % 3, l = (i + 2) % 3, m = (j + 1) % 3, n = (j + 2) % 3;
      h(i + 3 * j, k + 3 * m) += f(l, n), h(i + 3 * j, l + 3 * n) += f(k, m);
      h(i + 3 * j, k + 3 * n) -= f(l, m), h(i + 3 * j, l + 3 * m) -= f(k, n);
    }
  return h;
}

Vec6 step_strain(const PointMotion& m) {
  return Kinematics<double>(m, m.after, m.volume_after).strain;
}

Mat3 turned_after(const PointMotion& m) {
  return Kinematics<double>(m, m.after, m.volume_after).full;
}

PointForce point_force(const PointMotion& m, const Vec6& stress, const Mat6& tangent) {
  Tensor<Active> after;
  for (int k = 0; k < 9; ++k) after(k % 3, k / 3) = Active(m.after(k % 3, k / 3), Vec10(Vec10::Unit(k)));
  const Active volume(m.volume_after, Vec10(Vec10::Unit(9)));
  const Kinematics<Active> kinematics(m, after, volume);

  Eigen::Matrix<double, 6, 10> strain_derivative;
  for (int k = 0; k < 6; ++k) strain_derivative.row(k) = kinematics.strain[k].derivatives().transpose();
  const Eigen::Matrix<double, 6, 10> stress_derivative = tangent * strain_derivative;
  Eigen::Matrix<Active, 6, 1> s;
  for (int k = 0; k < 6; ++k) s[k] = Active(stress[k], Vec10(stress_derivative.row(k).transpose()));

  const Active mean = (1.0 / 3.0) * (s[0] + s[1] + s[2]);
  Tensor<Active> deviator;
  deviator << s[0] - mean, s[5], s[4], s[5], s[1] - mean, s[3], s[4], s[3], s[2] - mean;
  const Tensor<Active> fixed = product(kinematics.full, product(deviator, transposed(kinematics.full)));
  const Tensor<Active> t = product(fixed, cofactors(after));  // det F F^-T is the matrix of cofactors

  PointForce force;
  for (int k = 0; k < 9; ++k) {
    force.value[k] = t(k % 3, k / 3).value();
    force.derivative.row(k) = t(k % 3, k / 3).derivatives().transpose();
  }
  force.value[9] = mean.value();
  force.derivative.row(9) = mean.derivatives().transpose();
  return force;
}

}  // namespace densify::fem
