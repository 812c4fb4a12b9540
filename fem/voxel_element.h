#pragma once
// The one trilinear element that all voxels of a material share.

#include "fem/voxel_stiffness.h"

namespace densify::fem {

using ElementMatrix = Eigen::Matrix<double, 24, 24>;
using ElementProbes = Eigen::Matrix<double, 24, 6>;

/// Stiffness of the parallelepiped with the given edges [N/m]; row 3 v + c is component c at vertex v, whose bits say
/// along which edges it lies.
ElementMatrix element_matrix(const Mat3& edges, const ElasticSolid&);

/// Displacements of its vertices under the six unit strains, the first vertex at rest [m].
ElementProbes element_probes(const Mat3& edges);

/// The strain of unit component k: xx yy zz yz xz xy, shears as engineering shears.
Mat3 unit_strain(int k);

}  // namespace densify::fem
