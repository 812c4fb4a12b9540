#pragma once
// An elastic, viscous, sintering solid at points: an implicit step for the inelastic strain of a PorousLaw.

#include <memory>

#include "fem/press/point_material.h"
#include "fem/press/porous_law.h"

namespace densify::fem {

/// strain = elastic + thermal + inelastic; inelastic strain of a step = step x fluidity (stress - sintering stress),
/// with the stress at its end and the rest at the density and temperature of its middle: as stiff as backward Euler,
/// and of second order where the stress stands still; and a strain along yield : stress that keeps stress : yield :
/// stress below 1 at the end, 1e-4 of the stress for a strain of 1 %, whatever the step.  Relative density rho_1 =
/// rho_0 exp(-tr inelastic strain), exact. The stress is that of the elastic strain, sigma = C(rho, T) eps_el, so that
/// a stiffness that changes keeps no stress of the past. State: elastic strain (6), relative density, density at which
/// necks began (0: none yet).
class ViscousSolid : public PointMaterial {
 public:
  explicit ViscousSolid(std::shared_ptr<const PorousLaw> law) : law_(std::move(law)) {}

  std::size_t state_size() const override { return 8; }
  void begin(double density, std::span<double> states) const override;
  double density(std::span<const double> state) const override { return state[6]; }
  double solid_volume(std::span<const double> state, double temperature_at_start, double temperature) const override;
  void update(std::span<const PointStep>, std::span<const double> before, std::span<double> after,
              std::span<PointAnswer>) const override;
  std::string outside(std::span<const double> state, double temperature) const override;

 private:
  std::shared_ptr<const PorousLaw> law_;
};

}  // namespace densify::fem
