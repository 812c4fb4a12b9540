#include "dem/contact/force_pass.h"

#include <gtest/gtest.h>

#include "tests/support/setups.h"

namespace densify::dem {
namespace {

/// Two materials that differ in thermal expansion only, and what a pass needs around two spheres.
struct World {
  ContactModel model;
  Particles particles;
  ContactList list;
  Cell cell;
  PairTable table;

  World(const ContactModel& m, double ri, double rj, const Vec3& branch) : model(m), table(materials(), {}, m) {
    table.update(293.15, 0);
    test::add_sphere(particles, Vec3(1, 2, 3) * 1e-5, ri, Vec3::Zero());
    test::add_sphere(particles, Vec3(1, 2, 3) * 1e-5 + branch, rj, Vec3::Zero());
    for (auto& b : particles.body) b.inverse_mass = 1e9;
    particles.force.assign(2, Vec3::Zero());
    list.skin = 1e-6;
  }
  static std::vector<Material> materials() { return {test::nickel_aluminide(), test::nickel_aluminide()}; }
  std::vector<ContactRecord> compute(const std::vector<double>& growth, double step) {
    rebuild(list, particles, cell, {1.0, 1.0}, {model.friction.has_value(), false}, 1);
    ForcePass pass(model, 1);
    pass.list_changed();
    std::vector<ContactRecord> record;
    pass.compute(particles, list, cell, table, growth, {0, step}, &record, nullptr);
    return record;
  }
};

// Hertz between 3 and 6 um, reduced radius 2 um, overlap 0.1 um along a slanted branch: each particle is pushed away
// from the other with (4/3) E* sqrt(R u) u, E* = E/(2 (1 - nu^2)).
TEST(ForcePass, HertzPair) {
  const Vec3 n = Vec3(1, -2, 2) / 3;
  World w(test::elastic_model(Elasticity::hertz, unset), 3e-6, 6e-6, 8.9e-6 * n);
  const auto record = w.compute({0, 0}, 0);
  const double f = 4.0 / 3 * 183e9 / (2 * (1 - 0.34 * 0.34)) * std::sqrt(2e-6 * 1e-7) * 1e-7;
  EXPECT_LT((w.particles.force[0] + f * n).norm(), 1e-9 * f);
  EXPECT_EQ(w.particles.force[1], Vec3(-w.particles.force[0]));
  ASSERT_EQ(record.size(), 1u);
  EXPECT_NEAR(record[0].normal / -f, 1, 1e-9);
  EXPECT_NEAR(record[0].elastic_energy / (0.4 * f * 1e-7), 1, 1e-9);
  EXPECT_TRUE(record[0].touching);
}

TEST(ForcePass, ListedPairWithAGapHasNoForce) {
  World w(test::elastic_model(Elasticity::linear, 1e5), 3e-6, 6e-6, Vec3(9.5e-6, 0, 0));
  const auto record = w.compute({0, 0}, 0);
  ASSERT_EQ(record.size(), 1u);
  EXPECT_FALSE(record[0].touching);
  EXPECT_EQ(w.particles.force[0].norm(), 0);
}

// A pair across a periodic face in a sheared cell: the image's place counts.
TEST(ForcePass, PairAcrossAPeriodicFace) {
  World w(test::elastic_model(Elasticity::linear, 1e5), 5e-6, 5e-6, Vec3::Zero());
  w.cell.periodic = true;
  w.cell.h << 40e-6, 8e-6, 0, 0, 40e-6, 0, 0, 0, 40e-6;
  w.particles.body[0].position = Vec3(20e-6, 1e-6, 20e-6);
  w.particles.body[1].position = Vec3(20e-6, 1e-6, 20e-6) + Vec3(8e-6, 40e-6 - 9.9e-6, 0);  // its lower image is below
  w.compute({0, 0}, 0);
  EXPECT_NEAR(w.particles.force[0][1], 1e5 * 1e-7, 1e-12);
  EXPECT_NEAR(w.particles.force[1][1], -1e5 * 1e-7, 1e-12);
  EXPECT_NEAR(w.particles.force[0][0], 0, 1e-12);
}

// The rate is du/dt: what the radii have grown since the last pass is taken out, each material with its own share,
// whichever of the two particles comes first.  Damper c = 2 xi sqrt(m k); growth 1e-4 of 3 um and 3e-4 of 6 um in 1 us.
TEST(ForcePass, GrowthOfUnlikeMaterials) {
  ContactModel m = test::elastic_model(Elasticity::linear, 1e5);
  m.damping_ratio = 0.5;
  for (bool swapped : {false, true}) {
    World w(m, swapped ? 6e-6 : 3e-6, swapped ? 3e-6 : 6e-6, Vec3(8.9e-6, 0, 0));
    w.particles.material = swapped ? std::vector<std::uint8_t>{1, 0} : std::vector<std::uint8_t>{0, 1};
    w.compute({1e-4, 3e-4}, 1e-6);
    const double rate = -(1e-4 * 3e-6 + 3e-4 * 6e-6) / 1e-6;
    const double c = std::sqrt(0.5e-9 * 1e5);
    EXPECT_NEAR(w.particles.force[1][0], 1e5 * 1e-7 - c * rate, 1e-12) << swapped;
  }
}

// In a deforming cell the affine flow is part of the relative velocity.
TEST(ForcePass, AffineFlowCounts) {
  ContactModel m = test::elastic_model(Elasticity::linear, 1e5);
  m.damping_ratio = 0.5;
  World w(m, 5e-6, 5e-6, Vec3(9.9e-6, 0, 0));
  w.cell.periodic = true;
  w.cell.h = 40e-6 * Mat3::Identity();
  w.cell.velocity_gradient(0, 0) = -100;
  w.compute({0, 0}, 1e-6);
  EXPECT_NEAR(w.particles.force[1][0], 1e5 * 1e-7 + std::sqrt(0.5e-9 * 1e5) * 100 * 9.9e-6, 1e-12);
}

// Friction: forces opposite, torques with each particle's own lever, so that angular momentum is kept:
// branch x F_t balances the two torques.
TEST(ForcePass, FrictionBalancesAngularMomentum) {
  ContactModel m = test::elastic_model(Elasticity::hertz, unset);
  m.friction = FrictionModel{0.3, 0.3, 2.0 / 7, 0};
  const Vec3 branch = 8.9e-6 * Vec3(1, -2, 2) / 3;
  World w(m, 3e-6, 6e-6, branch);
  w.particles.body[1].velocity = Vec3(0.1, 0.3, -0.2);
  w.particles.angular_velocity = {Vec3(1e3, 2e3, -3e3), Vec3(-2e3, 1e3, 4e3)};
  w.particles.torque.assign(2, Vec3::Zero());
  const auto record = w.compute({0, 0}, 1e-9);
  const Vec3 f = w.particles.force[1], total = w.particles.torque[0] + w.particles.torque[1] + branch.cross(f);
  EXPECT_GT(record[0].couple.norm(), 0);
  EXPECT_LT(total.norm(), 1e-12 * branch.norm() * f.norm());
  EXPECT_NEAR(w.particles.torque[0].norm() / w.particles.torque[1].norm(), (3e-6 - 5e-8) / (6e-6 - 5e-8), 1e-9);
}

}  // namespace
}  // namespace densify::dem
