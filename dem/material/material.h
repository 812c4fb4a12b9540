#pragma once
// What a powder is made of, and what two powders are to each other.

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "base/piecewise_linear.h"

namespace densify::dem {

inline constexpr double boltzmann_constant = 1.380649e-23;                 ///< k_B [J/K] (SI 2019, exact)
inline constexpr double gas_constant = 8.31446261815324;                   ///< R [J/(mol K)] (SI 2019, exact)
inline constexpr double unset = std::numeric_limits<double>::quiet_NaN();  ///< physics that nobody set

/// Grain boundary diffusion along a contact (4.81, 4.83).
struct GrainBoundaryDiffusion {
  double atomic_volume = unset;         ///< Omega, volume per atom (4.82) [m^3]
  double prefactor = unset;             ///< D_0gb [m^2/s]
  double activation_enthalpy = unset;   ///< Delta H_gb [J/mol]
  double grain_boundary_width = unset;  ///< delta [m]

  /// Effective coefficient D_eff = D_0gb exp(-H/(R T)) delta Omega / (k_B T) (4.81, 4.83) [m^5/(N s)], T > 0 [K].
  double effective(double temperature) const;
  bool complete() const;
};

/// One material of the powder; quantities that a scene does not need may stay unset (NaN).
struct Material {
  std::string name;
  double density = unset;          ///< theoretical density at the reference temperature [kg/m^3]
  double thermal_expansion = 0;    ///< linear coefficient alpha [1/K]
  PiecewiseLinear youngs_modulus;  ///< E(T) [Pa] over [K]
  PiecewiseLinear poissons_ratio;  ///< nu(T) over [K]
  GrainBoundaryDiffusion diffusion;
  double surface_energy = unset;          ///< gamma_s [J/m^2]
  double dihedral_angle = unset;          ///< Psi [rad]
  double activation_temperature = unset;  ///< sintering starts here, about half the melting point [K]
};

/// What differs from the average of the two materials at their common contact; unset members are derived.
struct Interface {
  std::uint8_t a = 0, b = 0;              ///< material indices, a <= b
  GrainBoundaryDiffusion diffusion;       ///< unset: only for a == b, from the material
  double effective_modulus = unset;       ///< E* [Pa]; unset: (4.20)
  double surface_energy = unset;          ///< [J/m^2]; 0 = no sintering force (thesis 5.4)
  double dihedral_angle = unset;          ///< [rad]
  double activation_temperature = unset;  ///< [K]; unset: the higher of the two
};

/// Effective modulus of two bodies, 1/E* = (1-nu_i^2)/E_i + (1-nu_j^2)/E_j (4.20) [Pa].
double effective_modulus(double youngs_i, double poisson_i, double youngs_j, double poisson_j);

/// The interface of two materials with every member set that can be derived: diffusion, surface energy and angle from
/// the material for like pairs; for unlike pairs they must come from the scene.
Interface complete_interface(const std::vector<Material>& materials, std::uint8_t a, std::uint8_t b,
                             const std::vector<Interface>& given);

/// E* of the interface at a temperature [Pa].
double interface_modulus(const Interface&, const std::vector<Material>& materials, double temperature);

}  // namespace densify::dem
