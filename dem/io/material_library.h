#pragma once
// The keys of a material, and the materials that Densify ships as files of the same keys.

#include <string>
#include <string_view>
#include <vector>

#include "dem/material/material.h"

namespace densify {
class Section;
}

namespace densify::dem {

/// A material as a file or a scene states it.
struct MaterialCard {
  Material material;
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
