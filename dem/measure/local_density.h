#pragma once
// How dense the powder is around each particle: the volume of spheres over that of their radical Voronoi cells.

#include "dem/boundary/walls.h"

namespace densify::dem {

/// Local relative densities as last measured.
struct LocalDensity {
  std::vector<double> of;    ///< of each particle; empty before the first necks and where nobody asks
  double powder = 0;         ///< relative density of the whole then
  std::uint64_t builds = 0;  ///< of the neighbour list, then
};

/// The room of a powder: its cell, or what sphere surfaces and walls leave it, whichever is nearer.
struct PowderRoom {
  Vec3 low = Vec3::Zero(), high = Vec3::Zero();  ///< not of a periodic cell [m]
  bool round = false;                            ///< a cylinder about the z axis
  double volume = 0;                             ///< [m^3]
};
PowderRoom powder_room(const Particles&, const Cell&, const Walls&);

/// Solid volume over the volume of the room; overlaps count twice.
double powder_density(const Particles&, const PowderRoom&);

/// Volume of the radical (power) Voronoi cell of each particle, cut at the faces of the room; at a cylinder by the
/// plane next to the particle.  The cells of a periodic cell or a box fill it. [m^3]
std::vector<double> voronoi_volumes(const Particles&, const Cell&, const PowderRoom&);

/// Of each particle and all it touches or has a neck with, spheres over cells.  One thread and one order of sums.
std::vector<double> local_densities(const Particles&, const Cell&, const PowderRoom&, const ContactList&);

}  // namespace densify::dem
