#pragma once
// What a sintering porous solid is at a density and temperature, in closed form or from a table.

#include <string>

#include "base/tensor.h"

namespace densify::fem {

/// Strain rate = elastic + thermal + fluidity (stress - sintering stress) + what keeps stress : yield : stress <= 1.
struct PorousFlow {
  Mat6 fluidity;          ///< inverse of the viscosity, strain rates as engineering shears [1/(Pa s)]
  Vec6 sintering_stress;  ///< stress at no inelastic rate: positive where the free body shrinks [Pa]
};
struct PorousStrength {
  Mat6 stiffness;             ///< elastic [Pa]
  Mat6 yield = Mat6::Zero();  ///< of grains that slide past each other: zero where they do not [1/Pa^2]
};

/// What a porous solid is a function of.
struct PorousState {
  double density;      ///< relative, without elastic and thermal strain
  double temperature;  ///< [K]
  double birth;        ///< density at which necks began to grow; 0 while there are none
};

class PorousLaw {
 public:
  virtual ~PorousLaw() = default;

  /// Defined above full density too, where a Newton iteration may look.
  virtual PorousFlow flow(const PorousState&) const = 0;
  virtual PorousStrength strength(const PorousState&) const = 0;

  /// Necks begin to grow where the temperature first reaches this [K].
  virtual double activation_temperature() const { return 0; }

  /// Why the law does not hold for a state, a sentence; empty where it does.
  virtual std::string outside(const PorousState&) const { return {}; }

  /// Thermal strain from a reference temperature, that of the dense solid [1].
  virtual double thermal_strain(double temperature) const = 0;
};

/// Isotropic stiffness, or viscosity, of bulk and shear modulus.
Mat6 isotropic_tensor(double bulk, double shear);

/// The inverse of isotropic_tensor(); zero bulk_inverse for an incompressible one.
Mat6 isotropic_inverse(double bulk_inverse, double shear_inverse);

/// Skorohod and Olevsky's solid (Olevsky, Mater. Sci. Eng. R 23, 1998), porosity theta: shear viscosity eta phi, bulk
/// viscosity 2 eta psi, phi = (1 - theta)^2, psi = (2/3) (1 - theta)^3/theta, sintering stress (3 gamma/r)(1 -
/// theta)^2.
class SkorohodOlevsky : public PorousLaw {
 public:
  struct Parameters {
    double viscosity;                    ///< shear viscosity of the dense solid at `reference_temperature` [Pa s]
    double activation_enthalpy = 0;      ///< of its Arrhenius factor [J/mol]
    double reference_temperature = 300;  ///< [K]
    double surface_energy = 0;           ///< gamma [J/m^2]
    double particle_radius = 1;          ///< r [m]
    double youngs_modulus;               ///< of the dense solid [Pa]
    double poissons_ratio;               ///< of the dense solid, below 0.5
    double thermal_expansion = 0;        ///< [1/K]
  };

  /// Elastic moduli of the porous solid are those of the dense one times (1 - theta)^2, where nothing else is known.
  explicit SkorohodOlevsky(const Parameters& p) : p_(p) {}

  PorousFlow flow(const PorousState&) const override;
  PorousStrength strength(const PorousState&) const override;
  double thermal_strain(double temperature) const override;

 private:
  Parameters p_;
};

}  // namespace densify::fem
