#pragma once
// Loose placement of a powder in its container on nested grids (thesis, appendix C, Fig. C.3).

#include <cstdint>
#include <span>
#include <variant>
#include <vector>

#include "dem/state/particles.h"

namespace densify::dem {

/// Upright cylinder, axis x = y = 0, base z = 0; its height follows from the powder.
struct CylinderContainer {
  double diameter;  ///< [m]
};

/// Box from the origin; its height along z follows from the powder.
struct BoxContainer {
  double width_x, width_y;  ///< [m]
};

/// Periodic box from the origin; its size follows from the powder.
struct PeriodicContainer {
  Vec3 proportions;  ///< edges in any common unit [-]
};

using PlacementContainer = std::variant<CylinderContainer, BoxContainer, PeriodicContainer>;

struct Placement {
  std::vector<Vec3> position;  ///< in the order of the diameters [m]
  Vec3 extent;                 ///< edges of the container or of the box around the cylinder; z is the height [m]
  double solid_fraction;       ///< solid volume over volume of the container [-]
};

/// Places particles at random, strictly inside the container and without contact, the largest first.
///
/// Set k holds the particles that fit a cell of the grid of side about d_max / 2^k, one a cell.  Each goes to a random
/// place in a random cell where it meets no larger particle.  The container grows until all have found a place.
/// @param diameters  [m]
/// @throws InputError  when there are none, one is not positive, or the largest is wider than the container
Placement place_loosely(std::span<const double> diameters, const PlacementContainer& container, std::uint64_t seed);

}  // namespace densify::dem
