// The step limit of a packing against the eigenvalues of its whole system, translation and rotation.

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>

#include "tests/support/setups.h"

namespace densify::test {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double radius = 5e-6, k_n = 1e5;

struct System {
  MatrixXd stiffness, damping;  // divided by the roots of the masses
};

/// Adds k g g^T of one spring whose stretch is g . x; g holds the parts of i and j (3 translations, 3 rotations each).
void add_spring(MatrixXd& m, std::size_t i, std::size_t j, const VectorXd& gi, const VectorXd& gj, double k) {
  VectorXd g = VectorXd::Zero(m.rows());
  g.segment(Eigen::Index(6 * i), 6) += gi;
  g.segment(Eigen::Index(6 * j), 6) += gj;
  m += k * g * g.transpose();
}

System assemble(const Simulation& sim) {
  const auto& p = sim.state().particles;
  const auto& list = sim.state().contacts;
  const auto& contact = sim.setup().contact;
  const auto n = Eigen::Index(6 * p.size());
  System s{MatrixXd::Zero(n, n), MatrixXd::Zero(n, n)};
  for (std::size_t c = 0; c < list.size(); ++c) {
    const std::size_t i = list.i(c), j = list.j(c);
    const auto &a = p.body[i], &b = p.body[j];
    Vec3 branch = b.position - a.position;
    if (sim.state().cell.periodic) branch += sim.state().cell.shift(list.image(c));
    const double overlap = branch.norm() - a.radius - b.radius;
    if (overlap >= 0) continue;
    const Vec3 normal = branch.normalized();
    const double reduced = 1 / (a.inverse_mass + b.inverse_mass);
    VectorXd gi = VectorXd::Zero(6), gj = VectorXd::Zero(6);
    gi.head(3) = -normal;
    gj.head(3) = normal;
    add_spring(s.stiffness, i, j, gi, gj, k_n);
    add_spring(s.damping, i, j, gi, gj, 2 * contact.damping_ratio * std::sqrt(reduced * k_n));
    if (!contact.friction) continue;
    const double k_t = contact.friction->tangential_stiffness_ratio * k_n;
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
double spectral_radius(const System& s, double dt) {
  const auto n = s.stiffness.rows();
  const MatrixXd one = MatrixXd::Identity(n, n);
  MatrixXd a = MatrixXd::Zero(2 * n, 2 * n);
  a.topRightCorner(n, n) = one;
  a.bottomLeftCorner(n, n) = dt * s.damping - one;
  a.bottomRightCorner(n, n) = 2 * one - dt * dt * s.stiffness - dt * s.damping;
  return a.eigenvalues().cwiseAbs().maxCoeff();
}

/// 2/omega_max of the undamped system [s].
double undamped_limit(const System& s) {
  const Eigen::SelfAdjointEigenSolver<MatrixXd> k(s.stiffness, Eigen::EigenvaluesOnly);
  return 2 / std::sqrt(k.eigenvalues().maxCoeff());
}

enum class Body { simple_cubic, body_centred, face_centred, cluster };

Simulation make(Body kind, const dem::ContactModel& contact) {
  Setup s = empty_setup(copper(), contact, hold(1, 300, 0));
  const double spacing = 2 * radius * 0.999;
  if (kind == Body::cluster)
    fill_cluster(s, 2, 1.7 * radius, radius, 3);
  else
    fill_periodic(s, Lattice(kind), kind == Body::simple_cubic ? 3 : 2, spacing, radius);
  s.integration.skin = 0.1;
  Simulation sim(s);
  sim.advance(nullptr);
  return sim;
}

dem::ContactModel model(double damping, double tangential_ratio, double tangential_damping) {
  auto m = elastic_model(dem::Elasticity::linear, k_n);
  m.damping_ratio = damping;
  if (tangential_ratio > 0) m.friction = dem::FrictionModel{1e9, 1e9, tangential_ratio, tangential_damping};
  return m;
}

// The largest eigenvalues of the particles' matrix sums bound that of the whole from above: the limit is never above
// the true one, in crystals and in a shaken cluster of unequal spheres, with stiff and soft tangential springs.  It is
// not far below either.  With normal springs it is exact in a face-centred crystal (2/omega = 2 sqrt(m/(8 k)), A = 4 k
// 1) and sqrt(3/4) of it in the simple cubic one of 3 cells, whose largest wave is not in the box; a sum of all k
// without their directions would be sqrt(3) lower.  Sticking contacts resist in all directions.
TEST(PackingStability, LimitOfSpringsIsNeverAboveTheTrueOne) {
  for (Body kind : {Body::simple_cubic, Body::body_centred, Body::face_centred, Body::cluster})
    for (double tangential : {0.0, 2.0 / 7, 1.0}) {
      const Simulation sim = make(kind, model(0, tangential, 0));
      const double ratio = sim.state().critical_step / undamped_limit(assemble(sim));
      EXPECT_LE(ratio, 1) << int(kind) << " k_t " << tangential;
      EXPECT_GE(ratio, tangential == 0 ? 0.8 : 0.49) << int(kind) << " k_t " << tangential;
      if (kind == Body::face_centred && tangential == 0) EXPECT_NEAR(ratio, 1, 2e-3);  // spacing 0.999 d
    }
}

// The same with dampers, normal and tangential: at the limit no eigenvalue of the step is outside the unit circle.
// (Rigid motions sit at 1 as double roots, which eigenvalues find to the root of rounding.)
TEST(PackingStability, DampedSystemsAreStableAtTheLimit) {
  for (Body kind : {Body::body_centred, Body::cluster})
    for (const auto& m : {model(0.5, 0, 0), model(0.3, 1, 0.3), model(0, 0.5, 0.8), model(2, 0.1, 1)}) {
      const Simulation sim = make(kind, m);
      const System s = assemble(sim);
      EXPECT_LT(spectral_radius(s, sim.state().critical_step), 1 + 1e-5) << int(kind) << " xi " << m.damping_ratio;
      EXPECT_GT(spectral_radius(s, 5 * sim.state().critical_step), 1.1);  // it does notice
    }
}

// A sphere that sticks to a floor with k_t = k_n: sliding and rolling answer with 1/m + r^2/J = 3.5/m to one fixed end,
// 2/sqrt(3.5 k/m); its damper counts the same way.
TEST(PackingStability, StickingToAWall) {
  for (double damping : {0.0, 1.0}) {
    const auto contact = model(0, 1, damping);
    auto s = empty_setup(copper(), contact, hold(1, 300, 0));
    s.container.shape = dem::ContainerShape::box;
    s.container.punch = false;
    s.container.size = Vec3::Constant(10 * radius);
    add_sphere(s.particles, Vec3(5 * radius, 5 * radius, 0.999 * radius), radius, Vec3::Zero());
    Simulation sim(s);
    sim.advance(nullptr);
    const double omega = std::sqrt(3.5 * k_n * sim.state().particles.body[0].inverse_mass);
    const double xi = damping * std::sqrt(3.5);  // c_t = 2 xi sqrt(m k_t) against a mass of m/3.5
    EXPECT_LE(sim.state().critical_step, 2 / omega * (std::sqrt(1 + xi * xi) - xi));
  }
}

/// Largest kinetic energy of `steps` steps over that of a small random motion at their beginning.
double growth(Body kind, const dem::ContactModel& contact, double step, int steps) {
  Setup s = empty_setup(copper(), contact, hold(1, 300, 0));
  fill_periodic(s, Lattice(kind), 2, 2 * radius * 0.999, radius);
  s.integration.skin = 0.1;
  s.integration.fixed_step = step;
  shake(s.particles, 1e-6 * radius / step, 5);
  Simulation sim(s);
  const double early = kinetic_energy(sim.state().particles);
  double late = 0;
  for (int n = 0; n < steps; ++n) {
    sim.advance(nullptr);
    late = std::max(late, kinetic_energy(sim.state().particles));
  }
  return late / early;
}

// The program itself: at 0.99 of its limit the motion of a crystal stays as it is over 5000 steps, at 1.01 of the true
// limit of the dense system it grows until contacts open, a thousand times its first amplitude.  (Crystals that normal
// springs alone hold: BCC has floppy modes that buckle, whatever the step.)
TEST(PackingStability, CrystalsAtTheLimit) {
  struct Held {
    Body kind;
    dem::ContactModel contact;
  };
  for (const auto& [kind, contact] :
       {Held{Body::face_centred, model(0, 0, 0)}, Held{Body::face_centred, model(0, 1, 0)},
        Held{Body::body_centred, model(0, 2.0 / 7, 0)}}) {
    const Simulation sim = make(kind, contact);
    EXPECT_LT(growth(kind, contact, 0.99 * sim.state().critical_step, 5000), 2) << int(kind);
    EXPECT_GT(growth(kind, contact, 1.01 * undamped_limit(assemble(sim)), 1000), 1e4) << int(kind);
  }
}

}  // namespace
}  // namespace densify::test
