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
  const TripleOf<double> force =
      coulomb(Friction(model, coefficient),
              TangentialInputOf<double>{triple(in.normal), triple(in.velocity), in.normal_force, in.normal_stiffness,
                                        in.reduced_mass, in.step},
              turned);
  slip = Vec3(turned.x, turned.y, turned.z);
  return {force.x, force.y, force.z};
}

/// Stiffness and damper of the sticking tangential spring as its particles' step limits have to count them, 3.5 k_t and
/// 3.5 c_t across the normal: with displacement x and turn y = r phi sqrt(J/(m r^2)), |P (x + sqrt(2.5) n x y)|^2 <=
/// 3.5 (|P x|^2 + |P y|^2), P the projection on the contact plane.
inline Linearisation tangential_share(const Linearisation& l, const ContactModel& model, double reduced_mass) {
  Linearisation t;
  if (!model.friction) return t;
  const double k = model.friction->tangential_stiffness_ratio * l.stiffness;
  t.stiffness = rotation_factor * k;
  t.damper = rotation_factor * 2 * model.friction->tangential_damping_ratio * std::sqrt(reduced_mass * k);
  return t;
}

}  // namespace densify::dem
