// What the contact network answers at rest against packings that move in time.

#include <gtest/gtest.h>

#include "dem/network/moduli.h"
#include "tests/support/setups.h"

namespace densify::test {
namespace {

constexpr double radius = 5e-6, stiffness = 1e5;

/// A shaken face-centred crystal of copper at 1300 K whose necks differ by 10 % in radius, 46 % in viscosity;
/// eta/k = 0.2 to 0.4 s.
Setup shaken_crystal(double surface_energy, double mass_scaling) {
  auto contact = elastic_model(dem::Elasticity::linear, stiffness);
  contact.sintering = dem::SinteringSettings{};
  contact.sintering->damping_ratio = 0.5;
  auto material = copper();
  material.surface_energy = surface_energy;
  Setup s = empty_setup(material, contact, hold(1000, 1300, 0));
  fill_periodic(s, Lattice::face_centred, 2, 1.9 * radius, radius);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> u(-0.08 * radius, 0.08 * radius);
  for (auto& b : s.particles.body) {
    const double x = u(random), y = u(random), z = u(random);
    b.position += Vec3(x, y, z);
  }
  s.integration.mass_scaling = mass_scaling;
  return s;
}

void make_necks(Simulation& sim) {
  bond_all(sim, dem::NeckPhase::sintering, 0.4);
  std::mt19937 random(8);
  std::uniform_real_distribution<double> u(0.9, 1.1);
  for (auto& neck : sim.mutable_state().contacts.neck) neck.radius *= u(random);
}

struct Answer {
  Vec6 early, late;  ///< stress at the two times [Pa]
  Mat6 stiffness, viscosity;
  Vec6 sintering;
};

Vec6 stress_now(Simulation& sim) {
  dem::Recording record;
  sim.evaluate(&record);
  const Mat3 s = contact_stress(sim, record, sim.state().cell.volume());
  return (Vec6() << s(0, 0), s(1, 1), s(2, 2), s(1, 2), s(0, 2), s(0, 1)).finished();
}

Answer run(const Mat3& gradient, double early, double late) {
  Setup s = shaken_crystal(1.72e-3, 1e9);  // little surface energy, so that necks hardly grow
  s.cell.velocity_gradient = gradient;
  Simulation sim(s);
  make_necks(sim);
  Answer a;
  a.stiffness =
      dem::elastic_answer(dem::network_of(sim), s.materials, dem::NeckModel::normal_spring, {}).response.relaxed;
  while (sim.state().time < early) sim.advance();
  a.early = stress_now(sim) / sim.state().time;
  while (sim.state().time < late) sim.advance();
  a.late = stress_now(sim);
  const auto v = dem::viscous_answer(dem::network_of(sim), {});
  a.viscosity = v.viscosity.response.relaxed, a.sintering = v.sintering_stress;
  return a;
}

// A step of the strain rate D on a network of springs and dashpots in series: early the stress is C : D t, in the end
// the sintering stress and N : D.  Early, after t = 0.02 s, dashpots have taken up to t/(2 eta/k) = 5 %; in the end,
// after ten of the longest relaxation times, exp(-10) and the geometry's change by the strain of 1e-4 are left: 0.1 %.
TEST(LiveNetwork, StepOfTheStrainRate) {
  constexpr double early = 0.02, late = 5;
  const Mat3 gradient = 2e-5 * (Mat3() << -1, 0.5, 0, 0, 0.3, 0, 0, 0, -0.6).finished();
  const Vec6 rate = (Vec6() << -1, 0.3, -0.6, 0, 0, 0.5).finished() * 2e-5;
  const Answer moved = run(gradient, early, late), still = run(Mat3::Zero(), early, late);
  const Vec6 elastic = moved.stiffness * rate;
  EXPECT_LT((moved.early - still.early - elastic).norm() / elastic.norm(), 5e-2);
  const Vec6 viscous = moved.viscosity * rate;
  EXPECT_GT(viscous.norm(), 5 * moved.sintering.norm());
  EXPECT_LT((moved.late - moved.sintering - viscous).norm() / viscous.norm(), 1e-3);
  EXPECT_LT((still.late - still.sintering).norm() / still.sintering.norm(), 1e-4);
}

// A cell free of stress that sinters in time shrinks at the rate of its network, -tr(N^-1 sigma_s).  The rate falls by
// a few per cent a second; over the window of 1 s about the network's moment its mean differs by the curvature: 0.2 %.
TEST(LiveNetwork, FreeDensification) {
  dem::Setup s = shaken_crystal(1.72, 1e9);
  dem::CellGoals free;
  for (auto& goal : free) goal = {dem::CellControl::stress, 0};
  s.cell_path = dem::CellPath{free, {free}};
  Simulation sim(s);
  make_necks(sim);
  auto run_until = [&](double time) {
    while (sim.state().time < time) sim.advance();
  };
  run_until(3);
  const double before = std::log(sim.state().cell.volume()), begin = sim.state().time;
  run_until(3.5);
  const double network = dem::viscous_answer(dem::network_of(sim), {}).densification_rate;
  run_until(4);
  const double live = (before - std::log(sim.state().cell.volume())) / (sim.state().time - begin);
  EXPECT_NEAR(network / live, 1, 2e-3);
}

}  // namespace
}  // namespace densify::test
