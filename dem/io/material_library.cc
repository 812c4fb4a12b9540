#include "dem/io/material_library.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/data_path.h"
#include "base/scene_document.h"

namespace densify::dem {

void read_diffusion_keys(Section& section, GrainBoundaryDiffusion& diffusion) {
  section.quantity("atomic_volume", diffusion.atomic_volume, dim::volume, Range::positive(), Need::optional,
                   "Omega, volume per atom (4.82)");
  section.quantity("diffusion_prefactor", diffusion.prefactor, dim::diffusivity, Range::positive(), Need::optional,
                   "D_0gb of grain boundary diffusion (4.83)");
  section.quantity("activation_enthalpy", diffusion.activation_enthalpy, dim::molar_energy, Range::non_negative(),
                   Need::optional, "Delta H_gb of grain boundary diffusion (4.83)");
  section.quantity("grain_boundary_width", diffusion.grain_boundary_width, dim::length, Range::positive(),
                   Need::optional, "delta of the grain boundary (4.81)");
}

namespace {

void read_calibration(Section& section, Calibration& calibration) {
  using Shape = std::optional<ContainerShape>;
  section.choice("calibrated_on", calibration.shape,
                 {{"cylinder", Shape(ContainerShape::cylinder)},
                  {"box", Shape(ContainerShape::box)},
                  {"periodic", Shape(ContainerShape::periodic)},
                  {"free", Shape(ContainerShape::free)}},
                 Need::optional,
                 "shape of the specimen whose densities the diffusion was fitted to; says nothing if absent");
  section.quantity("calibrated_size", calibration.size, dim::length, Range::positive(), Need::optional,
                   "diameter or edge of that specimen");
  if (!calibration.shape && section.has("calibrated_size"))
    section.fail("calibrated_size", "is the size of a specimen of no shape; give calibrated_on");
}

}  // namespace

void read_material_keys(Section& section, MaterialCard& card) {
  Material& m = card.material;
  section.quantity("density", m.density, dim::density, Range::positive(), Need::optional,
                   "theoretical density at the reference temperature (5.6)");
  section.quantity("thermal_expansion", m.thermal_expansion, dim::thermal_expansion, Range::any(), Need::optional,
                   "linear coefficient alpha (4.17)");
  section.table("youngs_modulus", m.youngs_modulus, dim::temperature, dim::pressure, Range::positive(), Need::optional,
                "E over temperature (4.20)");
  section.table("poissons_ratio", m.poissons_ratio, dim::temperature, dim::none, Range::inside(-1.0, 0.5),
                Need::optional, "nu over temperature (4.20)");
  read_diffusion_keys(section, m.diffusion);
  // Other diffusion than the library's is another set of parameters.
  if (section.has("diffusion_prefactor") || section.has("activation_enthalpy")) card.calibration = {};
  read_calibration(section, card.calibration);
  section.quantity("surface_energy", m.surface_energy, dim::surface_energy, Range::non_negative(), Need::optional,
                   "gamma_s of the sintering force (4.36)");
  section.quantity("dihedral_angle", m.dihedral_angle, dim::angle, Range::inside(0.0, std::numbers::pi), Need::optional,
                   "Psi, sets the neck at equilibrium (4.32)");
  section.quantity("melting_temperature", card.melting_temperature, dim::temperature, Range::positive(), Need::optional,
                   "only sets the default of activation_temperature");
  if (section.has("melting_temperature") || std::isnan(m.activation_temperature)) {
    m.activation_temperature = 0.5 * card.melting_temperature;
  }
  section.quantity("activation_temperature", m.activation_temperature, dim::temperature, Range::positive(),
                   Need::optional, "sintering starts here; half the melting temperature in kelvin if absent");
}

std::vector<std::string> library_names() {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(data_path("materials"))) {
    if (entry.path().extension() == ".toml") names.push_back(entry.path().stem().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

MaterialCard library_material(const std::string& name) {
  SceneDocument document = SceneDocument::from_file(data_path("materials/" + name + ".toml"), {});
  Section root = document.root();
  MaterialCard card;
  card.material.name = name;
  read_material_keys(root, card);
  document.reject_unknown();
  return card;
}

}  // namespace densify::dem
