#pragma once
// A point of the body's side against a rigid round die: unilateral pressure and Coulomb friction.

#include "base/tensor.h"

namespace densify::fem {

/// The die during a step.
struct DieWall {
  double radius;        ///< of the bore, at the end of the step [m]
  double stiffness;     ///< pressure over the depth by which a point is inside the wall [Pa/m]
  double shear;         ///< shear over the slip of a step, as long as friction holds [Pa/m]
  double friction = 0;  ///< Coulomb's coefficient
  double rise = 0;      ///< how far the die moves up its axis during the step [m]
};

/// Traction on the body by its unloaded area [Pa].
struct WallTraction {
  Vec3 value;       ///< pressure and friction
  Mat3 derivative;  ///< by the position at the end of the step [Pa/m]
  Vec3 friction;    ///< the part along the wall, which the next step begins with
  double slip;      ///< along the wall in the step [m]
  double depth;     ///< how far the point is inside the wall; negative: the gap [m]
};

/// A closed point is held by the wall whatever the sign of its depth; whoever calls opens it where the wall would pull.
/// Coulomb friction, regularised by an elastic slip as in thesis Fig. 4.6: shear stress = friction before - shear x
/// slip of the step, at most `friction` times the pressure.  Positions in axes of which the third is the die's [m].
WallTraction wall_traction(const DieWall&, bool closed, const Vec3& before, const Vec3& after,
                           const Vec3& friction_before);

}  // namespace densify::fem
