#pragma once
// Elastic stiffness of a body in voxels: every solid voxel a trilinear element, periodic, six unit strains.

#include <mpi.h>

#include "fem/voxel_image.h"

namespace densify::fem {

/// Isotropic elasticity.
struct ElasticSolid {
  double youngs_modulus;  ///< [Pa]
  double poissons_ratio;  ///< above -1, below 0.5
};

struct VoxelSettings {
  double tolerance = 1e-6;  ///< of the balance of forces, relative to the forces of a uniform strain
  int most_iterations = 2000;
};

struct VoxelAnswer {
  Mat6 stiffness = Mat6::Zero();  ///< effective, rows and columns xx yy zz yz xz xy, engineering shears [Pa]
  int iterations = 0;             ///< of all six solutions
  double power_mismatch = 0;      ///< probe work less stress times strain (Hill-Mandel), relative to the largest entry
  double asymmetry = 0;           ///< relative to the largest entry
  std::size_t elements = 0, nodes = 0;
  double seconds = 0;  ///< wall time
};

/// Displacements u = E x + periodic, forces in balance: C_kl = (1/V) sum over elements of (E_k x)^T K u_l.  Conjugate
/// gradients, preconditioned by smoothed aggregation (PETSc's GAMG).  `solids[m]` is material m of the image, which
/// must be one body (remove_loose).  Collective over the ranks of `comm`, each of which holds the whole image and a
/// slab of the system.  Throws RunError when a solution does not converge or a check fails.
VoxelAnswer voxel_stiffness(const VoxelImage&, const std::vector<ElasticSolid>& solids, const VoxelSettings&,
                            MPI_Comm comm);

}  // namespace densify::fem
