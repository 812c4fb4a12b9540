#pragma once
// Regularised Coulomb friction (4.27, 4.28, Fig. 4.6) of one contact, and what it adds to step limits.

#include <algorithm>
#include <cmath>

#include "dem/law/coulomb.h"
#include "dem/law/law.h"
#include "dem/state/particles.h"

namespace densify::dem {

/// One frictional contact at one step.
struct TangentialInput {
  Vec3 normal;              ///< from i to j
  Vec3 velocity;            ///< v_rT of the contact points, j relative to i (4.27, 4.28) [m/s]
  double normal_force;      ///< compressive force that friction may lean on, >= 0 [N]
  double normal_stiffness;  ///< tangent k_n [N/m]
  double reduced_mass;      ///< [kg]
  double step;              ///< [s]
};

/// Tangential force on i [N]; advances the spring displacement `slip` [m], which turns with the contact plane and is
/// cut back to what the sliding force stretches.
inline Vec3 coulomb(const FrictionModel& model, double coefficient, const TangentialInput& in, Vec3& slip) {
  const auto triple = [](const Vec3& v) { return TripleOf<double>{v[0], v[1], v[2]}; };
  TripleOf<double> turned = triple(slip);
  const TripleOf<double> force = coulomb(model, coefficient,
                                         TangentialInputOf<double>{triple(in.normal), triple(in.velocity),
                                                                   in.normal_force, in.normal_stiffness,
                                                                   in.reduced_mass, in.step},
                                         turned);
  slip = Vec3(turned.x, turned.y, turned.z);
  return {force.x, force.y, force.z};
}

/// Stiffness and damper of a contact as its particles' step limits have to count them: the larger of the normal ones
/// and 3.5 times those of the sticking tangential spring, because a solid sphere answers it with 1/m + r^2/J = 3.5/m.
inline Linearisation with_tangential_share(Linearisation l, const ContactModel& model, double reduced_mass) {
  if (!model.friction) return l;
  constexpr double rotation_factor = 3.5;
  const double k = model.friction->tangential_stiffness_ratio * l.stiffness;
  const double c = 2 * model.friction->tangential_damping_ratio * std::sqrt(reduced_mass * k);
  l.stiffness = std::max(l.stiffness, rotation_factor * k);
  l.damper = std::max(l.damper, rotation_factor * c);
  return l;
}

}  // namespace densify::dem
