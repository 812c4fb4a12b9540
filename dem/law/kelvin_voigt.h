#pragma once
// The contact of loose particles: spring and damper in parallel, no tension in the spring (4.14-4.26).

#include <algorithm>
#include <limits>

#include "dem/law/law.h"
#include "dem/law/springs.h"

namespace densify::dem {

template <class Spring>
struct KelvinVoigt {
  Spring spring;
  double damping_ratio;  ///< xi, of the critical damping (4.24, 4.25) of the tangent stiffness

  /// Damper c = 2 xi sqrt(m k) with the reduced mass and the tangent stiffness (4.24, 4.25) [N s/m].
  template <class T>
  T damper(const NormalInputOf<T>& in) const {
    return 2 * damping_ratio * root(in.reduced_mass * spring.tangent(in.overlap, in.elastic_radius));
  }

  /// Force of an overlapping pair, in.overlap < 0 (4.14, 4.22).
  template <class T>
  NormalForceOf<T> update(const NormalInputOf<T>& in) const {
    return {spring.force(in.overlap, in.elastic_radius) + damper(in) * in.rate, 0};
  }

  /// k + 2 c/dt of a step of length dt, at the overlap that the present rate leads to: see StepStiffness [N/m].
  template <class T>
  T step_stiffness(const NormalInputOf<T>& in, double next_step) const {
    const T k = spring.tangent(in.overlap + smaller(T(0.0), in.rate) * next_step, in.elastic_radius);
    if (damping_ratio == 0) return k;
    return k + (4 * damping_ratio / next_step) * root(in.reduced_mass * k);
  }

  Linearisation linearise(const NormalInput& in) const {
    if (in.overlap >= 0) return {0, 0, std::numeric_limits<double>::infinity(), 0, 0};
    return {spring.tangent(in.overlap, in.elastic_radius), damper(in), std::numeric_limits<double>::infinity(), 0,
            spring.force(in.overlap, in.elastic_radius)};
  }
};

}  // namespace densify::dem
