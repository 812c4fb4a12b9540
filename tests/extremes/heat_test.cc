// Temperatures from 4 K to the melting point, heating from 1e-3 to 1e4 K/s, and every order of loading, activation and
// cooling.

#include <gtest/gtest.h>

#include "dem/measure/measures.h"
#include "tests/dem/small_packings.h"
#include "tests/extremes/necked_pair.h"
#include "tests/extremes/stopped.h"
#include "tests/extremes/table.h"

namespace densify::test {
namespace {

constexpr double radius = 5e-6;

/// A pair whose diffusion freezes in the cold: Delta H = 60 kJ/mol, D_eff of copper at 1300 K.
Setup thermal_pair(double force, const Schedule& schedule) {
  Setup s = copper_pair(copper_radius, copper_radius, force, 1);
  auto& d = s.materials[0].diffusion;
  d.activation_enthalpy = 60e3;
  d.prefactor *= std::exp(60e3 / (dem::gas_constant * 1300));
  s.schedule = schedule;
  return s;
}

/// Integral of D_eff(T(t)) over the times at which `active(T)`, as a time at 1300 K [s].
template <class Active>
double time_at_1300(const Setup& s, Active&& active) {
  const auto& d = s.materials[0].diffusion;
  const double end = s.schedule.end();
  const int n = 200000;
  double sum = 0;
  for (int k = 0; k < n; ++k) {
    const double t = s.schedule.temperature((k + 0.5) * end / n);
    if (active(t)) sum += d.effective(t) / d.effective(1300) * end / n;
  }
  return sum;
}

// At 4 K exp(-H/RT) is zero as a number: necks of every phase are rigid, and nothing becomes infinite or undefined.
TEST(Temperature, FourKelvin) {
  for (double relaxation : {0.0, 10.0}) {
    auto s = copper_pair(copper_radius, copper_radius, 0, 100);
    s.materials[0].diffusion.activation_enthalpy = 185e3;
    s.contact.sintering->relaxation_time = relaxation;
    s.schedule = hold(100, 4, 0);
    s.integration.mass_scaling = 1e12;
    EXPECT_EQ(s.materials[0].diffusion.effective(4), 0);
    for (auto phase : {dem::NeckPhase::loose, dem::NeckPhase::activating, dem::NeckPhase::sintering,
                       dem::NeckPhase::arriving, dem::NeckPhase::deactivating, dem::NeckPhase::dormant}) {
      Simulation sim(s);
      bond_all(sim, phase, 0.1);
      run_to_end(sim);
      // Only elastic: F_sint/k of two radii is 1.5e-5.
      EXPECT_LT(std::abs(approach(sim)), 1e-4 * copper_radius) << int(phase);
      const auto& neck = sim.state().contacts.neck[0];
      EXPECT_TRUE(std::isfinite(neck.radius) && std::isfinite(neck.elastic)) << int(phase);
    }
  }
}

// A viscous neck without diffusion is rigid, and has no step: said, not tried.
TEST(Temperature, ViscousNeckInTheColdIsRefused) {
  auto s = copper_pair(copper_radius, copper_radius, 0, 100);
  s.materials[0].diffusion.activation_enthalpy = 185e3;
  s.contact.sintering->model = dem::SinteringModel::viscous;
  s.schedule = hold(100, 4, 0);
  EXPECT_STOPS(Simulation{s}, "nothing diffuses between \"Cu\" and \"Cu\" at 4.0", "viscoelastic");
}

// Heated from 4 K to the melting point at 1e-3 to 1e4 K/s, the diffusivity as much faster as the heating: the same
// strain each time, that of the integral of D_eff(T(t)) dt.
TEST(Temperature, HeatingRates) {
  Table table("heating_rate", "rate,error");
  for (double rate : {1e-3, 1.0, 1e2, 1e4}) {
    const double duration = (1357 - 4) / rate;
    auto s = thermal_pair(0, Schedule(4, 0, {{"heat", duration, 1357, 0}}));
    s.materials[0].diffusion.prefactor *= 1e4 / duration;
    s.integration.mass_scaling = 1e14 * std::pow(duration / 1e4, 2);
    Simulation sim(s);
    run_to_end(sim);
    auto exact = exact_pair(copper_radius, 0);
    exact.diffusivity = s.materials[0].diffusion.effective(1300);
    const double equivalent = time_at_1300(s, [](double) { return true; });
    const double due = exact.approach(equivalent, copper_radius, exact.integrated());
    table.row(rate, approach(sim) / due - 1);
    EXPECT_GT(due, 0.02 * copper_radius);
    EXPECT_NEAR(approach(sim) / due, 1, 1e-3) << rate;
  }
}

// A bonded pair follows every heating rate with the strain alpha dT, and shakes no more than its inertia must: the
// growth of 2 r alpha dT/dt starts at once, and rings with an amplitude of rate/omega.
TEST(Temperature, ExpansionAtEveryRate) {
  for (double rate : {1e-3, 1.0, 1e4}) {
    auto contact = elastic_model(dem::Elasticity::linear, 1e5);
    contact.sintering = dem::SinteringSettings{};
    auto material = nickel_aluminide();
    material.activation_temperature = 5000;
    const double duration = 1600 / rate;
    auto s = empty_setup(material, contact, Schedule(300, 0, {{"heat", duration, 1900, 0}}));
    s.integration.mass_scaling = 1e10 * std::pow(duration, 2);
    for (int i = 0; i < 2; ++i) add_sphere(s.particles, Vec3(0, 0, i * 1.99 * radius), radius, Vec3::Zero());
    Simulation sim(s);
    bond_all(sim, dem::NeckPhase::dormant, 0.3);
    run_to_end(sim);
    const double length = (body(sim, 1).position - body(sim, 0).position).norm();
    const double mass = s.integration.mass_scaling * 5910 * 4.0 / 3 * M_PI * std::pow(radius, 3);
    const double ringing = 11.5e-6 * rate * std::sqrt(0.5 * mass / 1e5);
    EXPECT_NEAR(length / (1.99 * radius) - 1, 11.5e-6 * 1600, 2 * ringing + 1e-4 * 11.5e-6 * 1600) << rate;
  }
}

// Loaded while it is heated through activation, cooled through it, heated and cooled again: the neck flows while it is
// active and is a bond while not, and carries the load in every stage.  Against the integral of D over the active
// times; elasticity and the cut of the load's first rise count for a hundredth.
TEST(Activation, DuringLoadingAndThereAndBackAgain) {
  const double force = 3e-3;
  auto s = thermal_pair(force, Schedule(300, 0,
                                        {{"load and heat", 400, 1300, 0},
                                         {"cool", 400, 500, 0},
                                         {"heat", 400, 1300, 0},
                                         {"cool again", 400, 300, 0}}));
  for (auto& load : s.loads) load.ramp = 390;  // activation, at 900 K, is after 240 s
  s.materials[0].activation_temperature = 900;
  s.materials[0].diffusion.prefactor *= 20;
  s.integration.mass_scaling = 1e13;
  Simulation sim(s);
  dem::Recording record;
  double before = 0;
  for (double stage : {400.0, 800.0, 1200.0, 1600.0}) {
    while (sim.state().time < stage) sim.advance();
    sim.evaluate(&record);
    EXPECT_NEAR(record.contact[0].normal / -force, 1, 2e-3) << stage;
    sim.move();
    EXPECT_GE(approach(sim), before * (1 - 1e-3));
    before = approach(sim);
  }
  EXPECT_EQ(sim.state().contacts.neck[0].phase, dem::NeckPhase::dormant);
  auto exact = exact_pair(copper_radius, 0);
  exact.diffusivity = s.materials[0].diffusion.effective(1300);
  // The load stands at its mean of the first active stage, weighted with D, then at its full value: bounds on the
  // force.
  const double time = time_at_1300(s, [](double t) { return t >= 900; });
  exact.force = force;
  EXPECT_LT(before, 1.01 * exact.approach(time, copper_radius, exact.integrated()));
  exact.force = 0.85 * force;
  EXPECT_GT(before, 0.99 * exact.approach(time, copper_radius, exact.integrated()));
}

// A packing under pressure with friction, through activation while the load still rises, down through it and up again,
// with and without smooth transitions: it densifies in the hot stages, holds in the cold ones, and stays whole.
TEST(Activation, APackingThereAndBackAgain) {
  for (double relaxation : {0.0, 0.05}) {
    auto s = dem::testing::cylinder_packing(1);
    s.contact.sintering->relaxation_time = relaxation;
    s.schedule = Schedule(953, 0,
                          {{"press and heat", 0.3, 960, 30e6},
                           {"cool", 0.3, 950, 30e6},
                           {"heat", 0.3, 960, 30e6},
                           {"cool again", 0.3, 950, 30e6},
                           {"unload", 0.3, 950, 0}});
    Simulation sim(s);
    dem::Recording record;
    double density = 0;
    for (double stage : {0.3, 0.6, 0.9, 1.2}) {
      while (sim.state().time < stage) sim.advance();
      sim.evaluate(&record);
      const auto m = measure(sim, record);
      sim.move();
      EXPECT_GT(m.relative_density, density - 2e-3) << stage;
      EXPECT_TRUE(m.stress.allFinite());
      density = m.relative_density;
    }
    run_to_end(sim);
    for (const auto& h : sim.state().contacts.neck)
      EXPECT_TRUE(h.phase == dem::NeckPhase::loose || h.phase == dem::NeckPhase::dormant ||
                  h.phase == dem::NeckPhase::bonded)
          << int(h.phase);
  }
}

}  // namespace
}  // namespace densify::test
