// Points of the pressed body: closed forms of the sintering solid, tangents against differences, rotations.

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <random>

#include "fem/press/point_force.h"
#include "fem/press/viscous_solid.h"

namespace densify::fem {
namespace {

SkorohodOlevsky::Parameters solid() {
  SkorohodOlevsky::Parameters p;
  p.viscosity = 1e9;
  p.surface_energy = 1;
  p.particle_radius = 5e-6;
  p.youngs_modulus = 1e15;  // so stiff that the closed forms without elasticity hold to 1e-7
  p.poissons_ratio = 0.3;
  return p;
}

/// One point through steps of which the components of strain not given follow from their stress.
struct Point {
  ViscousSolid material;
  std::vector<double> state = std::vector<double>(8);
  PointAnswer answer{};

  explicit Point(const SkorohodOlevsky::Parameters& p, double density)
      : material(std::make_shared<SkorohodOlevsky>(p)) {
    material.begin(density, state);
  }

  PointAnswer trial(const Vec6& strain, double step, std::vector<double>& after) {
    const PointStep in{strain, step, 300, 300};
    PointAnswer out{};
    material.update({&in, 1}, state, after, {&out, 1});
    return out;
  }

  /// A step in which component k has stress[k] where driven[k], and no strain elsewhere.
  void step(double duration, const Vec6& stress, const Eigen::Array<bool, 6, 1>& driven) {
    Vec6 strain = Vec6::Zero();
    std::vector<double> after(8);
    for (int iteration = 0; iteration < 30; ++iteration) {
      answer = trial(strain, duration, after);
      Mat6 k = answer.tangent;
      Vec6 lack = stress - answer.stress;
      for (int c = 0; c < 6; ++c)
        if (!driven[c]) k.row(c) = Vec6::Unit(c).transpose() * k(c, c), lack[c] = 0;
      const Vec6 change = k.fullPivLu().solve(lack);
      strain += change;
      if (change.norm() < 1e-13) break;
    }
    state = after;
  }

