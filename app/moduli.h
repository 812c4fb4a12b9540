#pragma once
// densify moduli: what material a packing is at chosen moments of a result, elastic and viscous.

#include <limits>
#include <string>
#include <vector>

#include "app/chosen_result.h"
#include "dem/network/moduli.h"

namespace densify::app {

struct ModuliCommand : ChosenResult {
  std::vector<std::string> models;                               ///< names; empty: all
  double tangential = std::numeric_limits<double>::quiet_NaN();  ///< lateral over normal stiffness
  double tangential_viscosity = dem::ModuliSettings{}.tangential_viscosity;
  double rigid = dem::ModuliSettings{}.rigid;
  bool soft_modes = false;  ///< count them
};

/// Returns the exit code; errors are thrown.
int moduli_command(const ModuliCommand&);

}  // namespace densify::app
