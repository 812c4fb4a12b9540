#pragma once
// How large a step may be: the stability limits of thesis 4.8, read as stability analysis gives them.

#include "dem/boundary/walls.h"

namespace densify::dem {

enum class StepRule : std::uint8_t {
  particle_sum,  ///< every particle's (and the punch's) row sum of stiffness and damping: safe in any packing
  thesis  ///< the smallest of the pairs' limits (4.71)-(4.75) as printed, to be used with its small safety factor
};

/// Largest step for which dt^2 k/(2 m) + dt c/m <= 1: a node of mass m whose contacts have stiffness sum k and damping
/// sum c, each with another free mass.  k alone gives sqrt(2 m/k) (4.69, 4.70), c alone m/c (half of (4.72) as printed,
/// which holds for one fixed end), both for one pair (4.71).  Infinite when k = c = 0. [s]
double node_limit(double mass, double stiffness, double damping);

/// Limits of one contact with reduced mass m as the thesis states them: 2/omega (sqrt(1+xi^2)-xi) (4.71), 4 m/eta
/// (4.72), min(2/omega, eta/k) (4.73-4.75) [s].
double thesis_limit(const Linearisation&, double reduced_mass);

/// What a step limit is made of.
struct StepLimit {
  double critical = 0;         ///< [s]
  std::uint32_t particle = 0;  ///< index of the particle that sets it
  double punch_stiffness = 0;  ///< sum over the contacts of each wall is in Walls; here of the punch [N/m]
};

/// The punch as a node of the limit; mass 0 = no moving punch.
struct PunchNode {
  double mass = 0;         ///< [kg]
  double own_damping = 0;  ///< [N s/m]
  std::size_t wall = 0;
};

StepLimit critical_step(const Particles&, const ContactList&, const Cell&, const PairTable&, const ContactModel&,
                        Walls&, const PunchNode&, PassTime, StepRule);

}  // namespace densify::dem
