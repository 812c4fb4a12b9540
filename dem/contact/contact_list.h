#pragma once
// The neighbour list with the history of its contacts, in buckets of equal pairs of materials.

#include <span>

#include "dem/law/sintering.h"
#include "dem/state/cell.h"

namespace densify::dem {

/// Neighbour pairs i < j (or i == j across a periodic face), sorted by bucket, then by groups of `group` particles i,
/// and within a group in rounds: the first pair of each i, the second of each, and so on.  Neighbours in the list then
/// add to different particles, and a pass does not wait for its own last sum.
struct ContactList {
  /// All pairs of one pair of materials.
  struct Bucket {
    std::size_t begin, end;
    std::uint8_t material_a, material_b;  ///< a <= b
  };
  static constexpr std::uint32_t index_bits = 27, index_mask = (1u << index_bits) - 1;

  static constexpr std::uint32_t group = 16;

  std::vector<std::uint32_t> first;   ///< i
  std::vector<std::uint32_t> second;  ///< j | image code << 27
  std::vector<Bucket> buckets;
  std::vector<Vec3> tangential;   ///< spring displacement of friction [m]; empty without friction
  std::vector<NeckHistory> neck;  ///< empty without sintering

  // When the list was built:
  std::vector<Vec3> reference_position;     ///< [m]
  Mat3 reference_h = Mat3::Zero();          ///< cell [m]
  std::vector<double> reference_expansion;  ///< thermal stretch of each material
  double skin = 0;                          ///< extra reach [m]
  double largest_radius = 0;                ///< [m]
  std::size_t builds = 0;

  std::size_t size() const { return first.size(); }
  std::uint32_t i(std::size_t k) const { return first[k]; }
  std::uint32_t j(std::size_t k) const { return second[k] & index_mask; }
  std::uint8_t image(std::size_t k) const { return std::uint8_t(second[k] >> index_bits); }
};

/// Which histories a scene pays for.
struct HistoryNeeds {
  bool friction;
  bool necks;
};

/// Builds the list anew: wraps the particles into the cell, finds all pairs within reach and carries over histories; a
/// pair that has a neck stays in the list at any distance.  `change` is that of Cell::reduce where the cell has got
/// other edges since the last build.
void rebuild(ContactList&, Particles&, const Cell&, const std::vector<double>& expansion, HistoryNeeds, int threads,
             const Eigen::Matrix3i& change = Eigen::Matrix3i::Identity());

/// Positions, cell and thermal stretches of an earlier moment, and the largest radius and skin of a list made then.
struct ListMoment {
  const std::vector<Vec3>& position;     ///< [m]
  const Mat3& h;                         ///< cell [m]
  const std::vector<double>& expansion;  ///< thermal stretch of each material
  double largest_radius, skin;           ///< [m]
};

/// How far the surfaces of two particles can have approached since then; NaN when a position is not finite. [m]
double approach(const ListMoment&, const Particles&, const Cell&, const std::vector<double>& expansion, int threads);

/// Largest approach since the list was built, as a share of what its skin allows: rebuild at 1 or above.
/// NaN when any position is not finite.
double list_age(const ContactList&, const Particles&, const Cell&, const std::vector<double>& expansion, int threads);

}  // namespace densify::dem
