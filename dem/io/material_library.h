#pragma once
// The keys of a material, and the materials that Densify ships as files of the same keys.

#include <string>
#include <string_view>
#include <vector>

#include "dem/material/material.h"
#include "dem/simulation.h"

namespace densify {
class Section;
}

namespace densify::dem {

/// The kind of specimen whose measured densities a material's diffusion was fitted to.
struct Calibration {
  std::optional<ContainerShape> shape;  ///< none: not fitted, or nobody says
  double size = unset;                  ///< diameter of the cylinder, or edge of box or cell [m]
};

/// A material as a file or a scene states it.
struct MaterialCard {
  Material material;
  Calibration calibration;
  double melting_temperature = unset;  ///< [K]; only sets the default of the activation temperature
};

/// Declares and reads every property of a material; keys that are absent keep what `card` holds.  An activation
/// temperature that nobody gives is half the melting temperature.  Throws InputError.
void read_material_keys(Section&, MaterialCard& card);

/// The four keys of grain boundary diffusion, which materials and interfaces share.  Throws InputError.
void read_diffusion_keys(Section&, GrainBoundaryDiffusion&);

/// Names of the shipped materials, sorted.  Throws FileError when the data folder is missing.
std::vector<std::string> library_names();

/// A shipped material, one of library_names().  Throws FileError when it is not there, InputError on a mistake in it.
MaterialCard library_material(const std::string& name);

}  // namespace densify::dem
