#include "dem/boundary/walls.h"

#include <gtest/gtest.h>

#include "base/check.h"
#include "tests/support/setups.h"

namespace densify::dem {
namespace {

constexpr double r = 5e-6, youngs = 183e9, poisson = 0.34, u = 1e-7;

struct World {
  ContactModel model;
  PairTable table;
  Particles particles;
  explicit World(const ContactModel& m) : model(m), table({test::nickel_aluminide()}, {}, m) {
    table.update(293.15, 0);
    test::add_sphere(particles, Vec3(0, 0, r - u), r, Vec3::Zero());
    particles.body[0].inverse_mass = 1e9;
    particles.force = {Vec3::Zero()};
    if (m.friction) {
      particles.angular_velocity = {Vec3::Zero()};
      particles.torque = {Vec3::Zero()};
    }
  }
  void compute(Walls& walls, std::vector<WallRecord>* record) {
    particles.force[0].setZero();
    walls.rebuild(particles, 0.1 * r);
    walls.compute(particles, table, model, {0.0}, {0, 0}, record, nullptr);
  }
};

Wall floor_plane() {
  return {"bottom", WallShape::plane, Vec3::Zero(), Vec3::UnitZ(), 0, Vec3::Zero(), 0};
}
Wall die(double radius) {
  return {"die", WallShape::cylinder, Vec3::Zero(), Vec3::UnitZ(), radius, Vec3::Zero(), 0};
}

ContactModel hertz() {
  return test::elastic_model(Elasticity::hertz, unset);
}

// Hertz on a rigid plane: F = (4/3) E/(1 - nu^2) sqrt(r) u^1.5 upward, and the plane gets the opposite.
TEST(Walls, RigidPlane) {
  World w(hertz());
  Walls walls({floor_plane()}, {});
  w.compute(walls, nullptr);
  const double f = 4.0 / 3 * youngs / (1 - poisson * poisson) * std::sqrt(r) * std::pow(u, 1.5);
  EXPECT_NEAR(w.particles.force[0][2] / f, 1, 1e-12);
  EXPECT_NEAR(walls.normal_force()[0] / f, 1, 1e-12);
  EXPECT_NEAR(walls.force()[0][2] / -f, 1, 1e-12);
}

// A wall of 400 GPa and nu = 0.2 adds its compliance: 1/E* = (1 - nu_p^2)/E_p + (1 - nu_w^2)/E_w (4.20); a stiffness
// factor multiplies the force.
TEST(Walls, ElasticPlaneAndStiffnessFactor) {
  ContactModel m = hertz();
  m.stiffness_factor = 0.1;
  World w(m);
  Walls walls({floor_plane()}, {400e9, 0.2});
  w.compute(walls, nullptr);
  const double modulus = 1 / ((1 - poisson * poisson) / youngs + (1 - 0.04) / 400e9);
  EXPECT_NEAR(w.particles.force[0][2] / (0.1 * 4.0 / 3 * modulus * std::sqrt(r) * std::pow(u, 1.5)), 1, 1e-12);
}

// The die pushes toward its axis along the radius: sphere at 30 degrees, overlap u.
TEST(Walls, CylinderPushesToTheAxis) {
  World w(test::elastic_model(Elasticity::linear, 1e5));
  const Vec3 out(std::cos(M_PI / 6), 0.5, 0);
  w.particles.body[0].position = (20e-6 - r + u) * out + Vec3(0, 0, 3e-5);
  Walls walls({die(20e-6)}, {});
  std::vector<WallRecord> record;
  w.compute(walls, &record);
  EXPECT_LT((w.particles.force[0] + 1e5 * u * out).norm(), 1e-12 * 1e5 * u);
  EXPECT_NEAR(walls.normal_force()[0], 1e5 * u, 1e-12 * 1e5 * u);
  ASSERT_EQ(record.size(), 1u);
  EXPECT_EQ(record[0].force, w.particles.force[0]);
  EXPECT_LT((record[0].branch - (r - u) * out).norm(), 1e-12 * r);
  EXPECT_NEAR(record[0].elastic_energy, 0.5 * 1e5 * u * u, 1e-12 * 1e5 * u * u);
}

// A sphere that touches through its surface only in the skin feels nothing.
TEST(Walls, NoForceAcrossAGap) {
  World w(hertz());
  w.particles.body[0].position[2] = r + 0.05 * r;
  Walls walls({floor_plane()}, {});
  w.compute(walls, nullptr);
  EXPECT_EQ(walls.contacts().size(), 1u);
  EXPECT_EQ(w.particles.force[0].norm(), 0);
}

// A plane that rises at 1 mm/s damps like an approaching sphere: F = k u + 2 xi sqrt(m k) v.
TEST(Walls, MovingPlaneDamps) {
  ContactModel m = test::elastic_model(Elasticity::linear, 1e5);
  m.damping_ratio = 0.5;
  World w(m);
  Wall plane = floor_plane();
  plane.velocity = Vec3(0, 0, 1e-3);
  Walls walls({plane}, {});
  w.compute(walls, nullptr);
  EXPECT_NEAR(w.particles.force[0][2], 1e5 * u + std::sqrt(1e-9 * 1e5) * 1e-3, 1e-15);
}

// A spinning sphere rubs: surface speed omega r over one step of friction; the force on the sphere has the torque
// arm (centre to wall) and opposes the spin.
TEST(Walls, FrictionOfASpinningSphere) {
  ContactModel m = test::elastic_model(Elasticity::linear, 1e5);
  m.friction = FrictionModel{0.3, 0.2, 2.0 / 7, 0};
  World w(m);
  w.particles.angular_velocity[0] = Vec3(0, 1e3, 0);  // contact point moves to -x
  Walls walls({floor_plane()}, {});
  walls.rebuild(w.particles, 0.1 * r);
  walls.compute(w.particles, w.table, m, {0.0}, {0, 1e-3}, nullptr, nullptr);
  const double f = 0.2 * 1e5 * u;  // slides: 2/7 k x 5 um is far above
  EXPECT_NEAR(w.particles.force[0][0], f, 1e-12 * f);
  EXPECT_NEAR(w.particles.torque[0][1], -f * (r - u), 1e-12 * f * r);
}

// The list's friction springs survive a rebuild, those of other walls apart.
TEST(Walls, RebuildKeepsFrictionSprings) {
  World w(hertz());
  w.particles.body[0].position = Vec3(20e-6 - r, 0, r);
  Walls walls({die(20e-6), floor_plane()}, {});
  walls.rebuild(w.particles, 0.1 * r);
  ASSERT_EQ(walls.contacts().size(), 2u);
  walls.contacts()[1].tangential = Vec3(1e-9, 0, 0);
  walls.rebuild(w.particles, 0.2 * r);
  EXPECT_EQ(walls.contacts()[0].tangential.norm(), 0);
  EXPECT_EQ(walls.contacts()[1].tangential, Vec3(1e-9, 0, 0));
}

TEST(Walls, CentreBeyondAWallStopsTheRun) {
  World w(hertz());
  w.particles.body[0].position[2] = -1e-9;
  Walls walls({floor_plane()}, {});
  EXPECT_THROW(walls.rebuild(w.particles, 0.1 * r), RunError);
}

// Wall motion uses up the skin: a tenth of it moved is a fifth of the age, as particles may move against it.
TEST(Walls, AgeCountsMotionAndRadius) {
  World w(hertz());
  Walls walls({floor_plane(), die(20e-6)}, {});
  walls.rebuild(w.particles, 1e-6);
  EXPECT_EQ(walls.age(1e-6), 0);
  walls.wall[0].point[2] += 1e-7;
  EXPECT_NEAR(walls.age(1e-6), 0.2, 1e-12);
  walls.wall[1].radius -= 2e-7;
  EXPECT_NEAR(walls.age(1e-6), 0.4, 1e-9);
}

}  // namespace
}  // namespace densify::dem
