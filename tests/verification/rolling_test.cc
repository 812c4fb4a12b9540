// A sphere on a plane under Coulomb friction: sliding, spinning up, rolling, and the incline.

#include <gtest/gtest.h>

#include "tests/support/setups.h"

namespace densify::test {
namespace {

constexpr double radius = 5e-3, gravity = 10, mu = 0.2, k_n = 1e6;

/// One sphere at rest on the floor of a wide box, with its weight carried.
Setup on_the_floor(const Vec3& pull, const Vec3& velocity) {
  auto contact = elastic_model(dem::Elasticity::linear, k_n);
  contact.damping_ratio = 0.3;
  contact.friction = dem::FrictionModel{mu, mu, 2.0 / 7, 0.3};
  Setup s = empty_setup(copper(), contact, hold(1, 300, 0));
  s.container.shape = dem::ContainerShape::box;
  s.container.punch = false;
  s.container.size = Vec3::Constant(0.2);
  s.integration.gravity = pull;
  s.integration.fixed_step = 2e-6;
  const double weight = -pull[2] * 8920 * 4.0 / 3 * M_PI * std::pow(radius, 3);
  add_sphere(s.particles, Vec3(0.1, 0.1, radius - weight / k_n), radius, velocity);
  return s;
}

void run_until(Simulation& sim, double time) {
  while (sim.state().time < time) sim.advance(nullptr);
}

// Sliding: v = v_0 - mu g t while the spin grows as 5 mu g t/(2 r); rolling from t = 2 v_0/(7 mu g) on with 5/7 v_0.
// The tangential spring needs 2 us of sliding to stretch, 3e-4 of the time.
TEST(Rolling, SlidesThenRolls) {
  const double v0 = 0.05, t_roll = 2 * v0 / (7 * mu * gravity);
  Simulation sim(on_the_floor(Vec3(0, 0, -gravity), Vec3(v0, 0, 0)));
  run_until(sim, 0.5 * t_roll);
  const double t = sim.state().time;
  EXPECT_NEAR(body(sim, 0).velocity[0] / (v0 - mu * gravity * t), 1, 1e-3);
  EXPECT_NEAR(sim.state().particles.angular_velocity[0][1] / (2.5 * mu * gravity * t / radius), 1, 2e-3);
  run_until(sim, 3 * t_roll);
  EXPECT_NEAR(body(sim, 0).velocity[0] / (5 * v0 / 7), 1, 1e-3);
  EXPECT_NEAR(sim.state().particles.angular_velocity[0][1] * radius / body(sim, 0).velocity[0], 1, 1e-3);
}

// Incline: with tan(theta) < 3.5 mu the contact sticks and the sphere rolls with 5/7 g sin(theta); steeper it slips
// with g (sin(theta) - mu cos(theta)).
TEST(Rolling, InclineSticksAndSlips) {
  for (double slope : {0.5, 1.4}) {
    const double theta = std::atan(slope), end = 0.02;
    Simulation sim(on_the_floor(gravity * Vec3(std::sin(theta), 0, -std::cos(theta)), Vec3::Zero()));
    run_until(sim, end);
    const double a =
        slope < 3.5 * mu ? 5.0 / 7 * gravity * std::sin(theta) : gravity * (std::sin(theta) - mu * std::cos(theta));
    EXPECT_NEAR(body(sim, 0).velocity[0] / (a * sim.state().time), 1, 2e-3) << slope;
  }
}

// A block of three spheres, each pressed on the floor, cannot be dragged by a force below mu N when rolling is stopped
// by symmetry: here a sphere between floor and lid, pulled with half of 2 mu N, stays; with 1.2 of it, it leaves.
TEST(Rolling, StuckBetweenFloorAndLid) {
  for (double share : {0.5, 1.2}) {
    auto contact = elastic_model(dem::Elasticity::linear, k_n);
    contact.damping_ratio = 0.3;
    contact.friction = dem::FrictionModel{mu, mu, 2.0 / 7, 0.3};
    auto s = empty_setup(copper(), contact, hold(1, 300, 0));
    s.container.shape = dem::ContainerShape::box;
    s.container.punch = false;
    const double u = 1e-6, load = share * 2 * mu * k_n * u;
    s.container.size = Vec3(0.2, 0.2, 2 * (radius - u));
    s.integration.fixed_step = 2e-6;
    add_sphere(s.particles, Vec3(0.1, 0.1, radius - u), radius, Vec3::Zero());
    s.loads = {{0, Vec3(load, 0, 0), 5e-3}};
    Simulation sim(s);
    run_until(sim, 0.02);
    const double spring = load / (2 * 2.0 / 7 * k_n), moved = body(sim, 0).position[0] - 0.1;
    if (share < 1) {
      EXPECT_NEAR(moved / spring, 1, 0.02);
    } else {
      EXPECT_GT(moved, 10 * spring);
    }
  }
}

}  // namespace
}  // namespace densify::test
