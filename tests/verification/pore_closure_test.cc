// Pore closure: crystals under pressure against a quadrature, the same law with a smaller mobility, instruction sets,
// what a network of contacts has of it, and the powder in a periodic cell that no longer passes full density.

#include <gtest/gtest.h>

#include <cstdlib>

#include "dem/io/scene.h"
#include "dem/network/moduli.h"
#include "dem/specimen.h"
#include "tests/dem/small_packings.h"
#include "tests/support/law_driver.h"
#include "tests/support/neck_quadrature.h"
#include "tests/support/setups.h"

namespace densify::test {
namespace {

using dem::testing::StateBits;

// From relative density 1 - onset on a contact keeps porosity/onset of its flow, at least a thousandth.
TEST(PoreClosure, ShareOfTheFlow) {
  EXPECT_EQ(dem::flow_share(0.7, 0.1), 1);
  EXPECT_EQ(dem::flow_share(0.9, 0.125), (1 - 0.9) / 0.125);
  EXPECT_EQ(dem::flow_share(1.05, 0.1), 1e-3);
}

// A contact of share s is, bit for bit, one whose mobility is s times as large, through its whole life; a share of 1
// changes nothing.
TEST(PoreClosure, IsASmallerMobility) {
  using Law = dem::SinteringContact<dem::HertzSpring>;
  constexpr double share = 0.25;  // a power of two: products are exact
  const DriverPair pair{1e-5, 1e-9};
  for (const auto model : {dem::SinteringModel::viscoelastic, dem::SinteringModel::viscous})
    for (const auto at_equilibrium : {dem::AtEquilibrium::elastic_bond, dem::AtEquilibrium::viscous}) {
      dem::SinteringSettings settings;
      settings.model = model;
      settings.at_equilibrium = at_equilibrium;
      settings.relaxation_time = 20;
      settings.viscosity_before = 1e-3;  // below the theory's, so that it never counts
      Law closed{{{1e11, 3e-4}, 0.1}, settings, 1e-28, 1.5, 2.8, 0.15, true, true};
      Law slow = closed;
      slow.mobility_factor *= share;
      dem::NeckHistory a, b;
      bool arrived = false;
      for (int n = 0; n < 3000; ++n) {
        closed.active = slow.active = n < 600 || n > 900;
        closed.activation_step = slow.activation_step = n == 0;
        dem::NormalInput in = driver_input(pair, -1e-8 - 1e-10 * n, -1e-10, 0.1, 0.1 * n);
        const auto g = slow.update(in, b);
        const double stiffness = slow.step_stiffness(in, b, 0.1), viscosity = slow.linearise(in, b).viscosity;
        in.flow_share = share;
        const auto f = closed.update(in, a);
        ASSERT_EQ(f.total, g.total) << n;
        ASSERT_EQ(a.elastic, b.elastic) << n;
        ASSERT_EQ(a.phase, b.phase) << n;
        ASSERT_EQ(closed.step_stiffness(in, a, 0.1), stiffness) << n;
        ASSERT_EQ(closed.linearise(in, a).viscosity, viscosity) << n;
        arrived = arrived || a.phase == dem::NeckPhase::bonded;
      }
      EXPECT_TRUE(arrived);
    }
}

struct Crystal {
  const char* name;
  Lattice lattice;
  double contacts;  // of a sphere
  double volume;    // of a sphere over d^3
  double highest;   // approach of two spheres over the radius
  double onset;

