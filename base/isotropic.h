#pragma once
// Isotropic elasticity: the two moduli that everything is made of, and the two that are measured.

namespace densify {

/// Bulk and shear modulus [Pa].
struct IsotropicModuli {
  double bulk, shear;

  /// E = 9 K G/(3 K + G) [Pa]; zero of a void.
  double youngs() const { return bulk > 0 ? 9 * bulk * shear / (3 * bulk + shear) : 0; }
  /// nu = (3 K - 2 G)/(2 (3 K + G)); NaN of a void.
  double poisson() const { return (3 * bulk - 2 * shear) / (2 * (3 * bulk + shear)); }
};

/// From Young's modulus [Pa] and Poisson's ratio, above -1 and below 0.5.
inline IsotropicModuli isotropic_moduli(double youngs, double poisson) {
  return {youngs / (3 * (1 - 2 * poisson)), youngs / (2 * (1 + poisson))};
}

}  // namespace densify
