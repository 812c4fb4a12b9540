#pragma once
// Pore closure: the last pores of a powder resist, though spheres that only overlap know nothing of them.

#include <cstdint>

#include "dem/law/scalar.h"

namespace densify::dem {

/// Share of its viscous flow that the pores around a contact leave to it, from the local relative density: 1 down to a
/// porosity `onset`, below that in proportion to the porosity, as the bulk viscosity of a body with few pores goes with
/// 1/porosity (Skorohod; Olevsky, Mater. Sci. Eng. R 23 (1998) 41: psi = 2/3 (1 - theta)^3/theta).  A little is left
/// where spheres overlap beyond full density.
template <class T>
T flow_share(const T& relative_density, double onset) {
  constexpr double least = 1e-3;
  return smaller(T(1.0), larger(T(least), (1.0 - relative_density) / onset));
}

/// The pores of a powder as its contacts meet them.
struct PoreClosure {
  const double* density = nullptr;  ///< of each particle, when last measured; null: pores do not resist
  double scale = 1;                 ///< relative density of the powder now over that then
  double onset = 0;                 ///< porosity from which on pores resist

  double density_at(std::uint32_t i, std::uint32_t j) const { return 0.5 * scale * (density[i] + density[j]); }
  /// Of the contact of two particles.
  double share(std::uint32_t i, std::uint32_t j) const { return density ? flow_share(density_at(i, j), onset) : 1.0; }
};

}  // namespace densify::dem
