#pragma once
// The contact network: particles as nodes, contacts as edges that know their geometry and their linearised law.  Built
// on demand; the inertia-free step, elastic and viscous probes and the sintering stress read it.

#include "dem/network/visit_contacts.h"

namespace densify::dem {

/// One contact that transmits force.
struct NetworkEdge {
  std::uint32_t i, j;  ///< particles; at a wall j is the wall's index
  bool at_wall;
  std::size_t place;   ///< in the contact list, or among the walls' contacts
  Vec3 normal;         ///< from i to j, or to the wall
  Vec3 branch;         ///< from centre to centre, or from centre to wall [m]
  double overlap;      ///< u, negative in contact [m]
  double neck_radius;  ///< a; 0 without a neck [m]
  double lever;        ///< from the centre of i along the normal to the contact point, r_i + u/2 [m]
  Linearisation law;   ///< stiffness, damper, viscosity, active and stored force
};

struct Network {
  std::size_t particles = 0;
  std::vector<NetworkEdge> edges;
};

/// The network of the touching or necked pairs and wall contacts at a process time [s].
Network build_network(const ContactWorld&, double time);

/// Particles that cannot carry force, flagged: those with fewer than `least` edges to others that can (walls count).
/// In a network of normal springs that only push four edges hold a particle, with tension three, bonded ones one.
std::vector<bool> find_rattlers(const Network&, std::size_t least);

/// One contact over a step with its neck frozen, by backward Euler: F(t+h) = force + coefficient x rate.
struct FrozenStep {
  double force;        ///< at rate 0, sintering force included [N]
  double coefficient;  ///< [N s/m]
};

/// The Maxwell element of `l` over a step h [s], as the laws' backward Euler has it: u_e' = v - k u_e/eta, the damper
/// on u_e', so that coefficient = (k h + c)/(1 + k h/eta) and the stored force F_n falls to F_n (1 - c/eta)/(1 + k
/// h/eta). Without a spring (viscous contact) the coefficient is eta.
FrozenStep frozen_step(const Linearisation& l, double step);

}  // namespace densify::dem
