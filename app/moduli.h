#pragma once
// densify moduli: what material a packing is at chosen moments of a result, elastic and viscous.

#include <limits>
#include <string>
#include <vector>

namespace densify::app {

struct ModuliCommand {
  std::string source;               ///< a result folder, a result.h5, or a scene that is run first
  std::string folder;               ///< of the tables; empty: that of the result
  std::vector<std::string> times;   ///< with units
  std::vector<double> densities;    ///< relative
  std::vector<std::string> models;  ///< names; empty: all
  double tangential = std::numeric_limits<double>::quiet_NaN();  ///< lateral over normal stiffness
  double tangential_viscosity = 0;                               ///< lateral over normal viscosity
  double rigid = 1e4;                                            ///< see ModuliSettings
  std::vector<std::string> overrides;                            ///< of a scene
  int threads = 0;                                               ///< of a scene's run
  bool soft_modes = false;                                       ///< count them
  bool quiet = false;
};

/// Returns the exit code; errors are thrown.
int moduli_command(const ModuliCommand&);

}  // namespace densify::app
