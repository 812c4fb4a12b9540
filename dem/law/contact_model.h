#pragma once
// The settings of the contact model as a scene states them; every choice that the thesis leaves open.

#include <optional>

#include "dem/material/material.h"

namespace densify::dem {

enum class Elasticity { linear, hertz };  ///< (4.15) or (4.18)
enum class HertzRadius {
  reduced,
  equivalent
};  ///< r_i r_j/(r_i+r_j), or twice that as (4.21) prints it (sqrt(2) stiffer)
enum class SinteringModel { viscoelastic, viscous };  ///< Maxwell (4.37-4.46) or dashpot (4.29-4.36)
enum class SinteringRadius { equivalent, smaller };   ///< 2 r_i r_j/(r_i+r_j) (4.33), or min(r_i, r_j)
enum class NeckGrowth { integrated, overlap };        ///< (4.31), or 1.43 sqrt(r^2 - (r-u/2)^2) of the current overlap
enum class MaxwellUpdate { trapezoidal, backward_euler };  ///< (4.67), or the L-stable update
enum class AtEquilibrium { elastic_bond, viscous };        ///< eta -> infinity, or eta_inf kept as in the thesis

/// Regularised Coulomb friction (4.27, 4.28, Fig. 4.6).
struct FrictionModel {
  double coefficient = unset;                     ///< mu between particles
  double wall_coefficient = unset;                ///< mu between particle and wall
  double tangential_stiffness_ratio = 2.0 / 7.0;  ///< k_t / k_n
  double tangential_damping_ratio = 0;            ///< of the critical damping of the tangential spring
};

/// Sintering contacts (thesis 4.5, 4.6).
struct SinteringSettings {
  SinteringModel model = SinteringModel::viscoelastic;
  SinteringRadius radius = SinteringRadius::equivalent;
  NeckGrowth neck = NeckGrowth::integrated;
  MaxwellUpdate update = MaxwellUpdate::backward_euler;
  AtEquilibrium at_equilibrium = AtEquilibrium::elastic_bond;
  double relaxation_time = 60;      ///< t_rel of the cosine transitions (4.47-4.54) [s]
  double viscosity_before = 1e12;   ///< eta_inf (4.47) [N s/m]
  double damping_ratio = 0.1;       ///< of the critical damping, acting on the elastic part of the rate only
  double starting_neck = 0.01;      ///< smallest neck radius over particle radius
  double tension_floor = 3e-4;      ///< Hertz in tension is linear with the tangent at this overlap over radius
  double closing_porosity = unset;  ///< local porosity from which on the last pores resist; unset: they never do
};

struct ContactModel {
  Elasticity elasticity = Elasticity::hertz;
  double normal_stiffness = unset;  ///< k_n of linear elasticity (4.15) [N/m]
  HertzRadius hertz_radius = HertzRadius::reduced;
  double stiffness_factor = 1;  ///< multiplies Hertz's stiffness, a stand-in for plastic yielding
  double damping_ratio = 0.1;   ///< xi of the Kelvin-Voigt contact (4.24)
  std::optional<FrictionModel> friction;
  std::optional<SinteringSettings> sintering;
};

}  // namespace densify::dem
