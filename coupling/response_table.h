#pragma once
// Responses of volume elements of one material, averaged over several, along paths of densification.

#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "base/piecewise_linear.h"
#include "base/tensor.h"
#include "dem/material/material.h"

namespace densify::coupling {

/// A tensor that does not change as the body turns about z: 11, 33, 12, 13, 44 of Voigt's notation.
using AxialTensor = std::array<double, 5>;

/// The part of a tensor that does not change as the body turns about z.
AxialTensor axial_part(const Mat6&);
Mat6 full_tensor(const AxialTensor&);
Mat6 inverse_tensor(const AxialTensor&);

/// Powder without necks, pressed in a die.
struct ColdNode {
  double density;          ///< relative, without elastic strain
  double axial, lateral;   ///< pressures [Pa]
  double density_scatter;  ///< standard deviation of one element, relative
  AxialTensor stiffness;   ///< over Young's modulus of the dense solid
};

/// Powder with necks.
struct SinteringNode {
  double density;                                      ///< relative, without elastic strain
  AxialTensor viscosity;                               ///< at the reference temperature [Pa s]
  AxialTensor stiffness;                               ///< over Young's modulus of the dense solid
  std::array<double, 2> sintering_stress;              ///< radial, axial [Pa]
  double viscosity_scatter, sintering_stress_scatter;  ///< standard deviation of one element, relative
  double neck_state;                                   ///< mean of (a/a_max)^2
  double at_equilibrium;                               ///< share of the necks
};

/// Along one path, of necks that began to grow at one density.
struct SinteringBranch {
  std::string path;        ///< "die", "hydrostatic" or "free"
  double birth;            ///< relative density at which necks began
  double pressure_factor;  ///< over the pressures of the process
  std::vector<SinteringNode> nodes;
};

/// A path that is not in the table, beside what the table makes of it.
struct TableCheck {
  double pressure_factor = 0, heating_factor = 0;
  std::vector<double> time, temperature, element, table;  ///< relative densities without elastic strain
  double loose_error = 0, error = 0;                      ///< largest difference before necks begin, and from then on
};

struct ResponseTable {
  std::string scene;                        ///< effective text of what it was made from
  std::string revision;                     ///< git's, of the program
  std::string material;                     ///< its name
  std::size_t particles = 0, elements = 0;  ///< of an element; averaged
  double reference_temperature = 0;         ///< of the viscosities [K]
  double activation_temperature = 0;        ///< [K]
  dem::GrainBoundaryDiffusion diffusion;
  double thermal_expansion = 0;            ///< [1/K]
  PiecewiseLinear youngs_modulus;          ///< of the dense solid [Pa] over [K]
  std::vector<ColdNode> cold;              ///< by growing density
  std::vector<SinteringBranch> sintering;  ///< of path "die" first, by growing birth
  TableCheck check;
};

void write_table(const std::filesystem::path&, const ResponseTable&);

/// Throws InputError when there is no such file, FileError when it is not a whole table.
ResponseTable read_table(const std::filesystem::path&);

}  // namespace densify::coupling
