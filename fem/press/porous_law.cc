#include "fem/press/porous_law.h"

#include <algorithm>
#include <cmath>

namespace densify::fem {

Mat6 isotropic_tensor(double bulk, double shear) {
  Mat6 c = Mat6::Zero();
  c.topLeftCorner<3, 3>().setConstant(bulk - 2.0 / 3.0 * shear);
  for (int k = 0; k < 3; ++k) c(k, k) += 2 * shear, c(k + 3, k + 3) = shear;
  return c;
}

Mat6 isotropic_inverse(double bulk_inverse, double shear_inverse) {
  Mat6 s = Mat6::Zero();
  s.topLeftCorner<3, 3>().setConstant(bulk_inverse / 9 - shear_inverse / 6);
  for (int k = 0; k < 3; ++k) s(k, k) += shear_inverse / 2, s(k + 3, k + 3) = shear_inverse;
  return s;
}

namespace {

/// Beyond these is a Newton iteration on its way.
double within(double density) {
  return std::clamp(density, 0.01, 1.0);
}

}  // namespace

PorousFlow SkorohodOlevsky::flow(const PorousState& s) const {
  constexpr double gas_constant = 8.31446261815324;
  const double rho = within(s.density), theta = 1 - rho;
  const double eta = p_.viscosity * std::exp(p_.activation_enthalpy / gas_constant *
                                             (1 / s.temperature - 1 / p_.reference_temperature));
  PorousFlow f;
  f.fluidity = isotropic_inverse(0.75 * theta / (rho * rho * rho * eta), 1 / (eta * rho * rho));
  f.sintering_stress.setZero();
  f.sintering_stress.head<3>().setConstant(3 * p_.surface_energy / p_.particle_radius * rho * rho);
  return f;
}

PorousStrength SkorohodOlevsky::strength(const PorousState& s) const {
  const double youngs = std::pow(within(s.density), 2) * p_.youngs_modulus;
  return {isotropic_tensor(youngs / (3 * (1 - 2 * p_.poissons_ratio)), youngs / (2 * (1 + p_.poissons_ratio)))};
}

double SkorohodOlevsky::thermal_strain(double temperature) const {
  return p_.thermal_expansion * (temperature - p_.reference_temperature);
}

}  // namespace densify::fem
