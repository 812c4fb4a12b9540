#pragma once
// The two models of Roberts and Garboczi (J. Am. Ceram. Soc. 83, 2000, 3041): equal spheres at random places, which
// overlap as it comes; either they are the solid or they are the pores.

#include "fem/voxel_image.h"

namespace densify::fem {

enum class BooleanModel { solid_spheres, spherical_pores };

/// n^3 voxels of a cube with an edge of `box` radii and exactly the solid fraction asked for: as many spheres as give
/// it on the average, -ln(void) box^3/(4 pi/3) of them, then all grown or shrunk alike.  The same seed gives the same
/// places at every n.  Throws InputError for fewer than ten spheres.
VoxelImage boolean_spheres(BooleanModel, double solid_fraction, double box, int n, unsigned seed);

}  // namespace densify::fem
