#pragma once
// What is measured on specimens, and what it says of them: ultrasound and the Brazilian test (thesis 3.2), and how the
// strength falls with porosity.

#include <cmath>
#include <numbers>

#include "base/isotropic.h"

namespace densify {

/// Speed of a wave whose echoes from the far side of a specimen come one after the other, V = 2 L/dt (3.5) [m/s].
/// @param thickness  L [m]
/// @param delay      dt from one echo to the next [s]
inline double pulse_echo_speed(double thickness, double delay) {
  return 2 * thickness / delay;
}

/// Moduli of an isotropic body from its waves (3.3, 3.4): G = rho V_T^2, K = rho (V_L^2 - 4/3 V_T^2), the same E and
/// nu.
/// @param density       bulk density [kg/m^3]
/// @param longitudinal  V_L [m/s]
/// @param transverse    V_T [m/s], below sqrt(3)/2 V_L for a positive K
inline IsotropicModuli moduli_of_waves(double density, double longitudinal, double transverse) {
  const double l = longitudinal * longitudinal, t = transverse * transverse;
  return {density * (l - 4 * t / 3), density * t};
}

/// Tensile strength of a disc that splits along the diameter on which it is pressed, 2 P/(pi h d) (3.6) [Pa].
/// @param force     at failure [N]
/// @param height    of the disc [m]
/// @param diameter  [m]
inline double brazilian_strength(double force, double height, double diameter) {
  return 2 * force / (std::numbers::pi * height * diameter);
}

/// Exponent that the thesis finds for the strength of NiAl-Al2O3 (3.3.3).
inline constexpr double thesis_strength_exponent = 11;

/// Strength over that of the dense body, exp(-q theta) of Ryshkewitch (1953) (3.9), with theta the porosity.
inline double ryshkewitch_strength_ratio(double relative_density, double exponent) {
  return std::exp(-exponent * (1 - relative_density));
}

}  // namespace densify
