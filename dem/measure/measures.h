#pragma once
// What a row of the history says about an RVE at one time.

#include "dem/measure/envelope.h"

namespace densify::dem {

struct Measures {
  Envelope envelope;
  double relative_density = 0;        ///< by envelope (5.5, 5.6)
  double relative_density_inner = 0;  ///< two mean diameters away from every wall
  double coordination_number = 0;     ///< touching or necked neighbours (walls not counted), mean
  double mean_neck_radius = 0;        ///< over the necks [m]
  double equilibrium_fraction = 0;    ///< necks at equilibrium over all necks
  double mean_local_density = unset;  ///< of the particles; with pore closure and necks only, as the next two
  double largest_local_density = unset;
  double closing_fraction = unset;  ///< necks that closing pores resist over all necks
  Mat3 stress = Mat3::Zero();  ///< (6.10), (1/V) sum of F (x) L over contacts and walls, F on i, L from i to j or from
                               ///< centre to wall; symmetrised, tension positive [Pa]
  Mat3 sintering_stress = Mat3::Zero();  ///< share of F_sint, affine (6.10) [Pa]
  double punch_pressure = 0;             ///< powder's force on the punch over its area [Pa]
  double bottom_pressure = 0;            ///< [Pa]
  double lateral_pressure = 0;           ///< normal force on the lateral walls over their area in contact [Pa]
  double contact_pressure = 0;           ///< mean stress that the contacts carry, all forces counted as positive [Pa]
  double unbalanced_force_ratio = 0;     ///< mean resultant over mean contact force
  double kinetic_energy = 0;             ///< with the scaled masses [J]
  double elastic_energy = 0;             ///< normal springs of contacts and walls [J]
  double damping_share = 0;              ///< sum of damper forces over sum of contact forces
  double largest_overlap = 0;            ///< overlap over the smaller radius, largest of all contacts
};

/// Measures of the state that was just evaluated with `recording` (before it moves on).
Measures measure(const Simulation&, const Recording&);

/// Branch vector x_j + image - x_i of pair k [m].
inline Vec3 branch_vector(const State& s, std::size_t k) {
  Vec3 l = s.particles.body[s.contacts.j(k)].position - s.particles.body[s.contacts.i(k)].position;
  if (s.cell.periodic) l += s.cell.shift(s.contacts.image(k));
  return l;
}

}  // namespace densify::dem
