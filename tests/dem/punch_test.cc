#include "dem/boundary/punch.h"

#include <gtest/gtest.h>

namespace densify::dem {
namespace {

constexpr double pressure = 3e7, area = 1e-9, load = pressure * area;

Punch punch_on(double stiffness, double damping_ratio) {
  Punch p;
  p.mass = 2e-3;
  p.area = area;
  p.tune(stiffness, damping_ratio);
  return p;
}

// Damper 2 xi sqrt(m k) and a memory of two periods 2 pi sqrt(m/k); without contact the last damper stays.
TEST(Punch, Tuning) {
  Punch p = punch_on(1e5, 0.3);
  EXPECT_NEAR(p.damping, 2 * 0.3 * std::sqrt(2e-3 * 1e5), 1e-12);
  EXPECT_NEAR(p.memory, 4 * M_PI * std::sqrt(2e-3 / 1e5), 1e-15);
  p.tune(0, 0.3);
  EXPECT_GT(p.damping, 0);
}

// A powder that yields like a dashpot C: the punch sinks with p A/C and the powder carries all of p A, although the
// punch's own damper would be ten times C: in steady motion it sees no difference to the running mean.
TEST(Punch, DamperTakesNoShareOfTheLoad) {
  Punch p = punch_on(1e5, 0.3);
  const double c = 0.1 * p.damping, step = 0.01 * p.mass / p.damping;
  for (int n = 0; n < 2000000; ++n) p.kick(-c * p.velocity, pressure, step);
  EXPECT_NEAR(-c * p.velocity / load, 1, 1e-6);
}

// Against an elastic powder it stills the punch: rest under p A with the spring shortened by p A/k.
TEST(Punch, ComesToRestOnASpring) {
  Punch p = punch_on(1e5, 0.3);
  const double step = 0.05 * std::sqrt(p.mass / 1e5);
  double z = 0;
  for (int n = 0; n < 200000; ++n) {
    p.kick(-1e5 * z, pressure, step);
    z += step * p.velocity;
  }
  EXPECT_NEAR(z / (-load / 1e5), 1, 1e-6);
  EXPECT_LT(std::abs(p.velocity), 1e-6 * load / std::sqrt(1e5 * p.mass));
}

// Thrown off the powder, without pressure, it flies on as it is: the running mean, still accelerating, must not drive
// it.
TEST(Punch, FliesFreelyWithoutContact) {
  Punch p = punch_on(1e5, 0.3);
  const double step = 0.05 * std::sqrt(p.mass / 1e5);
  for (int n = 0; n < 40; ++n) p.kick(1, 0, step);
  const double thrown = p.velocity;
  EXPECT_GT(p.mean_acceleration, 0);
  for (int n = 0; n < 100000; ++n) p.kick(0, 0, step);
  EXPECT_EQ(p.velocity, thrown);
}

}  // namespace
}  // namespace densify::dem
