#pragma once
// A body in voxels: which material, or none, stands at each point of a regular grid over a periodic cell; drawn from
// spheres and the necks between them, or from what spheres leave free.

#include <array>
#include <cstdint>
#include <vector>

#include "base/tensor.h"

namespace densify::fem {

struct VoxelImage {
  Mat3 cell = Mat3::Identity();     ///< columns are the edges of the periodic cell [m]
  std::array<int, 3> n{};           ///< voxels along each edge
  std::vector<std::uint8_t> phase;  ///< of each voxel, the first index fastest: 0 void, m + 1 material m

  std::size_t size() const { return phase.size(); }
  std::size_t at(int x, int y, int z) const { return (std::size_t(z) * n[1] + y) * n[0] + x; }
  double solid_fraction() const;
};

struct Ball {
  Vec3 centre;  ///< [m], anywhere: the cell repeats
  double radius;
  std::uint8_t material;
};

/// A neck as a body: all points within `radius` of the line between two centres.
struct Rod {
  Vec3 start, branch;  ///< centre, and from there to the other one [m]
  double radius;
  std::uint8_t material;
};

/// Distance of every voxel's centre to the union of balls and rods [m], negative inside, as far as `reach` outside;
/// beyond, infinite.
class LevelSet {
 public:
  LevelSet(const Mat3& cell, std::array<int, 3> n, double reach);
  void add(const Ball&);
  void add(const Rod&);

  /// Share of voxels within `shift` of the union.
  double fraction(double shift) const;
  /// The shift at which the share of voxels within it is nearest to `fraction` [m].  Throws InputError when that needs
  /// more than the reach.
  double shift_for(double fraction) const;
  /// Solid within `shift` of the union.
  VoxelImage body(double shift) const;
  /// Solid beyond `shift` of the union, of one material: what the spheres, as pores, leave.
  VoxelImage complement(double shift) const;

 private:
  /// Visits the voxels in a box around a point, given by its half width [m].
  template <class Distance>
  void draw(const Vec3& middle, double half, std::uint8_t material, Distance distance);

  VoxelImage shape_;  // phase: material of the nearest body, plus 1
  Mat3 to_fraction_;
  double reach_;
  std::vector<float> distance_;
};

/// What was taken away so that one body remains.
struct LooseVoxels {
  std::size_t removed = 0;  ///< voxels that no faces join to a body that spans the cell
  bool spans = false;       ///< whether any body is connected to its own images in three directions
};

/// Removes all voxels that faces do not join to a body that spans the cell: they carry nothing.
LooseVoxels remove_loose(VoxelImage&);

}  // namespace densify::fem
