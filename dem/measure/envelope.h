#pragma once
// How much room the powder takes: envelope, relative density, shrinkage (5.4-5.6).

#include "dem/simulation.h"

namespace densify::dem {

/// The bounding body of the powder.
struct Envelope {
  Vec3 size = Vec3::Zero();  ///< extent along x, y, z [m]
  double volume = 0;         ///< [m^3]
};

/// Envelope now.  Periodic: the cell.  Cylinder and box: the walls where the powder touches them (lateral walls as one,
/// bottom and punch each on its own), its outermost sphere surfaces elsewhere.  Free: the box of the sphere surfaces.
/// Reads the wall forces of the last evaluation.
Envelope measure_envelope(const Simulation&);

/// Solid volume at the present temperature, mass / theoretical density (5.6) [m^3].
double solid_volume_now(const Simulation&);

/// Relative density by envelope, mass / (envelope x theoretical density at T) (5.5, 5.6).
double relative_density(const Simulation&, const Envelope&);

/// Relative density of the region at least `distance` [m] from every wall; spheres that cross its boundary count by
/// the part of 256 interior points that lies inside (about 0.1 % for a thousand spheres).  Overlaps count twice, as in
/// the envelope density.  NaN when walls leave no such region or there are no walls and no periodic cell.
double inner_relative_density(const Simulation&, double distance);

/// Mean particle diameter at the reference temperature [m].
double mean_diameter(const Simulation&);

}  // namespace densify::dem
