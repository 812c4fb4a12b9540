#include "dem/network/network_operator.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

namespace densify::dem {

namespace {

using Vector = Eigen::VectorXd;
using End = NetworkLink::End;

Mat3 stiffness_of(const NetworkLink& l) {
  return l.lateral * Mat3::Identity() + (l.coefficient - l.lateral) * l.normal * l.normal.transpose();
}

/// Inverse on the range of a positive semidefinite block; zero where it is zero to rounding.
Mat3 pseudo_inverse(const Mat3& a) {
  Eigen::SelfAdjointEigenSolver<Mat3> eigen(a);
  const double cut = 1e-13 * eigen.eigenvalues()[2];
  Vec3 inverse = Vec3::Zero();
  for (int k = 0; k < 3; ++k)
    if (eigen.eigenvalues()[k] > cut) inverse[k] = 1 / eigen.eigenvalues()[k];
  return eigen.eigenvectors() * inverse.asDiagonal() * eigen.eigenvectors().transpose();
}

}  // namespace

Vec3 NetworkOperator::relative(const NetworkLink& l, const Vector& x) const {
  const Vec3 own = x.segment<3>(3 * l.i);
  switch (l.end) {
    case End::particle:
      return x.segment<3>(3 * l.j) - own;
    case End::guided_wall:
      return x[rows() - 1] * *guide_ - own;
    default:
      return -own;
  }
}

void NetworkOperator::add_force(const NetworkLink& l, const Vec3& force, Vector& resultant) const {
  resultant.segment<3>(3 * l.i) += force;
  if (l.end == End::particle)
    resultant.segment<3>(3 * l.j) -= force;
  else if (l.end == End::guided_wall)
    resultant[rows() - 1] -= force.dot(*guide_);
}

void NetworkOperator::apply(const Vector& x, Vector& y) const {
  if (own_.size() > 0)
    y = own_.cwiseProduct(x);
  else
    y.setZero(rows());
  const double* const in = x.data();
  double* const out = y.data();
  for (const NetworkLink& l : links_) {
    if (l.end != End::particle) {
      const Vec3 d = relative(l, x);
      add_force(l, -(l.lateral * d + ((l.coefficient - l.lateral) * l.normal.dot(d)) * l.normal), y);
      continue;
    }
    const double *a = in + 3 * l.i, *b = in + 3 * l.j;
    const double dx = b[0] - a[0], dy = b[1] - a[1], dz = b[2] - a[2];
    const double along = (l.coefficient - l.lateral) * (l.normal[0] * dx + l.normal[1] * dy + l.normal[2] * dz);
    const double fx = l.lateral * dx + along * l.normal[0], fy = l.lateral * dy + along * l.normal[1],
                 fz = l.lateral * dz + along * l.normal[2];
    double *p = out + 3 * l.i, *q = out + 3 * l.j;
    p[0] -= fx, p[1] -= fy, p[2] -= fz;
    q[0] += fx, q[1] += fy, q[2] += fz;
  }
}

std::vector<Mat3> NetworkOperator::inverse_blocks(double& guide_inverse) const {
  std::vector<Mat3> block(particles_, Mat3::Zero());
  double guide = 0;
  for (const NetworkLink& l : links_) {
    const Mat3 k = stiffness_of(l);
    block[l.i] += k;
    if (l.end == End::particle) block[l.j] += k;
    if (l.end == End::guided_wall) guide += guide_->dot(k * *guide_);
  }
  if (own_.size() > 0) {
    for (std::size_t p = 0; p < particles_; ++p) block[p].diagonal() += own_.segment<3>(Eigen::Index(3 * p));
    if (guide_) guide += own_[rows() - 1];
  }
  for (Mat3& b : block) {
    const double size = b.trace() / 3;
    constexpr double well_conditioned = 1e-6;
    b = b.determinant() > well_conditioned * size * size * size ? Mat3(b.inverse()) : pseudo_inverse(b);
  }
  guide_inverse = guide > 0 ? 1 / guide : 0.0;
  return block;
}

SolverReport NetworkOperator::solve(const Vector& b, Vector& x, const ConjugateGradients& settings) const {
  SolverReport report;
  Vector r(rows()), z(rows()), p, q(rows());
  apply(x, q);
  r = b - q;
  report.residual = r.norm();
  if (report.residual <= settings.residual) {
    report.converged = true;
    return report;
  }
  double guide_inverse = 0;
  const std::vector<Mat3> inverse = inverse_blocks(guide_inverse);
  auto precondition = [&] {
    for (std::size_t n = 0; n < particles_; ++n)
      z.segment<3>(Eigen::Index(3 * n)).noalias() = inverse[n] * r.segment<3>(Eigen::Index(3 * n));
    if (guide_) z[rows() - 1] = guide_inverse * r[rows() - 1];
  };
  precondition();
  p = z;
  double rz = r.dot(z);
  const int most = settings.most_iterations > 0 ? settings.most_iterations : int(10 * rows());
  while (report.iterations < most) {
    apply(p, q);
    const double curvature = p.dot(q);
    if (!(curvature > 0)) break;  // nothing is left but what K does not see
    const double alpha = rz / curvature;
    x += alpha * p;
    r -= alpha * q;
    ++report.iterations;
    report.residual = r.norm();
    if (report.residual <= settings.residual) {
      report.converged = true;
      break;
    }
    precondition();
    const double before = rz;
    rz = r.dot(z);
    p = z + (rz / before) * p;
  }
  return report;
}

std::vector<SolverReport> NetworkOperator::solve_all(const Eigen::MatrixXd& b, Eigen::MatrixXd& x,
                                                     double relative_residual) const {
  std::vector<SolverReport> reports;
  for (Eigen::Index c = 0; c < b.cols(); ++c) {
    Vector column = x.col(c);
    reports.push_back(solve(b.col(c), column, {relative_residual * b.col(c).norm(), 0}));
    x.col(c) = column;
  }
  return reports;
}

Eigen::SparseMatrix<double> NetworkOperator::assemble() const {
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(36 * links_.size());
  auto add = [&](Eigen::Index row, Eigen::Index column, const Mat3& k, double sign) {
    for (int a = 0; a < 3; ++a)
      for (int c = 0; c < 3; ++c) entries.emplace_back(row + a, column + c, sign * k(a, c));
  };
  for (const NetworkLink& l : links_) {
    const Mat3 k = stiffness_of(l);
    const Eigen::Index i = 3 * l.i, last = rows() - 1;
    add(i, i, k, 1);
    if (l.end == End::particle) {
      const Eigen::Index j = 3 * l.j;
      add(j, j, k, 1), add(i, j, k, -1), add(j, i, k, -1);
    } else if (l.end == End::guided_wall) {
      const Vec3 across = k * *guide_;
      for (int a = 0; a < 3; ++a)
        entries.emplace_back(i + a, last, -across[a]), entries.emplace_back(last, i + a, -across[a]);
      entries.emplace_back(last, last, guide_->dot(across));
    }
  }
  for (Eigen::Index r = 0; r < own_.size(); ++r) entries.emplace_back(r, r, own_[r]);
  Eigen::SparseMatrix<double> matrix(rows(), rows());
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

}  // namespace densify::dem
