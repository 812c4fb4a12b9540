// The contact network against closed forms of lattices, a dense solution
// and the laws' own updates.

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>

#include "base/check.h"
#include "dem/network/network_operator.h"
#include "dem/network/probes.h"
#include "tests/support/setups.h"

namespace densify::dem {
namespace {

using test::Lattice;

constexpr double radius = 5e-6, spacing = 1.9 * radius, k_n = 1e5, k_t = 3e4;

Setup bonded_setup(SinteringModel model) {
  auto contact = test::elastic_model(Elasticity::linear, k_n);
  contact.sintering = SinteringSettings{};
  contact.sintering->model = model;
  contact.sintering->damping_ratio = 0;
  return test::empty_setup(test::copper(), contact, test::hold(1, 1300, 0));
}

ContactWorld world_of(const Simulation& sim) {
  const State& s = sim.state();
  return {s.particles, s.contacts, s.cell, sim.table(), sim.setup().contact, s.walls};
}

/// The network of a lattice whose necks have the given phase.
Network lattice_network(Lattice lattice, int n, SinteringModel model, NeckPhase phase, double& volume) {
  Setup s = bonded_setup(model);
  test::fill_periodic(s, lattice, n, spacing, radius);
  Simulation sim(s);
  test::bond_all(sim, phase, 0.4);
  volume = sim.state().cell.volume();
  return build_network(world_of(sim), 0);
}

struct Cubic {
  double c11, c12, c44;
};

/// Springs (or dashpots) k along and across every contact of length L.
Cubic closed_form(Lattice lattice, double k, double t) {
  const double s3 = std::sqrt(3.0), s2 = std::sqrt(2.0), l = spacing;
  switch (lattice) {
    case Lattice::simple_cubic:
      return {k / l, 0, t / (2 * l)};
    case Lattice::body_centred:
      return {(k + 2 * t) / (s3 * l), (k - t) / (s3 * l), (k + t / 2) / (s3 * l)};
    default:
      return {s2 * (k + t) / l, (k - t) / (s2 * l), (k + t) / (s2 * l)};
  }
}

void expect_cubic(const Mat6& c, const Cubic& exact, double tolerance) {
  Mat6 expected = Mat6::Zero();
  expected.topLeftCorner<3, 3>().setConstant(exact.c12);
  for (int a = 0; a < 3; ++a) expected(a, a) = exact.c11, expected(a + 3, a + 3) = exact.c44;
  EXPECT_LT((c - expected).cwiseAbs().maxCoeff() / exact.c11, tolerance) << c;
}

// SC C11 = k/L, C12 = 0, C44 = t/(2L); BCC (k+2t)/(sqrt3 L), (k-t)/(sqrt3 L), (k+t/2)/(sqrt3 L); FCC sqrt2 (k+t)/L,
// (k-t)/(sqrt2 L), (k+t)/(sqrt2 L).  Every site is a centre of symmetry, so that the relaxed answer is the affine one;
// to rounding of sums over some hundred contacts.
TEST(Network, LatticesOfSprings) {
  double v;
  for (auto lattice : {Lattice::simple_cubic, Lattice::body_centred, Lattice::face_centred})
    for (double t : {0.0, k_t}) {
      const Network net = lattice_network(lattice, 3, SinteringModel::viscoelastic, NeckPhase::bonded, v);
      const auto r = probe_cell(net,
                                [&](const NetworkEdge& e) {
                                  return EdgeLaw{e.law.stiffness, t, 0};
                                },
                                {v, 1e-12, Rotation::held, 1000});
      expect_cubic(r.affine, closed_form(lattice, k_n, t), 1e-12);
      expect_cubic(r.relaxed, closed_form(lattice, k_n, t), 1e-9);
      EXPECT_LT(r.asymmetry, 1e-12);
      EXPECT_LT(r.power_mismatch, 1e-9);
    }
}

// Dashpots instead: eta = pi a^4/(8 D_eff) (4.40), a = 0.4 r_sint; D_eff of copper at 1300 K from Table 5.1. The
// stress at no rate is that of F_sint (4.36) alone, (1/V) sum F L: hydrostatic, z F L N/(6 V) each.
TEST(Network, LatticesOfDashpotsAndTheirSinteringStress) {
  const double a = 0.4 * radius, diffusion = 3.832e-19 * 1.18e-29 / (1.380649e-23 * 1300),
               eta = M_PI * std::pow(a, 4) / (8 * diffusion), psi = 146 * M_PI / 180;
  const double f = M_PI * 1.72 * (4 * radius * (1 - std::cos(psi / 2)) + a * std::sin(psi / 2));
  for (auto lattice : {Lattice::simple_cubic, Lattice::body_centred, Lattice::face_centred}) {
    double v;
    const Network net = lattice_network(lattice, 3, SinteringModel::viscous, NeckPhase::sintering, v);
    const auto r = probe_cell(net,
                              [&](const NetworkEdge& e) {
                                return EdgeLaw{e.law.viscosity, 0.3 * e.law.viscosity, e.law.active};
                              },
                              {v, 1e-12, Rotation::held, 1000});
    expect_cubic(r.relaxed, closed_form(lattice, eta, 0.3 * eta), 1e-9);
    const double pressure = f * spacing * double(net.edges.size()) / (3 * v);
    for (int c = 0; c < 6; ++c) EXPECT_NEAR(r.relaxed_active[c] / pressure, c < 3 ? 1 : 0, 1e-9) << c;
  }
}

// A Maxwell network over a step: h -> 0 gives the elastic answer k h, h -> infinity the viscous one, and in between
// k h/(1 + k h/eta) for a lattice whose contacts are all alike.
TEST(Network, StepOfAMaxwellLattice) {
  double v;
  const Network net = lattice_network(Lattice::face_centred, 3, SinteringModel::viscoelastic, NeckPhase::sintering, v);
  const double eta = net.edges[0].law.viscosity, relaxation = eta / k_n;
  auto at = [&](double h) {
    return probe_cell(net,
                      [&](const NetworkEdge& e) {
                        return EdgeLaw{frozen_step(e.law, h).coefficient, 0, 0};
                      },
                      {v, 1e-12, Rotation::held, 1000})
        .relaxed;
  };
  expect_cubic(at(1e-9 * relaxation) / (1e-9 * relaxation), closed_form(Lattice::face_centred, k_n, 0), 2e-9);
  expect_cubic(at(1e9 * relaxation), closed_form(Lattice::face_centred, eta, 0), 2e-9);
  expect_cubic(at(relaxation), closed_form(Lattice::face_centred, eta / 2, 0), 1e-9);
}

/// A shaken crystal: a periodic network without symmetry.
Network shaken_network(double& volume, std::vector<Vec3>* positions) {
  Setup s = bonded_setup(SinteringModel::viscoelastic);
  test::fill_periodic(s, Lattice::face_centred, 2, spacing, radius);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> u(-0.08 * radius, 0.08 * radius);
  for (auto& b : s.particles.body) b.position += Vec3(u(random), u(random), u(random));
  Simulation sim(s);
  test::bond_all(sim, NeckPhase::bonded, 0.4);
  volume = sim.state().cell.volume();
  if (positions)
    for (const auto& b : sim.state().particles.body) positions->push_back(b.position);
  return build_network(world_of(sim), 0);
}

NetworkOperator operator_of(const Network& net, double lateral) {
  NetworkOperator k(net.particles, std::nullopt);
  for (const auto& e : net.edges) k.add({e.normal, e.law.stiffness, lateral * e.law.stiffness, e.i, e.j});
  return k;
}

// K assembled is K applied; it is symmetric, has no negative eigenvalue, and exactly the three translations as zeros.
TEST(NetworkOperator, SymmetricAndDefinite) {
  double v;
  const NetworkOperator k = operator_of(shaken_network(v, nullptr), 0.3);
  const Eigen::MatrixXd dense = k.assemble();
  EXPECT_LT((dense - dense.transpose()).cwiseAbs().maxCoeff() / dense.cwiseAbs().maxCoeff(), 1e-14);
  const Eigen::VectorXd x = Eigen::VectorXd::Random(k.rows());
  Eigen::VectorXd y;
  k.apply(x, y);
  EXPECT_LT((y - dense * x).norm() / y.norm(), 1e-14);
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(dense);
  const double largest = eigen.eigenvalues()[k.rows() - 1];
  EXPECT_LT(std::abs(eigen.eigenvalues()[2]) / largest, 1e-14);
  EXPECT_GT(eigen.eigenvalues()[3] / largest, 1e-4);
}

// The relaxed answer against a dense solution of the same network by its eigenvectors; below the affine
// one in the sense of quadratic forms.
TEST(Network, RelaxedAgainstDenseSolution) {
  double volume;
  const Network net = shaken_network(volume, nullptr);
  for (double lateral : {0.0, 0.3}) {
    const NetworkOperator k = operator_of(net, lateral);
    const auto law = [&](const NetworkEdge& e) { return EdgeLaw{e.law.stiffness, lateral * e.law.stiffness, 0}; };
    const CellResponse r = probe_cell(net, law, {volume, 1e-12, Rotation::held, 1000});
    Mat3 uniaxial = Mat3::Zero();
    uniaxial(2, 2) = 1;
    auto edge_force = [&](const NetworkEdge& e, const Vec3& moved) -> Vec3 {
      const Vec3 u = uniaxial * e.branch + moved, along = e.normal.dot(u) * e.normal;
      return e.law.stiffness * (along + lateral * (u - along));
    };
    Eigen::VectorXd resultant = Eigen::VectorXd::Zero(k.rows());
    for (const auto& e : net.edges) {
      const Vec3 f = edge_force(e, Vec3::Zero());
      resultant.segment<3>(3 * e.i) += f;
      resultant.segment<3>(3 * e.j) -= f;
    }
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> dense(Eigen::MatrixXd(k.assemble()));
    Eigen::VectorXd x = dense.eigenvectors().transpose() * resultant;
    for (Eigen::Index q = 0; q < x.size(); ++q) {
      const double stiffness = dense.eigenvalues()[q];
      x[q] = stiffness > 1e-12 * dense.eigenvalues()[x.size() - 1] ? x[q] / stiffness : 0.0;
    }
    x = dense.eigenvectors() * x;
    double zz = 0;
    for (const auto& e : net.edges)
      zz += edge_force(e, x.segment<3>(3 * e.j) - x.segment<3>(3 * e.i))[2] * e.branch[2] / volume;
    EXPECT_NEAR(r.relaxed(2, 2) / zz, 1, 1e-9);
    EXPECT_LT(r.asymmetry, 1e-9);
    EXPECT_LT(r.power_mismatch, 1e-9);
    const Eigen::SelfAdjointEigenSolver<Mat6> gain(0.5 * (r.affine - r.relaxed + (r.affine - r.relaxed).transpose()));
    EXPECT_GT(gain.eigenvalues()[0] / r.affine(0, 0), -1e-9);
    EXPECT_GT(gain.eigenvalues()[5] / r.affine(0, 0), 1e-4);  // a shaken crystal does relax
  }
}

// Three spheres in a row and one that touches nothing: two contacts, so that normal springs alone stiffen two of the
// twelve degrees of freedom, and springs along all three directions six.
TEST(Network, RattlersAndFloppyModes) {
  auto s = bonded_setup(SinteringModel::viscoelastic);
  for (double x : {0.0, 1.9, 3.8, 8.0}) test::add_sphere(s.particles, Vec3(x * radius, 0, 0), radius, Vec3::Zero());
  Simulation sim(s);
  test::bond_all(sim, NeckPhase::bonded, 0.4);
  const Network net = build_network(world_of(sim), 0);
  ASSERT_EQ(net.edges.size(), 2u);
  auto count = [](const std::vector<bool>& flags) { return std::count(flags.begin(), flags.end(), true); };
  const auto alone = find_rattlers(net, 1);
  EXPECT_EQ(count(alone), 1);
  EXPECT_EQ(count(find_rattlers(net, 2)), 4);  // ends fall, then the middle
  auto soft = [&](double lateral) {
    return count_soft_modes(
        net,
        [&](const NetworkEdge& e) {
          return EdgeLaw{e.law.stiffness, lateral * e.law.stiffness, 0};
        },
        Rotation::held, 1e-9);
  };
  EXPECT_EQ(soft(0), 12u - 2u);
  EXPECT_EQ(soft(0.5), 12u - 6u);  // three springs a contact
}

// A punch as one more unknown: a column of two spheres on a fixed wall under a force F on the guided wall.  Springs in
// series: travel F (1/k + 1/k + 1/k) of three contacts.
TEST(NetworkOperator, GuidedWallOnAColumn) {
  NetworkOperator k(2, Vec3(Vec3::UnitZ()));
  const Vec3 up = Vec3::UnitZ();
  k.add({-up, 2.0, 0.5, 0, 0, NetworkLink::End::fixed_wall});
  k.add({up, 4.0, 0.5, 0, 1});
  k.add({up, 8.0, 0.5, 1, 0, NetworkLink::End::guided_wall});
  Eigen::VectorXd b = Eigen::VectorXd::Zero(7), x = b;
  b[6] = -3;
  const SolverReport report = k.solve(b, x, {1e-13, 0});
  EXPECT_TRUE(report.converged);
  EXPECT_NEAR(x[6], -3 * (1 / 2.0 + 1 / 4.0 + 1 / 8.0), 1e-12);
  EXPECT_NEAR(x[2], -3 / 2.0, 1e-12);
  Eigen::VectorXd y;
  k.apply(x, y);
  EXPECT_LT((y - k.assemble() * x).norm(), 1e-13);
}

// Rows that resist their own motion: a column of one sphere between a fixed wall and the guided one, (k1 + k2 + m) x -
// k2 y = 0 and (k2 + M) y - k2 x = F; a sphere that nothing else holds moves by b/m.
TEST(NetworkOperator, OwnResistance) {
  NetworkOperator k(2, Vec3(Vec3::UnitZ()));
  const Vec3 up = Vec3::UnitZ();
  const double k1 = 2, k2 = 4, m = 0.5, guide = 3, force = -3;
  k.add({-up, k1, 0.5, 0, 0, NetworkLink::End::fixed_wall});
  k.add({up, k2, 0.5, 0, 0, NetworkLink::End::guided_wall});
  Eigen::VectorXd own = Eigen::VectorXd::Constant(7, m);
  own[6] = guide;
  k.resist(own);
  Eigen::VectorXd b = Eigen::VectorXd::Zero(7), x = b;
  b[3] = 7, b[6] = force;
  EXPECT_TRUE(k.solve(b, x, {1e-13, 0}).converged);
  const double y = force / (k2 + guide - k2 * k2 / (k1 + k2 + m));
  EXPECT_NEAR(x[6], y, 1e-12);
  EXPECT_NEAR(x[2], k2 * y / (k1 + k2 + m), 1e-12);
  EXPECT_NEAR(x[3], 7 / m, 1e-12);
  Eigen::VectorXd applied;
  k.apply(x, applied);
  EXPECT_LT((applied - k.assemble() * x).norm(), 1e-13);
  k.clear();
  k.apply(x, applied);
  EXPECT_EQ(applied.norm(), 0);
}

// Several right-hand sides are the single ones.
TEST(NetworkOperator, SeveralRightHandSides) {
  double v;
  const NetworkOperator k = operator_of(shaken_network(v, nullptr), 0.3);
  Eigen::MatrixXd b(k.rows(), 2), x = Eigen::MatrixXd::Zero(k.rows(), 2);
  for (int c = 0; c < 2; ++c) {
    Eigen::VectorXd in = Eigen::VectorXd::Random(k.rows()), out;
    k.apply(in, out);  // so that no resultant is left on the whole
    b.col(c) = out;
  }
  const auto reports = k.solve_all(b, x, 1e-10);
  for (int c = 0; c < 2; ++c) {
    Eigen::VectorXd out;
    k.apply(x.col(c), out);
    EXPECT_TRUE(reports[std::size_t(c)].converged);
    EXPECT_LT((out - b.col(c)).norm() / b.col(c).norm(), 2e-10);
  }
}

}  // namespace
}  // namespace densify::dem
