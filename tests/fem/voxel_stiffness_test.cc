// Elasticity of bodies in voxels against closed forms and bounds.

#include "fem/voxel_stiffness.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>

#include "base/bounds.h"
#include "base/elastic_tensor.h"
#include "fem/boolean_spheres.h"

namespace densify::fem {
namespace {

VoxelSettings tight() {
  VoxelSettings s;
  s.tolerance = 1e-10;
  return s;
}

Mat6 isotropic(const ElasticSolid& s) {
  const double mu = s.youngs_modulus / (2 * (1 + s.poissons_ratio));
  const double lambda = 2 * mu * s.poissons_ratio / (1 - 2 * s.poissons_ratio);
  Mat6 c = Mat6::Zero();
  c.topLeftCorner<3, 3>().setConstant(lambda);
  for (int k = 0; k < 3; ++k) c(k, k) += 2 * mu, c(k + 3, k + 3) = mu;
  return c;
}

// A homogeneous block has the stiffness of its material, in any cell: exact, to the tolerance of the solution.
TEST(VoxelStiffness, HomogeneousBlock) {
  Mat3 sheared;
  sheared << 2e-5, 4e-6, 1e-6, 0, 1e-5, 3e-6, 0, 0, 3e-5;
  Mat3 left_handed = sheared;
  left_handed.col(0).swap(left_handed.col(1));
  const ElasticSolid solid{188e9, 0.31};
  for (const Mat3& cell : {Mat3(Mat3::Identity()), sheared, left_handed}) {
    const VoxelImage image{cell, {6, 4, 5}, std::vector<std::uint8_t>(120, 1)};
    const VoxelAnswer a = voxel_stiffness(image, {solid}, tight(), MPI_COMM_WORLD);
    EXPECT_LT((a.stiffness - isotropic(solid)).norm() / isotropic(solid).norm(), 1e-9);
    EXPECT_EQ(a.elements, 120u);
    EXPECT_EQ(a.nodes, 120u);
  }
}

// Layers across z, half and half: sigma_zz, sigma_xz, eps_xx are the same in both.  With M = lambda + 2 mu and <.> the
// mean, C33 = 1/<1/M>, C13 = <lambda/M> C33, C11 = <M - lambda^2/M> + <lambda/M>^2 C33, C12 = C11 - 2 <mu>, C44 =
// 1/<1/mu>, C66 = <mu> (Backus, 1962).  Trilinear elements hold its piecewise linear displacements: exact.
TEST(VoxelStiffness, Laminate) {
  const ElasticSolid soft{1, 0.2}, stiff{5, 0.35};
  VoxelImage image{Mat3::Identity(), {4, 4, 8}, std::vector<std::uint8_t>(128, 1)};
  for (std::size_t k = 64; k < 128; ++k) image.phase[k] = 2;
  double inverse_m = 0, share = 0, plane = 0, mu_mean = 0, inverse_mu = 0;
  for (const ElasticSolid& s : {soft, stiff}) {
    const Mat6 c = isotropic(s);
    const double m = c(0, 0), lambda = c(0, 1), mu = c(3, 3);
    inverse_m += 0.5 / m, share += 0.5 * lambda / m, plane += 0.5 * (m - lambda * lambda / m);
    mu_mean += 0.5 * mu, inverse_mu += 0.5 / mu;
  }
  Mat6 due = Mat6::Zero();
  due(2, 2) = 1 / inverse_m;
  due(0, 2) = due(1, 2) = due(2, 0) = due(2, 1) = share / inverse_m;
  due(0, 0) = due(1, 1) = plane + share * share / inverse_m;
  due(0, 1) = due(1, 0) = due(0, 0) - 2 * mu_mean;
  due(3, 3) = due(4, 4) = 1 / inverse_mu;
  due(5, 5) = mu_mean;
  const VoxelAnswer a = voxel_stiffness(image, {soft, stiff}, tight(), MPI_COMM_WORLD);
  EXPECT_LT((a.stiffness - due).norm() / due.norm(), 1e-8) << a.stiffness;
}

// One spherical pore of 1 % in a cell: E falls by (1 - nu)(9 + 5 nu) 3/(2 (7 - 5 nu)) of the pores' share (Mackenzie,
// 1950), and K by 3 (1 - nu)/(2 (1 - 2 nu)).  Stairs make the pore act larger by some voxels' width, in first order:
// extrapolated from 16 and 32 voxels, to 5 % of the fall.
TEST(VoxelStiffness, DilutePore) {
  const double nu = 0.3, share = 0.01, r = std::cbrt(share / (4.0 / 3 * M_PI));
  std::array<double, 2> fall_e{}, fall_k{};
  for (const int level : {0, 1}) {
    const int n = 16 << level;
    LevelSet pore(Mat3::Identity(), {n, n, n}, 0.1);
    pore.add(Ball{Vec3(0.5, 0.5, 0.5), r, 0});
    const VoxelImage image = pore.complement(pore.shift_for(share));
    const auto p = isotropic_part(voxel_stiffness(image, {{1, nu}}, {}, MPI_COMM_WORLD).stiffness);
    const double void_share = 1 - image.solid_fraction();
    fall_e[std::size_t(level)] = (1 - p.youngs) / void_share;
    fall_k[std::size_t(level)] = (1 - p.bulk * 3 * (1 - 2 * nu)) / void_share;
  }
  const double due_e = 3 * (1 - nu) * (9 + 5 * nu) / (2 * (7 - 5 * nu)), due_k = 3 * (1 - nu) / (2 * (1 - 2 * nu));
  EXPECT_NEAR((2 * fall_e[1] - fall_e[0]) / due_e, 1, 0.05) << fall_e[0] << ' ' << fall_e[1];
  EXPECT_NEAR((2 * fall_k[1] - fall_k[0]) / due_k, 1, 0.05) << fall_k[0] << ' ' << fall_k[1];
}

// Random bodies: symmetric, positive, work is stress times strain, and below the upper bound of Hashin and Shtrikman
// (1963) of the solid with its pores.
TEST(VoxelStiffness, SymmetricDefiniteAndWithinBounds) {
  const double nu = 0.3;
  for (const auto model : {BooleanModel::solid_spheres, BooleanModel::spherical_pores})
    for (const double c : {0.6, 0.85}) {
      VoxelImage image = boolean_spheres(model, c, 7, 16, 1);
      ASSERT_TRUE(remove_loose(image).spans);
      const VoxelAnswer a = voxel_stiffness(image, {{1, nu}}, {}, MPI_COMM_WORLD);
      EXPECT_LT(a.asymmetry, 1e-5);
      EXPECT_LT(a.power_mismatch, 1e-5);
      EXPECT_GT(Eigen::SelfAdjointEigenSolver<Mat6>(a.stiffness).eigenvalues()[0], 0);
      const auto p = isotropic_part(a.stiffness);
      const auto upper = hashin_shtrikman(with_pores(std::array{Phase{1, isotropic_moduli(1, nu)}}, c)).upper;
      EXPECT_LT(p.bulk, upper.bulk);
      EXPECT_LT(p.shear, upper.shear);
    }
}

/// Every voxel as 2^3.
VoxelImage refined(const VoxelImage& coarse) {
  VoxelImage fine{coarse.cell, coarse.n, {}};
  for (int& n : fine.n) n *= 2;
  fine.phase.resize(8 * coarse.phase.size());
  for (int z = 0; z < fine.n[2]; ++z)
    for (int y = 0; y < fine.n[1]; ++y)
      for (int x = 0; x < fine.n[0]; ++x) fine.phase[fine.at(x, y, z)] = coarse.phase[coarse.at(x / 2, y / 2, z / 2)];
  return fine;
}

// Two phases of one shear modulus G: whatever their arrangement the body is isotropic with that G and 1/(K + 4 G/3) =
// sum f_i/(K_i + 4 G/3) (Hill, 1963), stairs or not.  Elements refined twice on the same stairs come to it from above,
// each time by one factor, that of the edges' singularity, so that the limit of a geometric series is the answer.
TEST(VoxelStiffness, CompositeOfOneShearModulus) {
  const double shear = 1, bulk[] = {1, 3};
  std::vector<ElasticSolid> solids;
  for (const double k : bulk)
    solids.push_back({9 * k * shear / (3 * k + shear), (3 * k - 2 * shear) / (2 * (3 * k + shear))});
  VoxelImage image = boolean_spheres(BooleanModel::solid_spheres, 0.6, 5, 6, 3);
  const double f = image.solid_fraction();
  for (auto& phase : image.phase)
    if (phase == 0) phase = 2;
  const double due = 1 / (f / (bulk[0] + 4 * shear / 3) + (1 - f) / (bulk[1] + 4 * shear / 3)) - 4 * shear / 3;
  std::array<double, 3> error{};
  for (double& e : error) {
    const auto p = isotropic_part(voxel_stiffness(image, solids, {}, MPI_COMM_WORLD).stiffness);
    EXPECT_NEAR(p.shear, shear, 1e-6);
    EXPECT_LT(p.distance, 1e-6);
    e = p.bulk / due - 1;
    image = refined(image);
  }
  const double first = error[0] - error[1], second = error[1] - error[2];
  EXPECT_GT(second, 0);
  EXPECT_GT(first / second, 2);
  EXPECT_NEAR(error[2] - second * second / (first - second), 0, 2e-3) << error[0] << ' ' << error[1] << ' ' << error[2];
}

// A cell shifted by some voxels and doubled along an edge is the same material.
TEST(VoxelStiffness, ShiftAndRepetition) {
  VoxelImage image = boolean_spheres(BooleanModel::solid_spheres, 0.7, 5, 10, 2);
  ASSERT_TRUE(remove_loose(image).spans);
  const Mat6 once = voxel_stiffness(image, {{1, 0.3}}, tight(), MPI_COMM_WORLD).stiffness;
  VoxelImage twice{image.cell, {20, 10, 10}, std::vector<std::uint8_t>(2000)};
  twice.cell.col(0) *= 2;
  for (int z = 0; z < 10; ++z)
    for (int y = 0; y < 10; ++y)
      for (int x = 0; x < 20; ++x)
        twice.phase[twice.at(x, y, z)] = image.phase[image.at((x + 3) % 10, (y + 7) % 10, (z + 1) % 10)];
  const Mat6 two = voxel_stiffness(twice, {{1, 0.3}}, tight(), MPI_COMM_WORLD).stiffness;
  EXPECT_LT((once - two).norm() / once.norm(), 1e-7);
}

}  // namespace
}  // namespace densify::fem
