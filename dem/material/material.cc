#include "dem/material/material.h"

#include <algorithm>
#include <cmath>

namespace densify::dem {

double GrainBoundaryDiffusion::effective(double temperature) const {
  const double d_gb = prefactor * std::exp(-activation_enthalpy / (gas_constant * temperature));
  return d_gb * grain_boundary_width * atomic_volume / (boltzmann_constant * temperature);
}

bool GrainBoundaryDiffusion::complete() const {
  return std::isfinite(atomic_volume) && std::isfinite(prefactor) && std::isfinite(activation_enthalpy) &&
         std::isfinite(grain_boundary_width);
}

double effective_modulus(double youngs_i, double poisson_i, double youngs_j, double poisson_j) {
  return 1 / ((1 - poisson_i * poisson_i) / youngs_i + (1 - poisson_j * poisson_j) / youngs_j);
}

Interface complete_interface(const std::vector<Material>& materials, std::uint8_t a, std::uint8_t b,
                             const std::vector<Interface>& given) {
  if (a > b) std::swap(a, b);
  Interface result;
  for (const auto& g : given)
    if (g.a == a && g.b == b) result = g;
  result.a = a;
  result.b = b;
  const Material &ma = materials[a], &mb = materials[b];
  auto fill = [](double& value, double from) {
    if (std::isnan(value)) value = from;
  };
  if (a == b) {
    fill(result.diffusion.atomic_volume, ma.diffusion.atomic_volume);
    fill(result.diffusion.prefactor, ma.diffusion.prefactor);
    fill(result.diffusion.activation_enthalpy, ma.diffusion.activation_enthalpy);
    fill(result.diffusion.grain_boundary_width, ma.diffusion.grain_boundary_width);
    fill(result.surface_energy, ma.surface_energy);
    fill(result.dihedral_angle, ma.dihedral_angle);
  }
  fill(result.activation_temperature, std::max(ma.activation_temperature, mb.activation_temperature));
  return result;
}

double interface_modulus(const Interface& interface, const std::vector<Material>& materials, double temperature) {
  if (!std::isnan(interface.effective_modulus)) return interface.effective_modulus;
  const Material &a = materials[interface.a], &b = materials[interface.b];
  return effective_modulus(a.youngs_modulus(temperature), a.poissons_ratio(temperature), b.youngs_modulus(temperature),
                           b.poissons_ratio(temperature));
}

}  // namespace densify::dem
