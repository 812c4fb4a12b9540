#pragma once
// A packing of spheres with necks as a body in voxels.

#include "dem/network/specimen_network.h"
#include "fem/voxel_stiffness.h"

namespace densify::coupling {

/// Spheres and, where contacts have necks, rods of the necks' radii from the centres to the neck's plane; n voxels
/// along the cell's longest edge and as many along the others as make them nearly cubes.  Needs a periodic cell.
fem::LevelSet packing_level_set(const dem::SpecimenNetwork&, int n);

/// Elasticity of every material at a temperature [K].
std::vector<fem::ElasticSolid> elastic_solids(const std::vector<dem::Material>&, double temperature);

/// Mean diameter of the necks over the width of a voxel; NaN without necks.
double voxels_across_neck(const dem::SpecimenNetwork&, int n);

}  // namespace densify::coupling
