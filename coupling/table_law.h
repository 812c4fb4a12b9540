#pragma once
// A porous solid by a response table: what grains do while they are loose, while they sinter, and when they are cold
// again.

#include <optional>

#include "coupling/table_curves.h"
#include "fem/press/porous_law.h"

namespace densify::coupling {

/// Loose grains: elastic within stress : yield : stress <= 1, (q/a)^2 + (p/b)^2 with mean pressure p and shear stress
/// q.  The flow is normal to it; a/b follows from the stress ratio of the die, where the sides stand still: q/p =
/// (2/3) (a/b)^2. Necks: viscosity, sintering stress and stiffness of a density, viscosities by 1/D_eff(T); a point
/// whose necks began at another density than those of the table's branches stands between them, at the same share of
/// the way to the end.  Cold: diffusion has ended, what is left is elastic.  Of path "die".
class TableLaw : public fem::PorousLaw {
 public:
  /// `clamp`: a state beyond the table has the values of its end, and a viscosity that grows as 1/porosity.  Throws
  /// InputError when the table lacks a branch.
  TableLaw(const ResponseTable&, bool clamp);

  fem::PorousFlow flow(const fem::PorousState&) const override;
  fem::PorousStrength strength(const fem::PorousState&) const override;
  double thermal_strain(double temperature) const override;
  double activation_temperature() const override { return activation_; }
  std::string outside(const fem::PorousState&) const override;

  /// Axial pressures in the die for which the table holds loose powder [Pa].
  std::pair<double, double> loose_pressures() const;
  /// Relative density, without elastic strain, to which one of them presses loose powder in a die; nothing beyond them.
  std::optional<double> presses_to(double pressure) const;

 private:
  struct Branch {
    double birth, end;  // densities
    ShapePreserving curve;
  };

  /// The first N of the table's numbers for powder with necks, and the density where its branch ends.
  template <int N>
  std::pair<Eigen::Matrix<double, N, 1>, double> necked(const fem::PorousState&) const;

  ShapePreserving cold_;
  std::vector<Branch> branches_;
  PiecewiseLinear youngs_modulus_;
  dem::GrainBoundaryDiffusion diffusion_;
  double reference_diffusion_, activation_, expansion_;
  bool clamp_;
};

/// Stress : yield : stress = (q/a)^2 + (p/b)^2 of a powder that yields in a die under these pressures.
Mat6 yield_of(double axial, double lateral);

}  // namespace densify::coupling
