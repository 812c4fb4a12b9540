#pragma once
// From loose powder to a green body by the dynamic methods of thesis App. C: gravity with moving walls, or isotropic
// compression of a periodic cell.

#include <functional>
#include <span>

#include "dem/simulation.h"

namespace densify::dem {

/// What a packing is asked for.
struct CompactionGoal {
  Container container;     ///< shape; cylinder: diameter, box: base edges; the height follows from the density
  double green_density;    ///< relative density of the finished body, at the reference temperature
  double friction;         ///< between particles and at walls while packing; 0 packs densest
  double largest_overlap;  ///< mean overlap over mean radius above which the density counts as unreachable
  std::uint64_t seed;
};

/// A finished green body.
struct GreenBody {
  Particles particles;          ///< reference_radius, material, id, body.position and velocity 0
  Container container;          ///< with its final height
  Cell cell;                    ///< periodic only
  double relative_density = 0;  ///< solid volume over container volume
  double coordination_number = 0;
  double mean_overlap = 0;  ///< over the touching contacts, over the mean radius
  std::uint64_t steps = 0;
};

/// Called now and then with the share of the work done, 0..1.
using PackingProgress = std::function<void(double)>;

/// Packs spheres of the given diameters [m] and materials.
///
/// The walls move from a loose sub-grid placement to the final container while gravity acts, then stand while gravity
/// is off and vibration dies away.  Masses go with the surface and springs are linear here: the result of a slow
/// packing does not depend on either.  Throws InputError when the green density cannot be reached without squeezing the
/// spheres.
GreenBody compact(std::span<const double> diameters, std::span<const std::uint8_t> materials, const CompactionGoal&,
                  int threads, const PackingProgress&);

}  // namespace densify::dem
