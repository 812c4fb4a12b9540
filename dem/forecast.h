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
/// their stiffness is the tangent of Hertz's spring under that force, the neck of a viscous contact is that of two such
/// spheres without inertia (4.31, 4.36, 4.40).  `at_start`: critical step of the specimen [s], infinite when there is
/// none yet.  Within a factor of two for hot pressing; force chains are not in it.
Forecast forecast(const Scene&, const PowderSample&, double at_start);

}  // namespace densify::dem