  double porosity(double r, double d) const { return 1 - 4.0 / 3 * M_PI * r * r * r / (volume * d * d * d); }
};

const Crystal crystals[] = {{"SC", Lattice::simple_cubic, 6, 1, 0.38, 0.3},
                            {"BCC", Lattice::body_centred, 8, 4 / (3 * std::sqrt(3.0)), 0.235, 0.2},
                            {"FCC", Lattice::face_centred, 12, 1 / std::sqrt(2.0), 0.185, 0.1}};

/// Copper spheres that just touch in a periodic cell of the crystal: without neighbours of their own kind they cannot
/// buckle.
dem::Setup touching(const Crystal& c, double r, const Schedule& schedule) {
  auto contact = elastic_model(dem::Elasticity::linear, 7e7);
  contact.sintering = dem::SinteringSettings{};
  contact.sintering->relaxation_time = 0;
  contact.sintering->damping_ratio = 0;
  contact.sintering->starting_neck = 1e-3;
  contact.sintering->closing_porosity = c.onset;
  auto s = empty_setup(copper(), contact, schedule);
  fill_periodic(s, c.lattice, 1, 2 * r * (1 - 1e-9), r);
  s.integration.mass_scaling = 1e17;
  return s;
}

constexpr double copper_radius = 22.5e-6;
NeckQuadrature copper_pair() {
  const dem::Material m = copper();
  return {copper_radius, m.diffusion.effective(1300), m.surface_energy, m.dihedral_angle, 0};
}

// SC, BCC and FCC compressed from all sides at a constant rate, into the last per cents of porosity.  The pressure
// is that of Z/2 contacts a sphere, each with F = eta d'/share + F_sint, eta = pi a^4/(8 D), a^2 = 2 r u:
// p = -Z F d/(6 V), V the volume of a sphere's cell.  The spring in series lags by eta/(k share), some thousandths of
// the pressure where the pores are nearly closed.
TEST(PoreClosure, PressureOfCrystals) {
  constexpr double r = copper_radius, time = 1e5;
  const NeckQuadrature pair = copper_pair();
  for (const Crystal& c : crystals) {
    dem::Setup s = touching(c, r, Schedule(1300, 0, {{"press", time, 1300, 0}}));
    const double rate = std::log(1 - 0.5 * c.highest) / time;
    dem::CellGoals goals;
    for (std::size_t k = 0; k < 6; ++k) goals[k] = {dem::CellControl::rate, k < 3 ? rate : 0};
    s.cell_path = dem::CellPath{goals, {goals}};
    Simulation sim(s);
    dem::Recording record;
    int looked = 0;
    double lowest = 1;
    while (!sim.finished()) {
      const bool look = sim.state().time > (0.2 + 0.1 * looked) * time;
      sim.evaluate(look ? &record : nullptr);
      if (look) {
        ++looked;
        const double d = 2 * r * (1 - 1e-9) * std::exp(rate * sim.state().time), u = 2 * r - d,
                     a = std::sqrt(2 * r * u);
        const double porosity = c.porosity(r, d), share = std::min(1.0, porosity / c.onset);
        const double viscous = M_PI * std::pow(a, 4) / (8 * pair.diffusivity) * rate * d / share;
        const double per_force = c.contacts / (6 * c.volume * d * d);
        const double mean = contact_stress(sim, record, sim.state().cell.volume()).trace() / 3;
        EXPECT_NEAR(mean / per_force, viscous + pair.driving(a), 5e-3 * (pair.driving(a) - viscous))
            << c.name << " porosity " << porosity;
        lowest = std::min(lowest, porosity);
      }
      sim.move();
    }
    EXPECT_EQ(looked, 8);
    EXPECT_LT(lowest, 0.08);
  }
}

// Free sintering of FCC until two per cent of porosity are left: every contact flows under its sintering force alone,
// as a pair does, at the share of the porosity that is left.  The approach within 1e-3, as without pores.
TEST(PoreClosure, FreeSinteringOfACrystal) {
  constexpr double r = copper_radius;
  const NeckQuadrature pair = copper_pair();
  const Crystal& c = crystals[2];
  const auto time_to = [&](double u, double onset) {
    return u * simpson(
                   [&](double s) {
                     const double a = std::sqrt(2 * r * s * u);
                     const double share = std::min(1.0, c.porosity(r, 2 * r - s * u) / onset);
                     return M_PI * std::pow(a, 4) / (8 * pair.diffusivity) / pair.driving(a) / share;
                   },
                   4000);
  };
  const double u = 0.18 * r, time = time_to(u, c.onset);
  EXPECT_GT(time / time_to(u, 1e-9), 1.5);  // the pores do resist
  dem::Setup s = touching(c, r, Schedule(1300, 0, {{"sinter", time, 1300, 0}}));
  dem::CellGoals goals;
  goals.fill({dem::CellControl::stress, 0});
  s.cell_path = dem::CellPath{goals, {goals}};
  Simulation sim(s);
  while (!sim.finished()) sim.advance(nullptr);
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(2 * r * (1 - sim.state().cell_drive.deformation(i, i)) / u, 1, 1e-3) << i;
}

dem::State after(Setup setup, int steps) {
  Simulation sim(std::move(setup));
  dem::testing::run_steps(sim, steps);
  return sim.state();
}

TEST(PoreClosure, EveryInstructionSetGivesTheSameBits) {
  for (const auto model : {dem::SinteringModel::viscoelastic, dem::SinteringModel::viscous}) {
    std::vector<StateBits> ends;
    for (const auto& kernels : dem::available_kernels()) {
      setenv("DENSIFY_INSTRUCTIONS", kernels.name, 1);
      dem::Setup s = dem::testing::closing_packing(1);
      s.contact.sintering->model = model;
      ends.emplace_back(after(std::move(s), 300));
    }
    unsetenv("DENSIFY_INSTRUCTIONS");
    for (const auto& end : ends) EXPECT_EQ(end, ends[0]) << int(model);
  }
}

// Pores that resist from a porosity that the packing never sees: bit for bit the packing without them.
TEST(PoreClosure, FarFromClosingNothingChanges) {
  dem::Setup s = dem::testing::closing_packing(1);
  s.contact.sintering->closing_porosity = 1e-3;
  dem::State end = after(std::move(s), 200);
  EXPECT_FALSE(end.local_density.of.empty());
  end.local_density = {};
  EXPECT_EQ(StateBits(end), StateBits(after(dem::testing::driven_packing(1), 200)));
  EXPECT_FALSE(StateBits(end) == StateBits(after(dem::testing::closing_packing(1), 200)));
}

// The viscosity of a crystal is larger by the share of its flow that is left; the stress with which it pulls itself
// together is the same.
TEST(PoreClosure, ViscosityOfANetwork) {
  constexpr double r = 5e-6, spacing = 2 * r * 0.97, onset = 0.5;
  const auto answer = [&](double closing_porosity) {
    auto contact = elastic_model(dem::Elasticity::linear, 1e5);
    contact.sintering = dem::SinteringSettings{};
    contact.sintering->closing_porosity = closing_porosity;
    auto s = empty_setup(copper(), contact, hold(1, 1300, 0));
    fill_periodic(s, Lattice::body_centred, 3, spacing, r);
    Simulation sim(s);
    bond_all(sim, dem::NeckPhase::sintering, 0.4);
    sim.refresh();
    return viscous_answer(network_of(sim), {});
  };
  const double volume = 4 / (3 * std::sqrt(3.0)) * spacing * spacing * spacing;
  const double share = (1 - 4.0 / 3 * M_PI * r * r * r / volume) / onset;
  ASSERT_LT(share, 0.6);
  const auto open = answer(dem::unset), closing = answer(onset);
  for (int k = 0; k < 3; ++k) {
    const double ratio = closing.viscosity.response.relaxed(k, k) / open.viscosity.response.relaxed(k, k);
    EXPECT_NEAR(ratio * share, 1, 1e-8);
    EXPECT_NEAR(closing.sintering_stress[k] / open.sintering_stress[k], 1, 1e-8);
  }
  EXPECT_NEAR(closing.densification_rate / (share * open.densification_rate), 1, 1e-8);
}

// The example: 500 grains under 30 MPa, an hour at 1400 degC.
TEST(PoreClosure, PowderInAPeriodicCellEndsBelowFullDensity) {
  const auto scene = dem::read_scene(std::filesystem::path(DENSIFY_EXAMPLES) / "sinter_nial_rve", {});
  Simulation sim(dem::make_setup(scene, dem::make_specimen(scene, 1, {}), 1));
  double highest = 0;
  while (!sim.finished()) {
    sim.advance(nullptr);
    const auto& s = sim.state();
    highest = std::max(highest, powder_density(s.particles, powder_room(s.particles, s.cell, s.walls)));
  }
  EXPECT_GT(highest, 0.97);
  EXPECT_LT(highest, 1);
}

}  // namespace
}  // namespace densify::test
