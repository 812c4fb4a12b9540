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

/// Friction as the contacts of a bucket or wall need it.
struct Friction {
  double coefficient;      ///< mu
  double stiffness_ratio;  ///< k_t / k_n
  double damping;          ///< 2 xi_t sqrt(k_t / k_n), so that c_t = damping x sqrt(m k_n)

  Friction(const FrictionModel& m, double mu)
      : coefficient(mu),
        stiffness_ratio(m.tangential_stiffness_ratio),
        damping(2 * m.tangential_damping_ratio * std::sqrt(m.tangential_stiffness_ratio)) {}
};

/// Tangential force on i [N]; advances the spring displacement `slip` [m], which turns with the contact plane and is
/// cut back to what the sliding force stretches.
template <class T>
TripleOf<T> coulomb(const Friction& friction, const TangentialInputOf<T>& in, TripleOf<T>& slip) {
  const T k = friction.stiffness_ratio * in.normal_stiffness;
  T c = 0.0;
  if (friction.damping > 0) c = friction.damping * root(in.reduced_mass * in.normal_stiffness);
  slip = slip + T(in.step) * in.velocity;
  slip = slip - dot(slip, in.normal) * in.normal;
  const TripleOf<T> damping = c * in.velocity;
  TripleOf<T> force = k * slip + damping;
  const T limit = friction.coefficient * in.normal_force, size2 = dot(force, force);
  const auto slides = size2 > limit * limit;
  if (any(slides)) {
    const auto stretches = k > 0;
    const T size = root(size2), stiffness = select(stretches, k, T(1.0));
    const T inverse = 1.0 / (size * stiffness);  // one division for two
    force = select(slides, (limit * (inverse * stiffness)) * force, force);
    slip = select(slides & stretches, (inverse * size) * (force - damping), slip);
  }
  return force;
}

/// What a solid sphere answers to a tangential force at its surface, 1/m + r^2/J, over its 1/m.
inline constexpr double rotation_factor = 3.5;

/// Share of the sticking tangential spring in StepStiffness, 3.5 (k_t + 2 c_t/dt) [N/m].
template <class T>
T tangential_step_stiffness(const Friction& friction, const T& normal_stiffness, const T& reduced_mass,
                            double next_step) {
  const T k = friction.stiffness_ratio * normal_stiffness;
  if (!(friction.damping > 0)) return rotation_factor * k;
  return rotation_factor * (k + 2 * friction.damping * root(reduced_mass * normal_stiffness) / next_step);
}
inline double tangential_step_stiffness(const FrictionModel& model, double normal_stiffness, double reduced_mass,
                                        double next_step) {
  return tangential_step_stiffness(Friction(model, model.coefficient), normal_stiffness, reduced_mass, next_step);
}

}  // namespace densify::dem
