#pragma once
// densify compare-moduli: moduli of packings along their densification by every route, beside curves and measurements.

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "app/chosen_result.h"

namespace densify::app {

struct CompareCommand : ChosenResult {  // one source after the other stands in its place
  std::vector<std::string> sources;     ///< results, or scenes that are run first
  std::vector<std::string> models;      ///< of contacts; empty: all
  std::string temperature = "20 degC";  ///< of the bodies when their moduli are taken
  std::string measured;                 ///< a table; empty: none
  bool no_voxels = false;
  std::vector<int> voxels{32, 48, 64};  ///< along the longest edge
  std::vector<double> voxel_densities;  ///< where voxels are taken; empty: everywhere
  int ranks = 1;                        ///< of the voxel elements
  double dense_strength = dem::unset;   ///< sigma_0 of (3.9) [MPa]; unset: fitted to measured strengths
  double strength_exponent = 11;        ///< q of (3.9)
};

/// The command's options.
void add_comparison_options(CLI::App&, CompareCommand&);

/// Returns the exit code; errors are thrown.
int compare_command(const CompareCommand&);

}  // namespace densify::app
