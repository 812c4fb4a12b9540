#pragma once
// How many steps a run will take, said before any packing exists.

#include "dem/io/scene.h"
#include "dem/powder/powder.h"

namespace densify::dem {

struct Forecast {
  double steps = 0;           ///< of the whole schedule
  double smallest_limit = 0;  ///< smallest critical step on the way [s]
};

/// Integrates 1/step over the schedule in a mean field: the smallest grain of each material lies between grains of the
/// volume-weighted mean diameter D, each of which carries p D^2 (or the largest load on a particle), on three contacts;
/// their stiffness is the tangent of the spring under that force, the neck of a viscous contact is that of two such
/// spheres without inertia (4.31, 4.36, 4.40).  `at_start`: critical step of a specimen that is there [s], infinite
/// otherwise; where it is below that of the mean field, so are all later ones.  Force chains are not in it: within a
/// factor of two for the shipped scenes (tests/run/forecast.sh).
Forecast forecast(const Scene&, const PowderSample&, double at_start);

}  // namespace densify::dem
