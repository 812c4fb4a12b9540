#include "base/elastic_tensor.h"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <limits>

#include "base/isotropic.h"

namespace densify {

namespace {

/// Factors from Voigt's rows (stress as it is) to Mandel's.
Vec6 mandel_factors() {
  const double s = std::sqrt(2.0);
  return (Vec6() << 1, 1, 1, s, s, s).finished();
}

}  // namespace

Mat6 mandel(const Mat6& c) {
  const Vec6 f = mandel_factors();
  return f.asDiagonal() * c * f.asDiagonal();
}

IsotropicPart isotropic_part(const Mat6& given) {
  const Mat6 c = 0.5 * (given + given.transpose());
  const double trace = c.topLeftCorner<3, 3>().sum();                                             // C_iijj
  const double full = c.topLeftCorner<3, 3>().trace() + 2 * c.bottomRightCorner<3, 3>().trace();  // C_ijij
  IsotropicPart p;
  p.bulk = trace / 9;
  p.shear = (3 * full - trace) / 30;
  p.youngs = IsotropicModuli{p.bulk, p.shear}.youngs();
  p.poisson = IsotropicModuli{p.bulk, p.shear}.poisson();
  const Mat6 m = mandel(c);
  Mat6 iso = 2 * p.shear * Mat6::Identity();
  iso.topLeftCorner<3, 3>().array() += p.bulk - 2 * p.shear / 3;
  p.distance = (m - iso).norm() / m.norm();
  const Eigen::SelfAdjointEigenSolver<Mat6> eigen(m);
  p.universal = std::numeric_limits<double>::infinity();
  if (eigen.eigenvalues()[0] > 1e-12 * eigen.eigenvalues()[5]) {
    const Mat6 s = m.inverse();
    const double s_trace = s.topLeftCorner<3, 3>().sum();
    const double bulk_r = 1 / s_trace, shear_r = 5 / (2 * (s.trace() - s_trace / 3));
    p.universal = 5 * p.shear / shear_r + p.bulk / bulk_r - 6;
  }
  return p;
}

Mat6 rotated(const Mat6& c, const Mat3& q) {
  constexpr int row[6] = {0, 1, 2, 1, 0, 0}, column[6] = {0, 1, 2, 2, 2, 1};
  Mat6 m;  // turns stresses in Voigt's order
  for (int a = 0; a < 6; ++a)
    for (int b = 0; b < 6; ++b) {
      const double one = q(row[a], row[b]) * q(column[a], column[b]);
      m(a, b) = b < 3 ? one : one + q(row[a], column[b]) * q(column[a], row[b]);
    }
  return m * c * m.transpose();
}

Vec6 free_rate(const Mat6& c, const Vec6& stress) {
  const Vec6 f = mandel_factors();
  const Eigen::SelfAdjointEigenSolver<Mat6> eigen(mandel(0.5 * (c + c.transpose())));
  Vec6 parts = eigen.eigenvectors().transpose() * (f.asDiagonal() * stress);
  const double soft = 1e-10 * eigen.eigenvalues()[5];
  for (int k = 0; k < 6; ++k) parts[k] = eigen.eigenvalues()[k] > soft ? -parts[k] / eigen.eigenvalues()[k] : 0.0;
  return f.asDiagonal() * (eigen.eigenvectors() * parts);
}

}  // namespace densify
