#pragma once
// Elastic moduli and strengths measured on specimens, from a table.

#include <filesystem>

#include "app/comparison.h"

namespace densify::app {

/// A table with the column relative_density and any of: youngs_modulus_GPa and poissons_ratio; density_kg_per_m3,
/// longitudinal_speed_m_per_s and transverse_speed_m_per_s, which give them by (3.3) and (3.4); strength_MPa;
/// peak_force_N, disc_height_mm and disc_diameter_mm, which give it by (3.6).  Other columns are passed over, fields
/// may be empty, `#` starts a comment line.  In ascending order of density.  Throws InputError with file and line.
Route read_measured_moduli(const std::filesystem::path&);

}  // namespace densify::app
