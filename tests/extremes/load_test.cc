// Loads of any size: pressures to 1 GPa and their jumps, densities above one.

#include <gtest/gtest.h>

#include "dem/measure/measures.h"
#include "tests/dem/small_packings.h"
#include "tests/extremes/necked_pair.h"
#include "tests/extremes/stopped.h"
#include "tests/extremes/table.h"

namespace densify::test {
namespace {

constexpr double radius = 5e-6, width = 2.2 * radius;

/// One sphere between bottom and punch in a box that is wider than itself.
Setup pressed_sphere(const Schedule& schedule) {
  auto contact = elastic_model(dem::Elasticity::hertz, dem::unset);
  contact.damping_ratio = 0.5;
  Setup s = empty_setup(copper(), contact, schedule);
  s.container.shape = dem::ContainerShape::box;
  s.container.size = Vec3(width, width, 2 * radius);
  add_sphere(s.particles, Vec3(0.5 * width, 0.5 * width, radius), radius, Vec3::Zero());
  return s;
}

/// (p A / ((4/3) E/(1 - nu^2) sqrt(r)))^(2/3), a rigid plane on a sphere [m].
double plate_overlap(double pressure) {
  return std::pow(pressure * width * width / (4.0 / 3 * 1e11 / 0.91 * std::sqrt(radius)), 2.0 / 3);
}

double gap(const Simulation& sim) {
  return sim.state().walls.wall[*sim.wall("punch")].point[2];
}

// The pressure is there from the first step on and stays: after some hundred periods the plates stand where Hertz says.
// Without pressure nothing moves.
TEST(Pressure, FromNothingToAGigapascalAtOnce) {
  Table table("pressure", "pressure,error");
  for (double pressure : {0.0, 1e3, 1e5, 1e7, 1e9}) {
    const double due = plate_overlap(pressure);
    const double k = 1.5 * 4.0 / 3 * 1e11 / 0.91 * std::sqrt(radius * std::max(due, 1e-3 * radius));
    const double mass = 8920 * 4.0 / 3 * M_PI * std::pow(radius, 3);
    Simulation sim(pressed_sphere(hold(1500 * std::sqrt(mass / k), 300, pressure)));
    run_to_end(sim);
    if (pressure == 0) {
      EXPECT_EQ(gap(sim), 2 * radius);
      continue;
    }
    const double error = (2 * radius - gap(sim)) / (2 * due) - 1;
    table.row(pressure, error);
    EXPECT_LT(std::abs(error), 1e-3) << pressure;
    EXPECT_NEAR((body(sim, 0).position[2] - radius + due) / due, 0, 1e-3) << pressure;
  }
}

// 0, 1 GPa, 0 again, each within a millionth of the process: the elastic sphere is pressed, springs back and is left
// alone by the punch; no force is left, and the energy that the punch carries off is at most the work that it did.
TEST(Pressure, JumpsUpAndDown) {
  const double time = 1e-5, due = plate_overlap(1e9);
  Simulation sim(pressed_sphere(Schedule(300, 0,
                                         {{"rest", time, 300, 0},
                                          {"up", 1e-6 * time, 300, 1e9},
                                          {"hold", time, 300, 1e9},
                                          {"down", 1e-6 * time, 300, 0},
                                          {"free", time, 300, 0}})));
  while (sim.state().time < 2.0000005 * time) sim.advance();
  EXPECT_NEAR((2 * radius - gap(sim)) / (2 * due), 1, 0.02);
  run_to_end(sim);
  EXPECT_EQ(sim.state().walls.normal_force()[*sim.wall("punch")], 0);
  EXPECT_GT(gap(sim), 2 * radius);
  const auto& punch = sim.state().punch;
  EXPECT_LT(0.5 * punch.mass * punch.velocity * punch.velocity, 1e9 * width * width * 2 * due);
}

// A thousand times more than the sphere can carry by its elasticity: it does not come out as a number.
TEST(Pressure, BeyondTheContact) {
  Simulation sim(pressed_sphere(hold(1e-5, 300, 1e12)));
  EXPECT_STOPS(run_to_end(sim), "particle 0", "");
}

// A packing with friction, hot walls and necks to come, all of 1 GPa on it within one step: the punch carries it in the
// mean, or the run stops and says why.
TEST(Pressure, JumpOnAPacking) {
  for (double pressure : {3e7, 3e8, 1e9}) {
    auto s = dem::testing::cylinder_packing(1);
    s.integration.mass_scaling = 1e10;
    s.contact.damping_ratio = 0.5;
    s.schedule = Schedule(953, 0, {{"jump", 1e-6, 953, pressure}, {"hold", 0.1, 953, pressure}});
    Simulation sim(s);
    expect_pressure_is_carried(sim, pressure, 0.05);
  }
}

// An FCC crystal compressed to a relative density of 1.2, where spheres overlap and pores would have closed: density,
// coordination number and pressure sqrt(2) 2 F/d^2 (Hertz) stay what geometry says; nothing is capped in silence.
TEST(Density, AboveOne) {
  auto contact = elastic_model(dem::Elasticity::hertz, dem::unset);
  auto s = empty_setup(copper(), contact, hold(1, 300, 0));
  const double spacing = 2 * radius * std::cbrt(M_PI / std::sqrt(18.0) / 1.2);
  fill_periodic(s, Lattice::face_centred, 3, spacing, radius);
  Simulation sim(s);
  dem::Recording record;
  sim.evaluate(&record);
  const auto m = measure(sim, record);
  EXPECT_NEAR(m.relative_density, 1.2, 1e-12);
  EXPECT_NEAR(m.relative_density_inner, 1.2, 0.05);
  EXPECT_EQ(m.coordination_number, 12);
  const double overlap = 2 * radius - spacing, modulus = 1e11 / (2 * 0.91);
  const double force = 4.0 / 3 * modulus * std::sqrt(0.5 * radius) * std::pow(overlap, 1.5);
  for (int k = 0; k < 3; ++k)
    EXPECT_NEAR(m.stress(k, k) / (-2 * std::sqrt(2.0) * force / (spacing * spacing)), 1, 1e-9);
  sim.move();
  run_at_most(sim, 2000);  // a crystal at rest stays so
  EXPECT_LT(kinetic_energy(sim.state().particles), 1e-12 * m.elastic_energy);
}

// The way there: a cell that shrinks through relative density 1 carries the crystal with it.
TEST(Density, ThroughOneByACell) {
  auto contact = elastic_model(dem::Elasticity::hertz, dem::unset);
  auto s = empty_setup(copper(), contact, hold(0.01, 300, 0));
  fill_periodic(s, Lattice::face_centred, 3, 2 * radius, radius);
  s.cell.velocity_gradient = std::log(std::cbrt(0.7405 / 1.1)) / 0.01 * Mat3::Identity();
  s.integration.mass_scaling = 1e6;
  Simulation sim(s);
  run_to_end(sim);
  dem::Recording record;
  sim.evaluate(&record);
  EXPECT_NEAR(measure(sim, record).relative_density, 1.1, 2e-3);
  EXPECT_EQ(measure(sim, record).coordination_number, 12);
}

}  // namespace
}  // namespace densify::test
