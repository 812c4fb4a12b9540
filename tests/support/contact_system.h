#pragma once
// The dense system of all contacts of a simulation, translation and rotation: a reference for step limits that shares
// nothing with them but each contact's own stiffness and damper.

#include <Eigen/Eigenvalues>

#include "tests/support/setups.h"

namespace densify::test {

using Eigen::MatrixXd;
using Eigen::VectorXd;

struct ContactSystem {
  MatrixXd stiffness, damping;  // divided by the roots of the masses [1/s^2, 1/s]
};

/// Stiffness, damper and viscosity of pair k now.
inline dem::Linearisation linearise(const Simulation& sim, std::size_t k) {
  const auto& list = sim.state().contacts;
  const auto& model = sim.setup().contact;
  const auto in = normal_input(sim, k);
  auto bucket = list.buckets.begin();
  while (k >= bucket->end) ++bucket;
  const auto& row = sim.table().row(bucket->material_a, bucket->material_b);
  return with_spring(model, row, [&](const auto& spring) {
    using Spring = std::decay_t<decltype(spring)>;
    if (list.neck.empty()) return dem::KelvinVoigt<Spring>{spring, model.damping_ratio}.linearise(in);
    return dem::make_sintering<Spring>(model, row).linearise(in, list.neck[k]);
  });
}

/// Adds k g g^T of one spring whose stretch is g . x; g holds the parts of i and j (3 translations, 3 rotations each).
inline void add_spring(MatrixXd& m, std::size_t i, std::size_t j, const VectorXd& gi, const VectorXd& gj, double k) {
  VectorXd g = VectorXd::Zero(m.rows());
  g.segment(Eigen::Index(6 * i), 6) += gi;
  g.segment(Eigen::Index(6 * j), 6) += gj;
  m += k * g * g.transpose();
}

inline ContactSystem assemble(const Simulation& sim) {
  const auto& p = sim.state().particles;
  const auto& list = sim.state().contacts;
  const auto& contact = sim.setup().contact;
  const auto n = Eigen::Index(6 * p.size());
  ContactSystem s{MatrixXd::Zero(n, n), MatrixXd::Zero(n, n)};
  for (std::size_t c = 0; c < list.size(); ++c) {
    const std::size_t i = list.i(c), j = list.j(c);
    const auto &a = p.body[i], &b = p.body[j];
    Vec3 branch = b.position - a.position;
    if (sim.state().cell.periodic) branch += sim.state().cell.shift(list.image(c));
    const double overlap = branch.norm() - a.radius - b.radius;
    const bool necked = !list.neck.empty() && list.neck[c].phase != dem::NeckPhase::loose;
    if (overlap >= 0 && !necked) continue;
    const Vec3 normal = branch.normalized();
    const double reduced = 1 / (a.inverse_mass + b.inverse_mass);
    const dem::Linearisation l = linearise(sim, c);
    const bool dashpot = std::isinf(l.stiffness);
    VectorXd gi = VectorXd::Zero(6), gj = VectorXd::Zero(6);
    gi.head(3) = -normal;
    gj.head(3) = normal;
    if (!dashpot) add_spring(s.stiffness, i, j, gi, gj, l.stiffness);
    add_spring(s.damping, i, j, gi, gj, dashpot ? l.viscosity : l.damper);
    if (!contact.friction) continue;
    const double k_t = contact.friction->tangential_stiffness_ratio * l.stiffness;
    const double c_t = 2 * contact.friction->tangential_damping_ratio * std::sqrt(reduced * k_t);
    const Vec3 t1 = normal.unitOrthogonal(), t2 = normal.cross(t1);
    for (const Vec3& t : {t1, t2}) {
      gi << -t, -(a.radius + 0.5 * overlap) * normal.cross(t);
      gj << t, -(b.radius + 0.5 * overlap) * normal.cross(t);
      add_spring(s.stiffness, i, j, gi, gj, k_t);
      add_spring(s.damping, i, j, gi, gj, c_t);
    }
  }
  VectorXd root(n);
  for (std::size_t q = 0; q < p.size(); ++q) {
    const auto& b = p.body[q];
    root.segment(Eigen::Index(6 * q), 3).setConstant(std::sqrt(b.inverse_mass));
    root.segment(Eigen::Index(6 * q) + 3, 3).setConstant(std::sqrt(2.5 * b.inverse_mass) / b.radius);
  }
  s.stiffness = root.asDiagonal() * s.stiffness * root.asDiagonal();
  s.damping = root.asDiagonal() * s.damping * root.asDiagonal();
  return s;
}

/// Spectral radius of one leap-frog step with the half-step lag of the damper: x'' + (dt^2 K + dt C - 2) x' + (1 - dt
/// C) x = 0 between steps.
inline double spectral_radius(const ContactSystem& s, double dt) {
  const auto n = s.stiffness.rows();
  const MatrixXd one = MatrixXd::Identity(n, n);
  MatrixXd a = MatrixXd::Zero(2 * n, 2 * n);
  a.topRightCorner(n, n) = one;
  a.bottomLeftCorner(n, n) = dt * s.damping - one;
  a.bottomRightCorner(n, n) = 2 * one - dt * dt * s.stiffness - dt * s.damping;
  return a.eigenvalues().cwiseAbs().maxCoeff();
}

inline double largest_eigenvalue(const MatrixXd& symmetric) {
  return Eigen::SelfAdjointEigenSolver<MatrixXd>(symmetric, Eigen::EigenvaluesOnly).eigenvalues().maxCoeff();
}

/// 2/omega_max of springs without dampers [s].
inline double undamped_limit(const ContactSystem& s) {
  return 2 / std::sqrt(largest_eigenvalue(s.stiffness));
}

/// 2/lambda_max of dashpots without springs [s].
inline double dashpot_limit(const ContactSystem& s) {
  return 2 / largest_eigenvalue(s.damping);
}

}  // namespace densify::test
