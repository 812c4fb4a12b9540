#pragma once
// The material of a pressing, by the scene's choice of coupling.

#include <memory>

#include "coupling/press_scene.h"
#include "fem/press/point_material.h"

namespace densify::coupling {

struct PressMaterial {
  std::shared_ptr<const fem::PointMaterial> point;
  double dense_youngs_modulus;  ///< [Pa]
};

/// Throws InputError at what the scene lacks for its choice.
PressMaterial press_material(const PressScene&);

}  // namespace densify::coupling
