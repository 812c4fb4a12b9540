// What a closed system keeps: momentum, angular momentum, energy.

#include <gtest/gtest.h>

#include "tests/support/setups.h"

namespace densify::test {
namespace {

constexpr double radius = 5e-6;

/// 108 equal spheres in a periodic cube, not touching at first, shaken.
Setup gas(const dem::ContactModel& contact) {
  Setup s = empty_setup(copper(), contact, hold(1, 300, 0));
  fill_periodic(s, Lattice::face_centred, 3, 2.2 * radius, radius);
  shake(s.particles, 20, 11);
  s.integration.step_safety = 0.015;  // the kink of a linear contact costs (omega dt)^2 a collision
  return s;
}

// Undamped elastic gas over 1e5 steps, dozens of collisions for each sphere: total momentum stays at 1e-12 of the sum
// of its parts; kinetic (mean of the half-steps around) plus elastic energy at the same moment stays within 1e-3.
void check_gas(const dem::ContactModel& contact) {
  Simulation sim(gas(contact));
  dem::Recording record;
  auto energy = [&] {
    const double before = kinetic_energy(sim.state().particles);
    sim.advance(&record);
    return 0.5 * (before + kinetic_energy(sim.state().particles)) + elastic_energy(record);
  };
  const double first = energy();
  double worst = 0;
  bool touched = false;
  for (int n = 1; n < 100000; ++n) {
    if (n % 100 != 0) {
      sim.advance(nullptr);
      continue;
    }
    worst = std::max(worst, std::abs(energy() / first - 1));
    touched = touched || elastic_energy(record) > 0.1 * first;
  }
  double sum = 0;
  for (const auto& b : sim.state().particles.body) sum += b.velocity.norm() / b.inverse_mass;
  EXPECT_LT(momentum(sim.state().particles).norm(), 1e-12 * sum);
  EXPECT_LT(worst, 1e-3);
  EXPECT_TRUE(touched);
}

TEST(Conservation, LinearGas) {
  check_gas(elastic_model(dem::Elasticity::linear, 1e5));
}

TEST(Conservation, HertzGas) {
  check_gas(elastic_model(dem::Elasticity::hertz, dem::unset));
}

// Damping takes energy away and never gives any: the total of a damped gas falls from record to record.
TEST(Conservation, DampedGasLosesEnergy) {
  auto contact = elastic_model(dem::Elasticity::hertz, dem::unset);
  contact.damping_ratio = 0.2;
  Simulation sim(gas(contact));
  double before = kinetic_energy(sim.state().particles);
  const double first = before;
  dem::Recording record;
  for (int n = 0; n < 100; ++n) {
    for (int k = 0; k < 200; ++k) sim.advance(k == 199 ? &record : nullptr);
    const double now = kinetic_energy(sim.state().particles) + elastic_energy(record);
    EXPECT_LT(now, before * (1 + 1e-3));
    before = now;
  }
  EXPECT_LT(before, 0.5 * first);
}

// A free compressed cluster of unequal spinning spheres with friction and damping flies apart: linear and angular
// momentum (orbital and spin) stay.  Force and motion are at the same moment in leap-frog only up to the drift, during
// which x changes along v: the sum x^n x m v^(n-1/2) is kept exactly.
TEST(Conservation, AngularMomentumWithFriction) {
  auto contact = elastic_model(dem::Elasticity::hertz, dem::unset);
  contact.damping_ratio = 0.2;
  contact.friction = dem::FrictionModel{0.4, 0.4, 2.0 / 7, 0.1};
  auto s = empty_setup(copper(), contact, hold(1, 300, 0));
  fill_cluster(s, 2, 1.9 * radius, radius, 3);
  shake(s.particles, 5.0, 17);
  std::mt19937 random(23);
  std::uniform_real_distribution<double> u(-1e6, 1e6);
  for (std::size_t p = 0; p < s.particles.size(); ++p)
    s.particles.angular_velocity.push_back(Vec3(u(random), u(random), u(random)));
  Simulation sim(s);
  const Vec3 l0 = angular_momentum(sim.state().particles), p0 = momentum(sim.state().particles);
  const double e0 = kinetic_energy(sim.state().particles);
  for (int n = 0; n < 20000; ++n) sim.advance(nullptr);
  double parts_l = 0, parts_p = 0;
  for (const auto& b : sim.state().particles.body) {
    parts_l += (b.position.cross(b.velocity) / b.inverse_mass).norm();
    parts_p += b.velocity.norm() / b.inverse_mass;
  }
  // A free flight rounds each position the same way at each step: up to steps x 1e-16 / 2.
  EXPECT_LT((angular_momentum(sim.state().particles) - l0).norm(), 1e-10 * parts_l);
  EXPECT_LT((momentum(sim.state().particles) - p0).norm(), 1e-12 * parts_p);
  EXPECT_GT(std::abs(kinetic_energy(sim.state().particles) / e0 - 1), 0.01);  // something happened
}

// Bonds of a free sintering cluster pull along the line of centres: momenta stay through activation and growth.
TEST(Conservation, MomentaWhileSintering) {
  auto contact = elastic_model(dem::Elasticity::hertz, dem::unset);
  contact.sintering = dem::SinteringSettings{};
  auto s = empty_setup(copper(), contact, hold(1e5, 1300, 0));
  fill_cluster(s, 2, 1.98 * radius, radius, 3);
  s.integration.mass_scaling = 1e14;
  shake(s.particles, 1e-11, 17);
  Simulation sim(s);
  bond_all(sim, dem::NeckPhase::activating, 0.1);
  const Vec3 l0 = angular_momentum(sim.state().particles);
  const double before = gyration(sim.state().particles);
  for (int n = 0; n < 5000; ++n) sim.advance(nullptr);
  double parts = 0;
  for (const auto& b : sim.state().particles.body) parts += b.position.norm() * b.velocity.norm() / b.inverse_mass;
  EXPECT_LT((angular_momentum(sim.state().particles) - l0).norm(), 1e-9 * parts);
  EXPECT_LT(gyration(sim.state().particles), 0.985 * before);  // it did sinter
}

}  // namespace
}  // namespace densify::test
