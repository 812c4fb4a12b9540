// Bonds and heat: free expansion leaves no force, constraint leaves the closed form, a cycle leaves nothing.

#include <gtest/gtest.h>

#include "tests/support/setups.h"

namespace densify::test {
namespace {

constexpr double radius = 5e-6, alpha = 11.5e-6, cold = 300, hot = 900;

/// A cold setup of the linear or Hertz model whose necks stay bonds: it never gets to the activation temperature.
Setup bonded_setup(dem::Elasticity elasticity, const Schedule& schedule) {
  auto contact = elastic_model(elasticity, 1e5);
  contact.sintering = dem::SinteringSettings{};
  contact.sintering->damping_ratio = 0.5;
  auto material = nickel_aluminide();
  material.youngs_modulus = PiecewiseLinear(std::vector<PiecewiseLinear::Knot>{{300, 188e9}, {900, 100e9}});
  material.activation_temperature = 2000;
  Setup s = empty_setup(material, contact, schedule);
  s.integration.mass_scaling = 1e6;
  return s;
}

double duration_of(Setup s, int steps) {
  Simulation sim(std::move(s));
  sim.advance(nullptr);
  return steps * sim.state().last_step;
}

double largest_force(const dem::Recording& record) {
  double f = 0;
  for (const auto& c : record.contact) f = std::max(f, std::abs(c.normal));
  return f;
}

struct Cycle {
  double hot_force, cold_force;  ///< largest contact force over k alpha dT r
  double strain;                 ///< of the hot body, from its radius of gyration
};

/// Heats a free bonded body slowly, rests, cools, rests.
Cycle heat(dem::Elasticity elasticity, const std::function<void(Setup&)>& fill, int steps) {
  auto at = [&](double t) {
    Setup s = bonded_setup(
        elasticity,
        Schedule(cold, 0,
                 {{"heat", 2 * t, hot, 0}, {"rest", t, hot, 0}, {"cool", 2 * t, cold, 0}, {"rest", t, cold, 0}}));
    fill(s);
    return s;
  };
  const double t = duration_of(at(1), steps);
  Simulation sim(at(t));
  bond_all(sim, dem::NeckPhase::dormant, 0.4);
  const double before = gyration(sim.state().particles), scale = 1e5 * alpha * (hot - cold) * radius;
  Cycle c{0, 0, 0};
  dem::Recording record;
  while (sim.state().time < 3 * t) sim.advance(&record);
  c.hot_force = largest_force(record) / scale;
  c.strain = gyration(sim.state().particles) / before - 1;
  while (!sim.finished()) sim.advance(&record);
  c.cold_force = largest_force(record) / scale;
  return c;
}

// Two bonded spheres: after heating by 600 K they rest without force and 0.69 % longer, and cold again as before.  What
// is left is vibration, damped over hundreds of periods.
TEST(Bond, PairExpandsFreely) {
  for (auto e : {dem::Elasticity::linear, dem::Elasticity::hertz}) {
    const Cycle c = heat(
        e,
        [](auto& s) {
          add_sphere(s.particles, Vec3::Zero(), radius, Vec3::Zero());
          add_sphere(s.particles, Vec3(0, 0, 1.8 * radius), 0.9 * radius, Vec3::Zero());
        },
        3000);
    EXPECT_LT(c.hot_force, 1e-4);
    EXPECT_LT(c.cold_force, 1e-4);
    EXPECT_NEAR(c.strain / (alpha * (hot - cold)), 1, 1e-4);
  }
}

// A free cluster of unequal, unequally overlapping spheres, held far beyond isostatic, expands as one body by alpha dT:
// each bond lengthens as its own length does, so that no bond works against another; and the thermal cycle with a
// stiffness that falls by half leaves nothing.
TEST(Bond, ClusterExpandsFreely) {
  for (auto e : {dem::Elasticity::linear, dem::Elasticity::hertz}) {
    const Cycle c = heat(
        e, [](auto& s) { fill_cluster(s, 2, 1.7 * radius, radius, 7); }, 6000);
    EXPECT_LT(c.hot_force, 1e-3);
    EXPECT_LT(c.cold_force, 1e-3);
    EXPECT_NEAR(c.strain / (alpha * (hot - cold)), 1, 1e-3);
  }
}

// A bonded crystal in a rigid cell: every bond carries k alpha dT L in compression, and nothing after the cycle.
TEST(Bond, RigidCellCarriesTheThermalForce) {
  auto s = bonded_setup(dem::Elasticity::linear, Schedule(cold, 0, {{"heat", 1, hot, 0}, {"cool", 1, cold, 0}}));
  const double spacing = 1.9 * radius;
  fill_periodic(s, Lattice::face_centred, 2, spacing, radius);
  s.contact.sintering->damping_ratio = 0;
  s.integration.fixed_step = 1e-3;
  s.integration.skin = 0.1;
  s.integration.mass_scaling = 1e12;
  Simulation sim(s);
  bond_all(sim, dem::NeckPhase::dormant, 0.4);
  dem::Recording record;
  while (sim.state().time < 1) sim.advance(&record);
  sim.evaluate(&record);
  EXPECT_NEAR(record.contact[0].normal / (-1e5 * spacing * std::log1p(alpha * (hot - cold))), 1, 1e-5);
  while (!sim.finished()) sim.advance(&record);
  sim.evaluate(&record);
  EXPECT_LT(largest_force(record), 1e-4 * 1e5 * alpha * (hot - cold) * spacing);
}

// The same crystal in a cell that is made to grow with alpha dT/dt stays free of stress: rate and growth cancel.  Both
// are taken at the end of a step, which leaves (alpha dT)^2/steps of the length.
TEST(Bond, CellThatGrowsWithTheCrystal) {
  auto s = bonded_setup(dem::Elasticity::linear, Schedule(cold, 0, {{"heat", 1, hot, 0}}));
  const double spacing = 1.9 * radius;
  fill_periodic(s, Lattice::body_centred, 2, spacing, radius);
  s.contact.sintering->damping_ratio = 0;
  s.integration.fixed_step = 1e-3;
  s.integration.skin = 0.1;
  s.integration.mass_scaling = 1e12;
  Simulation sim(s);
  bond_all(sim, dem::NeckPhase::dormant, 0.4);
  const double rate = alpha * (hot - cold);
  dem::Recording record;
  while (!sim.finished()) {
    sim.mutable_state().cell.velocity_gradient = rate / (1 + rate * sim.state().time) * Mat3::Identity();
    sim.advance(&record);
  }
  EXPECT_LT(largest_force(record), 2e-2 * 1e5 * rate * rate * spacing);
  EXPECT_NEAR(sim.state().cell.h(0, 0) / (4 * spacing / std::sqrt(3.0)), 1 + rate, 1e-6);
}

}  // namespace
}  // namespace densify::test
