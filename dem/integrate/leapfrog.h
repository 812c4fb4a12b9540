#pragma once
// Leap-frog (4.8-4.13): velocities half a step behind, positions at the step.

#include "dem/state/cell.h"

namespace densify::dem {

/// Steps of one move: `kick` between the middles of the last step and this one, `drift` this one [s].
struct LeapfrogSteps {
  double kick, drift;
};

/// v^{n+1/2} = v^{n-1/2} + F/m dt (4.8, 4.9) and the same for spin (4.11, 4.12), with J = 2/5 m r^2; then x^{n+1} = x^n
/// + v dt (4.10), where a deforming cell carries its particles with it.  `drag` is a mass-proportional damping rate
/// [1/s] used by packing only.  Returns the largest speed of a particle, relative to the flow of a deforming cell; NaN
/// or infinity when any velocity is not finite. [m/s]
double leapfrog(Particles&, Cell&, LeapfrogSteps, double drag, int threads);

}  // namespace densify::dem
