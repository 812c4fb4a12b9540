// Bodies in voxels: volumes in closed form, exact growth, what hangs together.

#include "fem/voxel_image.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/check.h"
#include "fem/boolean_spheres.h"

namespace densify::fem {
namespace {

// A ball of radius 0.3 in a unit cell: 4/3 pi 0.027 = 0.1131; at 64 voxels stairs leave some 1/n^(3/2) of it.  The same
// ball across the corner of the cell, and in a sheared cell of the same volume.
TEST(VoxelImage, VolumeOfABall) {
  const double due = 4.0 / 3 * M_PI * 0.027;
  Mat3 sheared = Mat3::Identity();
  sheared(0, 1) = 0.4;
  for (const Mat3& cell : {Mat3(Mat3::Identity()), sheared})
    for (const Vec3& centre : {Vec3(0.5, 0.5, 0.5), Vec3(0.01, 0.98, -3.03)}) {
      LevelSet level(cell, {64, 64, 64}, 0.1);
      level.add(Ball{centre, 0.3, 0});
      EXPECT_NEAR(level.body(0).solid_fraction() / due, 1, 0.01);
      EXPECT_NEAR(level.body(0.05).solid_fraction() / (due * std::pow(0.35 / 0.3, 3)), 1, 0.01);
      EXPECT_NEAR(level.complement(0).solid_fraction(), 1 - level.body(0).solid_fraction(), 1e-15);
    }
}

// A rod of radius b and length L through two balls of radius r apart by L: two balls, and the cylinder between the
// planes where it leaves them, at sqrt(r^2 - b^2), without the caps beyond these planes.
TEST(VoxelImage, VolumeOfARod) {
  const double r = 0.2, b = 0.1, length = 0.5, plane = std::sqrt(r * r - b * b);
  const double cap = M_PI * std::pow(r - plane, 2) * (3 * r - (r - plane)) / 3;
  const double due = 2 * 4.0 / 3 * M_PI * r * r * r + M_PI * b * b * (length - 2 * plane) - 2 * cap;
  LevelSet level(Mat3::Identity(), {96, 96, 96}, 0.05);
  for (const double x : {0.25, 0.75}) level.add(Ball{Vec3(x, 0.5, 0.5), r, 0});
  level.add(Rod{Vec3(0.25, 0.5, 0.5), Vec3(length, 0, 0), b, 0});
  EXPECT_NEAR(level.body(0).solid_fraction() / due, 1, 0.01);
}

// Materials by the nearer body; growth to a fraction is exact to one voxel; what is out of reach is refused.
TEST(VoxelImage, GrowthAndMaterials) {
  LevelSet level(Mat3::Identity(), {32, 32, 32}, 0.2);
  level.add(Ball{Vec3(0.2543, 0.5071, 0.5119), 0.2, 0});  // off the grid, so that no two voxels are equally far
  level.add(Ball{Vec3(0.7512, 0.5036, 0.4967), 0.2, 1});
  const VoxelImage image = level.body(level.shift_for(0.25));
  EXPECT_NEAR(image.solid_fraction(), 0.25, 1.0 / 32768);
  EXPECT_EQ(image.phase[image.at(8, 16, 16)], 1);
  EXPECT_EQ(image.phase[image.at(24, 16, 16)], 2);
  EXPECT_THROW(level.shift_for(0.99), InputError);
}

// A body from too few spheres would not be random: refused, with the box that would do.
TEST(BooleanSpheres, TooFewAreRefused) {
  try {
    boolean_spheres(BooleanModel::spherical_pores, 0.999, 12, 16, 1);
    FAIL() << "accepted";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("take a box of 34.7 or more"), std::string::npos) << error.what();
  }
}

// A plate spans two directions and resists nothing in the third: removed.  Three crossing bars span; a loose voxel and
// one that only an edge joins to a bar do not belong to them.
TEST(VoxelImage, WhatHangsTogether) {
  VoxelImage plate{Mat3::Identity(), {8, 8, 8}, std::vector<std::uint8_t>(512, 0)};
  for (int x = 0; x < 8; ++x)
    for (int y = 0; y < 8; ++y) plate.phase[plate.at(x, y, 3)] = 1;
  EXPECT_FALSE(remove_loose(plate).spans);
  EXPECT_EQ(plate.solid_fraction(), 0);

  VoxelImage bars{Mat3::Identity(), {8, 8, 8}, std::vector<std::uint8_t>(512, 0)};
  for (int k = 0; k < 8; ++k)
    bars.phase[bars.at(k, 4, 4)] = bars.phase[bars.at(4, k, 4)] = bars.phase[bars.at(4, 4, k)] = 1;
  bars.phase[bars.at(1, 5, 5)] = 1;
  bars.phase[bars.at(1, 1, 1)] = 1;
  const LooseVoxels loose = remove_loose(bars);
  EXPECT_TRUE(loose.spans);
  EXPECT_EQ(loose.removed, 2u);
  EXPECT_EQ(bars.solid_fraction(), 22.0 / 512);
}

// The models of Roberts and Garboczi have the fraction that is asked for, at every resolution the same spheres.
TEST(BooleanSpheres, FractionIsExact) {
  for (const auto model : {BooleanModel::solid_spheres, BooleanModel::spherical_pores})
    for (const double fraction : {0.5, 0.9})
      EXPECT_NEAR(boolean_spheres(model, fraction, 10, 24, 3).solid_fraction(), fraction, 2.0 / (24 * 24 * 24));
  EXPECT_EQ(boolean_spheres(BooleanModel::solid_spheres, 0.6, 10, 16, 3).phase,
            boolean_spheres(BooleanModel::solid_spheres, 0.6, 10, 16, 3).phase);
  EXPECT_NE(boolean_spheres(BooleanModel::solid_spheres, 0.6, 10, 16, 3).phase,
            boolean_spheres(BooleanModel::solid_spheres, 0.6, 10, 16, 4).phase);
}

}  // namespace
}  // namespace densify::fem
