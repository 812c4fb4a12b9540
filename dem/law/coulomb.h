#pragma once
// Regularised Coulomb friction (4.27, 4.28, Fig. 4.6): a tangential spring that slides at mu times the normal force.

#include "dem/law/contact_model.h"
#include "dem/law/scalar.h"

namespace densify::dem {

/// One frictional contact at one step, or a lane each of several.
template <class T>
struct TangentialInputOf {
  TripleOf<T> normal;    ///< from i to j
  TripleOf<T> velocity;  ///< v_rT of the contact points, j relative to i (4.27, 4.28) [m/s]
  T normal_force;        ///< compressive force that friction may lean on, >= 0 [N]
  T normal_stiffness;    ///< tangent k_n [N/m]
  T reduced_mass;        ///< [kg]
  double step;           ///< [s]
};

/// Tangential force on i [N]; advances the spring displacement `slip` [m], which turns with the contact plane and is
/// cut back to what the sliding force stretches.
template <class T>
TripleOf<T> coulomb(const FrictionModel& model, double coefficient, const TangentialInputOf<T>& in, TripleOf<T>& slip) {
  const T k = model.tangential_stiffness_ratio * in.normal_stiffness;
  T c = 0.0;  // 2 xi_t sqrt(m k_t), by the root that the normal damper takes too
  if (model.tangential_damping_ratio > 0)
    c = 2 * model.tangential_damping_ratio * std::sqrt(model.tangential_stiffness_ratio) *
        root(in.reduced_mass * in.normal_stiffness);
  slip = slip + T(in.step) * in.velocity;
  slip = slip - dot(slip, in.normal) * in.normal;
  const TripleOf<T> damping = c * in.velocity;
  TripleOf<T> force = k * slip + damping;
  const T limit = coefficient * in.normal_force, size2 = dot(force, force);
  const auto slides = size2 > limit * limit;
  if (any(slides)) {
    force = select(slides, (limit / root(size2)) * force, force);
    slip = select(slides & (k > 0), (1 / k) * (force - damping), slip);
  }
  return force;
}

/// What a solid sphere answers to a tangential force at its surface, 1/m + r^2/J, over its 1/m.
inline constexpr double rotation_factor = 3.5;

/// Share of the sticking tangential spring in StepStiffness, 3.5 (k_t + 2 c_t/dt) [N/m].
template <class T>
T tangential_step_stiffness(const FrictionModel& model, const T& normal_stiffness, const T& reduced_mass,
                            double next_step) {
  const T k = model.tangential_stiffness_ratio * normal_stiffness;
  if (!(model.tangential_damping_ratio > 0)) return rotation_factor * k;
  const T c = 2 * model.tangential_damping_ratio * std::sqrt(model.tangential_stiffness_ratio) *
              root(reduced_mass * normal_stiffness);
  return rotation_factor * (k + 2 * c / next_step);
}

}  // namespace densify::dem
