#pragma once
// The material of a pressing, by the scene's choice of coupling.

#include <memory>

#include "coupling/live_material.h"
#include "coupling/press_scene.h"
#include "fem/press/point_material.h"

namespace densify::coupling {

struct PressMaterial {
  std::shared_ptr<fem::PointMaterial> point;
  double dense_youngs_modulus;              ///< [Pa]
  double density;                           ///< relative, of the body at the start
  std::shared_ptr<LiveMaterial> live = {};  ///< the same as `point`, where volume elements live
};

/// Throws InputError at what the scene lacks for its choice.  Collective: volume elements are packed here.
PressMaterial press_material(const PressScene&, MPI_Comm);

}  // namespace densify::coupling
