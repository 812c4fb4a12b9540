#pragma once
// Young's modulus and Poisson's ratio of two porous bodies over their relative density, fitted to voxel finite elements
// by A. P. Roberts and E. J. Garboczi (J. Am. Ceram. Soc. 83, 2000, 3041) (3.7, 3.8).

#include <cmath>

namespace densify {

struct RobertsGarboczi {
  double rho_0, c, rho_1, nu_1;  ///< thesis Table 3.4

  /// E over that of the solid (3.7); zero where the solid no longer hangs together.
  double youngs_ratio(double relative_density) const {
    return relative_density > rho_0 ? std::pow((relative_density - rho_0) / (1 - rho_0), c) : 0;
  }
  /// nu, from that of the solid (3.8).
  double poissons_ratio(double relative_density, double solid) const {
    return solid + (1 - relative_density) / (1 - rho_1) * (nu_1 - solid);
  }
};

inline constexpr RobertsGarboczi overlapping_solid_spheres{0.348, 2.23, 0.528, 0.140};
inline constexpr RobertsGarboczi overlapping_spherical_pores{0.182, 1.65, 0.160, 0.221};

}  // namespace densify
