#pragma once
// Leap-frog (4.8-4.13): velocities half a step behind, positions at the step.

#include "dem/state/cell.h"

namespace densify::dem {

/// v^{n+1/2} = v^{n-1/2} + F/m dt (4.8, 4.9) and the same for spin (4.11, 4.12), with J = 2/5 m r^2; `drag` is a
/// mass-proportional rate [1/s] used by packing only.
void kick(Particles&, double step, double drag, int threads);

/// x^{n+1} = x^n + v dt (4.10); a deforming cell carries its particles with it.
void drift(Particles&, Cell&, double step, int threads);

}  // namespace densify::dem
