#pragma once
// Regularised Coulomb friction (4.27, 4.28, Fig. 4.6): a tangential spring that slides at mu times the normal force.

#include <algorithm>
#include <cmath>

#include "dem/law/contact_model.h"
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
  const double k = model.tangential_stiffness_ratio * in.normal_stiffness;
  const double c =
      model.tangential_damping_ratio > 0 ? 2 * model.tangential_damping_ratio * std::sqrt(in.reduced_mass * k) : 0.0;
  slip += in.velocity * in.step;
  slip -= slip.dot(in.normal) * in.normal;
  Vec3 force = k * slip + c * in.velocity;
  const double limit = coefficient * in.normal_force, size2 = force.squaredNorm();
  if (size2 > limit * limit) {
    force *= limit / std::sqrt(size2);
    if (k > 0) slip = (force - c * in.velocity) / k;
  }
  return force;
}

/// What a solid sphere answers to a tangential force at its surface, 1/m + r^2/J, over its 1/m.
inline constexpr double rotation_factor = 3.5;

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

/// The same share in StepStiffness, 3.5 (k_t + 2 c_t/dt) [N/m].
inline double tangential_step_stiffness(const FrictionModel& model, double normal_stiffness, double reduced_mass,
                                        double next_step) {
  const double k = model.tangential_stiffness_ratio * normal_stiffness;
  const double c =
      model.tangential_damping_ratio > 0 ? 2 * model.tangential_damping_ratio * std::sqrt(reduced_mass * k) : 0.0;
  return rotation_factor * (k + 2 * c / next_step);
}

}  // namespace densify::dem