  double porosity() const { return 1 - state[6]; }
};

const Eigen::Array<bool, 6, 1> all = Eigen::Array<bool, 6, 1>::Constant(true);

// Free sintering: theta = theta_0 exp(-9 gamma t/(4 eta r)), 0.2794807 after 500 s from 0.35; second order in the step.
TEST(SinteringSolid, SintersFreelyAsInClosedForm) {
  const double exact = 0.35 * std::exp(-9 * 500 / (4 * 1e9 * 5e-6));
  EXPECT_NEAR(exact, 0.2794807, 5e-8);
  double theta[2];
  for (int fine = 0; fine < 2; ++fine) {
    Point point(solid(), 0.65);
    const int n = fine ? 20 : 10;
    for (int k = 0; k < n; ++k) point.step(500.0 / n, Vec6::Zero(), all);
    theta[fine] = point.porosity();
  }
  EXPECT_NEAR(theta[1], exact, 2e-6);
  EXPECT_NEAR((theta[0] - exact) / (theta[1] - exact), 4, 0.2);
}

// Hydrostatic pressure without surface tension: ln(theta/theta_0) - 2 (theta - theta_0) + (theta^2 - theta_0^2)/2 =
// -3 p t/(4 eta).
TEST(SinteringSolid, HydrostaticPressureAsInClosedForm) {
  auto p = solid();
  p.surface_energy = 0;
  const double pressure = 30e6, time = 40;
  Point point(p, 0.65);
  Vec6 stress = Vec6::Zero();
  stress.head<3>().setConstant(-pressure);
  const int n = 100;
  for (int k = 0; k < n; ++k) point.step(time / n, stress, all);
  const double theta = point.porosity();
  EXPECT_NEAR(std::log(theta / 0.35) - 2 * (theta - 0.35) + (theta * theta - 0.35 * 0.35) / 2,
              -3 * pressure * time / (4 * 1e9), 1e-4);  // of 0.9; the step of 0.4 s leaves 3e-5
}

// Rigid die without friction, no surface tension: ln(theta/theta_0) - (theta - theta_0) = -3 p t/(4 eta), 0.112181
// after 40 s of 30 MPa; the wall carries 1 - 3 theta/2 of it.
TEST(SinteringSolid, RigidDieAsInClosedForm) {
  auto p = solid();
  p.surface_energy = 0;
  Eigen::Array<bool, 6, 1> axial = Eigen::Array<bool, 6, 1>::Constant(false);
  axial[2] = true;
  Point point(p, 0.65);
  Vec6 stress = Vec6::Zero();
  stress[2] = -30e6;
  double before = 0;
  for (int k = 0; k < 100; ++k) before = point.porosity(), point.step(0.4, stress, axial);
  EXPECT_NEAR(point.porosity(), 0.112181, 5e-6);
  const double middle = std::sqrt(before * point.porosity());
  EXPECT_NEAR(point.answer.stress[0] / point.answer.stress[2], 1 - 1.5 * middle, 1e-6);  // of the middle of the step
}

// However long the step, pores do not close in it: twice the porosity of 0.01 is pressed out of a body in 1e4 s, and
// what the pores cannot give is elastic, K 0.01 of pressure.
TEST(SinteringSolid, ALongStepDoesNotPassFullDensity) {
  auto p = solid();
  p.surface_energy = 0, p.youngs_modulus = 188e9;
  Point point(p, 0.99);
  Vec6 strain = Vec6::Zero();
  strain.head<3>().setConstant(-0.02 / 3);
  std::vector<double> after(8);
  const PointAnswer a = point.trial(strain, 1e4, after);
  EXPECT_LT(a.density, 1);
  EXPECT_GT(a.density, 1 - 1e-5);
  const double bulk = 188e9 / (3 * (1 - 2 * 0.3));
  EXPECT_NEAR(a.stress.head<3>().sum() / 3 / (-bulk * 0.01), 1, 0.01);  // 0.02 - ln(1/0.99) = 0.00995
}

// The tangent is the difference quotient of the stress, with elasticity, viscosity and sintering stress of like weight.
TEST(SinteringSolid, TangentIsTheDifferenceQuotient) {
  auto p = solid();
  p.youngs_modulus = 2e8;  // relaxes in some 10 s
  Point point(p, 0.7);
  std::mt19937 random(5);
  std::uniform_real_distribution<double> strain(-0.02, 0.02);
  Vec6 first, second;
  for (int k = 0; k < 6; ++k) first[k] = strain(random), second[k] = strain(random);
  std::vector<double> after(8);
  point.trial(first, 5, after);
  point.state = after;
  const PointAnswer at = point.trial(second, 3, after);
  const double h = 1e-7;
  for (int k = 0; k < 6; ++k) {
    Vec6 plus = second, minus = second;
    plus[k] += h, minus[k] -= h;
    const Vec6 quotient = (point.trial(plus, 3, after).stress - point.trial(minus, 3, after).stress) / (2 * h);
    EXPECT_LT((quotient - at.tangent.col(k)).norm(), 2e-5 * at.tangent.norm()) << k;
  }
}

Mat3 random_gradient(std::mt19937& random, double size) {
  std::uniform_real_distribution<double> u(-size, size);
  Mat3 f = Mat3::Identity();
  for (int k = 0; k < 9; ++k) f(k / 3, k % 3) += u(random);
  return f;
}

/// Stress linear in the strain, for tests of the kinematics.
const Mat6 linear = isotropic_tensor(2, 1) + Mat6(Vec6::LinSpaced(0.1, 0.9).asDiagonal());
const Vec6 offset = Vec6::LinSpaced(-0.3, 0.4);

PointForce force_at(const PointMotion& m) {
  return point_force(m, offset + linear * step_strain(m), linear);
}

TEST(PointForce, DerivativeIsTheDifferenceQuotient) {
  std::mt19937 random(3);
  PointMotion m{random_gradient(random, 0.2), random_gradient(random, 0.2), 0.9, 1.05,
                Mat3(Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized()))};
  const PointForce at = force_at(m);
  const double h = 1e-6;
  for (int k = 0; k < 10; ++k) {
    PointMotion plus = m, minus = m;
    (k < 9 ? plus.after(k % 3, k / 3) : plus.volume_after) += h;
    (k < 9 ? minus.after(k % 3, k / 3) : minus.volume_after) -= h;
    const Vec10 quotient = (force_at(plus).value - force_at(minus).value) / (2 * h);
    EXPECT_LT((quotient - at.derivative.col(k)).norm(), 1e-8 * at.derivative.norm()) << k;
  }
}

// A rotation on top of a step's start and end turns the stress with it and strains nothing more.
TEST(PointForce, ARotationStrainsNothing) {
  std::mt19937 random(4);
  const Mat3 q(Eigen::AngleAxisd(1.1, Vec3(2, -1, 1).normalized()));
  PointMotion m{random_gradient(random, 0.1), random_gradient(random, 0.1), 1.02, 0.95, Mat3::Identity()};
  PointMotion both = m;
  both.before = q * m.before, both.after = q * m.after, both.turned = q;
  EXPECT_LT((step_strain(both) - step_strain(m)).norm(), 1e-14);
  EXPECT_LT((turned_after(both) - q * turned_after(m)).norm(), 1e-14);
  PointMotion rigid{m.before, q * m.before, 1, 1, Mat3::Identity()};  // a rotation within the step
  EXPECT_LT(step_strain(rigid).norm(), 1e-14);
  EXPECT_LT((turned_after(rigid) - q).norm(), 1e-14);
}

// The strain is that of the logarithm for stretches along the axes, to the third order of the step, and exact in
// volume.
TEST(PointForce, StrainIsTheLogarithmOfTheStretch) {
  const Vec3 stretch(0.99, 1.02, 0.97);
  PointMotion m{Mat3::Identity(), Mat3(stretch.asDiagonal()), 1, stretch.prod(), Mat3::Identity()};
  const Vec6 strain = step_strain(m);
  EXPECT_NEAR(strain.head<3>().sum(), std::log(stretch.prod()), 1e-15);
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(strain[k], std::log(stretch[k]), 3e-6) << k;  // 0.03^3/12
}

}  // namespace
}  // namespace densify::fem
