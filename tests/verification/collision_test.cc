// Head-on collisions: restitution and collision time in closed form.

#include <gtest/gtest.h>

#include "tests/support/setups.h"

namespace densify::test {
namespace {

constexpr double radius = 5e-6, speed = 0.1;

struct Collision {
  double restitution, duration, largest_overlap;
};

/// Two spheres that just touch and approach with `speed`; `step` [s].
Collision collide(const dem::ContactModel& contact, double step) {
  Setup s = empty_setup(copper(), contact, hold(1, 300, 0));
  s.integration.fixed_step = step;
  add_sphere(s.particles, Vec3::Zero(), radius, Vec3::Zero());
  add_sphere(s.particles, Vec3(0, 0, 2 * radius), radius, Vec3(0, 0, -speed));
  Simulation sim(s);
  Collision c{0, 0, 0};
  sim.advance(nullptr);  // the first drift makes the contact
  while (true) {
    const double overlap = 2 * radius - (body(sim, 1).position - body(sim, 0).position).norm();
    if (overlap <= 0) break;
    c.largest_overlap = std::max(c.largest_overlap, overlap);
    sim.advance(nullptr);
    c.duration = sim.state().time - step;
  }
  c.restitution = (body(sim, 1).velocity - body(sim, 0).velocity)[2] / speed;
  return c;
}

double reduced_mass() {
  return 0.5 * 8920 * 4.0 / 3 * M_PI * std::pow(radius, 3);
}

// Linear Kelvin-Voigt: half a damped period.  Only the spring is kept from pulling (4.26); the damper pulls at the end,
// so that the contact ends where the overlap does: e = exp(-pi xi/sqrt(1-xi^2)), t_c = pi/(omega sqrt(1-xi^2)).  The
// lag of the damper by half a step of t_c/20000 costs about 1e-4.
TEST(Collision, LinearKelvinVoigt) {
  const double k = 1e5, omega = std::sqrt(k / reduced_mass());
  for (double xi : {0.0, 0.1, 0.4}) {
    auto m = elastic_model(dem::Elasticity::linear, k);
    m.damping_ratio = xi;
    const double root = std::sqrt(1 - xi * xi), duration = M_PI / (omega * root);
    const Collision c = collide(m, duration / 20000);
    EXPECT_NEAR(c.restitution / std::exp(-M_PI * xi / root), 1, 5e-4) << xi;
    EXPECT_NEAR(c.duration / duration, 1, 5e-4) << xi;
    const double phase = std::atan2(root, xi);  // of the largest overlap
    EXPECT_NEAR(c.largest_overlap / (speed / omega * std::exp(-xi / root * phase)), 1, 5e-4);
  }
}

// Hertz without damping, F = k u^1.5 with k = (4/3) E* sqrt(R): energy gives u_max = (5 m v^2/(4 k))^(2/5), and t_c =
// 2 u_max/v times the integral of dx/sqrt(1 - x^2.5) over 0..1, sqrt(pi) Gamma(2/5)/(2.5 Gamma(9/10)) = 1.4716,
// together 3.2180 (m^2/(k^2 v))^(1/5).  R = r/2, or r as (4.21) prints it.
TEST(Collision, HertzUndampedWithBothRadii) {
  for (auto [kind, effective] :
       {std::pair{dem::HertzRadius::reduced, 0.5 * radius}, std::pair{dem::HertzRadius::equivalent, radius}}) {
    auto m = elastic_model(dem::Elasticity::hertz, dem::unset);
    m.hertz_radius = kind;
    const double k = 4.0 / 3 * 1e11 / (2 * (1 - 0.09)) * std::sqrt(effective), mass = reduced_mass();
    const double integral = std::sqrt(M_PI) * std::tgamma(0.4) / (2.5 * std::tgamma(0.9));
    const double u_max = std::pow(1.25 * mass * speed * speed / k, 0.4), duration = 2 * integral * u_max / speed;
    EXPECT_NEAR(duration / (3.2180 * std::pow(mass * mass / (k * k * speed), 0.2)), 1, 1e-4);
    const Collision c = collide(m, duration / 20000);
    EXPECT_NEAR(c.restitution, 1, 1e-6);
    EXPECT_NEAR(c.duration / duration, 1, 3e-4);
    EXPECT_NEAR(c.largest_overlap / u_max, 1, 1e-6);
  }
}

// Hertz with c = 2 xi sqrt(m k_t), k_t = 1.5 k sqrt(u): the exact map of Antypov and Elliott (2011) to the linear
// contact gives e = exp(-pi b/sqrt(1-b^2)) with b = xi sqrt(6/5), at every speed.
TEST(Collision, HertzDamped) {
  for (double xi : {0.1, 0.4}) {
    auto m = elastic_model(dem::Elasticity::hertz, dem::unset);
    m.damping_ratio = xi;
    const double b = xi * std::sqrt(1.2);
    EXPECT_NEAR(collide(m, 1e-13).restitution / std::exp(-M_PI * b / std::sqrt(1 - b * b)), 1, 1e-3) << xi;
  }
}

// At the program's own step a damped collision never gains: the limit knows the damper of a contact about to form.
TEST(Collision, DampedContactAtTheDefaultStep) {
  for (double xi : {0.3, 0.7, 1.0})
    for (double gap : {0.5e-6, 1.3e-6, 2.7e-6}) {
      auto m = elastic_model(dem::Elasticity::linear, 1e5);
      m.damping_ratio = xi;
      auto s = empty_setup(copper(), m, hold(1, 300, 0));
      add_sphere(s.particles, Vec3::Zero(), radius, Vec3::Zero());
      add_sphere(s.particles, Vec3(0, 0, 2 * radius + gap), radius, Vec3(0, 0, -speed));
      Simulation sim(s);
      for (int n = 0; n < 20000; ++n) sim.advance(nullptr);
      const double out = (body(sim, 1).velocity - body(sim, 0).velocity)[2] / speed;
      EXPECT_TRUE(out > -0.1 && out < 1) << xi << " " << gap << " " << out;
    }
}

}  // namespace
}  // namespace densify::test
