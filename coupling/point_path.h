#pragma once
// One point of a material along the path that a volume element was led.

#include "coupling/element_path.h"
#include "fem/press/point_material.h"

namespace densify::coupling {

/// Relative densities (without elastic strain) at the given times [s], growing, of a point of this density at first
/// that goes along the schedule: under its pressure along z with its sides at rest, or from all sides.  Steps of a
/// 400th of a stage.  Throws RunError when a step is not found.
std::vector<double> drive_point(const fem::PointMaterial&, const Schedule&, PathKind, double density,
                                const std::vector<double>& times);

}  // namespace densify::coupling
