#pragma once
// densify voxel-moduli: elastic moduli of a packing, or of spheres at random, by finite elements on voxels.

#include <mpi.h>

#include <limits>

#include "app/chosen_result.h"

namespace densify::app {

struct VoxelCommand : ChosenResult {
  std::vector<int> voxels{32, 48, 64};  ///< along the longest edge
  double tolerance = 1e-6;
  bool pores = false;                                             ///< the spheres are the pores
  double temperature = std::numeric_limits<double>::quiet_NaN();  ///< of the solids [K]; NaN: the snapshot's
  // Instead of a result:
  std::string spheres;            ///< "solid" or "pores": the models of Roberts and Garboczi
  std::vector<double> fractions;  ///< solid
  int realisations = 5;
  double box = 12;                                  ///< edge over the spheres' radius
  double youngs_modulus = 1, poissons_ratio = 0.3;  ///< [Pa]
};

/// Collective; only the first rank writes and prints.  Returns the exit code; errors are thrown.
int voxel_command(const VoxelCommand&, MPI_Comm);

}  // namespace densify::app
