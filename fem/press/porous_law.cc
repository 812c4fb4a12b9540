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

PorousResponse SkorohodOlevsky::response(const PorousState& s) const {
  constexpr double gas_constant = 8.31446261815324;
  const double rho = std::clamp(s.density, 0.01, 1.0);  // beyond it is a Newton iteration on its way
  const double theta = 1 - rho;
  const double eta = p_.viscosity * std::exp(p_.activation_enthalpy / gas_constant *
                                             (1 / s.temperature - 1 / p_.reference_temperature));
  const double share = rho * rho;
  PorousResponse r;
  r.stiffness = isotropic_tensor(share * p_.youngs_modulus / (3 * (1 - 2 * p_.poissons_ratio)),
                                 share * p_.youngs_modulus / (2 * (1 + p_.poissons_ratio)));
  r.fluidity = isotropic_inverse(0.75 * theta / (rho * rho * rho * eta), 1 / (eta * rho * rho));
  r.sintering_stress.setZero();
  r.sintering_stress.head<3>().setConstant(3 * p_.surface_energy / p_.particle_radius * rho * rho);
  return r;
}

double SkorohodOlevsky::thermal_strain(double temperature) const {
  return p_.thermal_expansion * (temperature - p_.reference_temperature);
}

}  // namespace densify::fem
