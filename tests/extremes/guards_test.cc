// Each guard: what it stops, and what it says.

#include <gtest/gtest.h>

#include "base/check.h"
#include "tests/dem/small_packings.h"
#include "tests/extremes/stopped.h"

namespace densify::test {
namespace {

constexpr double radius = 5e-6;

/// Two bonded spheres that overlap by a thousandth, at rest but for a relative velocity along their line [m/s].
Simulation bonded_pair(double step_safety, double speed) {
  auto contact = elastic_model(dem::Elasticity::linear, 1e5);
  contact.sintering = dem::SinteringSettings{};
  contact.sintering->damping_ratio = 0;
  auto s = empty_setup(copper(), contact, hold(1, 1300, 0));
  s.integration.step_safety = step_safety;
  for (int i = 0; i < 2; ++i) add_sphere(s.particles, Vec3(0, 0, i * 1.999 * radius), radius, Vec3(0, 0, i * speed));
  Simulation sim(s);
  bond_all(sim, dem::NeckPhase::bonded, 0.3);
  return sim;
}

TEST(Guard, NonFinite) {
  auto s = empty_setup(copper(), elastic_model(dem::Elasticity::hertz, dem::unset), hold(1, 300, 0));
  fill_periodic(s, Lattice::face_centred, 2, 1.99 * radius, radius);
  Simulation sim(s);
  run_at_most(sim, 10);
  auto& particles = sim.mutable_state().particles;
  particles.body[place(particles, 5)].velocity[1] = dem::unset;
  EXPECT_STOPS(run_at_most(sim, 33), "is no longer finite", "step_safety");
}

// A force that overflows when it is squared is as good as infinite; what the particle touches is named.
TEST(Guard, HugeForce) {
  auto sim = bonded_pair(0.5, 0);
  sim.mutable_state().contacts.neck[0].elastic = 1e160;
  EXPECT_STOPS(run_at_most(sim, 33), "of particle 0 is no longer finite",
               "deepest contact is with particle 1, overlap 0.001 of the smaller radius");
}

TEST(Guard, TooDeep) {
  auto contact = elastic_model(dem::Elasticity::linear, 1e5);
  contact.damping_ratio = 0.5;
  auto s = empty_setup(copper(), contact, hold(1, 300, 0));
  for (int i = 0; i < 2; ++i) add_sphere(s.particles, Vec3(0, 0, i * 2 * radius), radius, Vec3::Zero());
  const double force = 1.6 * radius * 1e5;  // due: an overlap of 1.6 radii
  s.loads = {{0, Vec3(0, 0, force), 5e-5}, {1, Vec3(0, 0, -force), 5e-5}};
  Simulation deep(s);
  EXPECT_STOPS(run_at_most(deep, 100000), "particles 0 and 1 have gone too far into each other",
               "of the smaller radius, at most 1.5");
  s.integration.guards.largest_overlap = 1.7;
  Simulation allowed(s);
  run_at_most(allowed, 20000);
  EXPECT_NEAR((2 * radius - (body(allowed, 1).position - body(allowed, 0).position).norm()) / (1.6 * radius), 1, 1e-6);
}

// The list's skin is wide here: the guard, not a rebuild of the list, meets the centre beyond the wall.
TEST(Guard, Escaped) {
  auto s = empty_setup(copper(), elastic_model(dem::Elasticity::linear, 1e5), hold(1, 300, 0));
  s.container.shape = dem::ContainerShape::box;
  s.container.punch = false;
  s.container.size = Vec3::Constant(10 * radius);
  s.integration.skin = 10;
  s.integration.step_safety = 0.05;
  const double mass = 8920 * 4.0 / 3 * M_PI * std::pow(radius, 3);
  add_sphere(s.particles, Vec3(5, 5, 1.01) * radius, radius, Vec3(0, 0, -1.5 * radius * std::sqrt(1e5 / mass)));
  Simulation sim(s);
  EXPECT_STOPS(run_at_most(sim, 1000), "particle 0 has left the bottom", "its centre is beyond the wall");
}

TEST(Guard, PastItsOwnRadiusInAStep) {
  auto s = empty_setup(copper(), elastic_model(dem::Elasticity::linear, 1e5), hold(1, 300, 0));
  add_sphere(s.particles, Vec3::Zero(), radius, Vec3::Zero());
  add_sphere(s.particles, Vec3(0, 0, 1e4 * radius), radius, Vec3::Zero());
  Simulation sim(s);
  run_at_most(sim, 1);
  auto& particles = sim.mutable_state().particles;
  particles.body[place(particles, 1)].velocity[2] = -1.2 * radius / sim.state().last_step;
  EXPECT_STOPS(run_at_most(sim, 40), "particle 1 moves by 1.2 of its radius in one step", "it touches no other");
}

// At omega dt = 2.002 the amplitude grows by 9 % a step (x + 1/x = 2 - (omega dt)^2), from nothing that could drive it;
// at 0.99 of the limit the same bond swings for ever.
TEST(Guard, EnergyFromNowhere) {
  auto sim = bonded_pair(1.001, 1e-9);
  EXPECT_STOPS(run_at_most(sim, 200), "kinetic energy has grown to", "particle");
  auto stable = bonded_pair(0.99, 1e-9);
  run_at_most(stable, 100000);
  EXPECT_LT(std::abs(body(stable, 1).velocity[2]), 1e-9 / std::sqrt(1 - 0.99 * 0.99));
}

// A stiffness that outgrows a fixed step ends the run at the next evaluation of the limit.
TEST(Guard, FixedStepAboveTheLimit) {
  auto s = empty_setup(copper(), elastic_model(dem::Elasticity::linear, 1e5), hold(1, 300, 0));
  for (int i = 0; i < 2; ++i) add_sphere(s.particles, Vec3(0, 0, i * 1.999 * radius), radius, Vec3::Zero());
  Simulation probe(s);
  s.integration.fixed_step = 1.01 * probe.step_limit().critical;
  Simulation sim(s);
  EXPECT_STOPS(run_at_most(sim, 1), "fixed_step", "stability limit");
  EXPECT_THROW(Simulation(s).require_stable_step(), InputError);
  s.integration.fixed_step = 0.99 * probe.step_limit().critical;
  Simulation fine(s);
  run_at_most(fine, 100);
}

// A step below the spacing of the clock's numbers would never end.
TEST(Guard, ClockThatStandsStill) {
  auto sim = bonded_pair(0.5, 0);
  sim.mutable_state().time = 0.999999999999;  // of 1 s; the next numbers are 1e-16 s away
  for (auto& b : sim.mutable_state().particles.body) b.inverse_mass *= 1e20;
  EXPECT_STOPS(run_at_most(sim, 10), "no longer moves the process time", "mass_scaling");
}

// Two spheres of copper with their real mass and 1e10 s of process are 1e18 steps.
TEST(Guard, MoreStepsThanCanBeDone) {
  auto s = empty_setup(copper(), elastic_model(dem::Elasticity::linear, 1e5), hold(1e10, 300, 0));
  add_sphere(s.particles, Vec3::Zero(), radius, Vec3::Zero());
  try {
    Simulation(s).require_stable_step();
    ADD_FAILURE() << "accepted";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("integration.mass_scaling: the process of 1e+10 s"), std::string::npos)
        << error.what();
  }
}

// A column under a punch: with a mass factor of 1e4 it is pressed quasi-statically, with 1e12 it swings in its own
// inertia for the whole process.
TEST(Guard, QuasiStaticCriterion) {
  for (const auto& [factor, fine] : {std::pair{1e4, true}, {1e12, false}}) {
    auto contact = elastic_model(dem::Elasticity::hertz, dem::unset);
    contact.damping_ratio = 0.3;
    const Schedule schedule(300, 0, {{"ramp", 0.01, 300, 30e6}});
    auto s = empty_setup(copper(), contact, schedule);
    s.container.shape = dem::ContainerShape::box;
    s.container.size = radius * Vec3(2, 2, 10);
    for (int k = 0; k < 5; ++k) add_sphere(s.particles, radius * Vec3(1, 1, 2 * k + 1), radius, Vec3::Zero());
    s.integration.mass_scaling = factor;
    s.integration.largest_step = 1e-6;
    Simulation sim(s);
    while (!sim.finished()) sim.advance();
    const double share = sim.guards().not_quasi_static() / 0.01;
    if (fine) {
      EXPECT_LT(share, 0.02);
    } else {
      EXPECT_GT(share, 0.5);
    }
  }
}

// Guards look and never touch: the same bits with and without them, friction, necks, walls, punch and heat switched on.
TEST(Guard, ChangesNoBit) {
  for (const auto& make : {dem::testing::cylinder_packing, dem::testing::periodic_packing}) {
    auto s = make(1);
    Simulation with(s);
    s.integration.guards.guarding = dem::Guarding::off;
    Simulation without(s);
    run_at_most(with, 700);
    run_at_most(without, 700);
    EXPECT_TRUE(dem::testing::StateBits(with.state()) == dem::testing::StateBits(without.state()));
  }
}

}  // namespace
}  // namespace densify::test
