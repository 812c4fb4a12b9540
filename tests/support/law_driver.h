#pragma once
// A point driver: one contact law through a prescribed history, with no particles, no list and no integrator.

#include <functional>

#include "dem/law/sintering.h"

namespace densify::test {

/// What does not change along the history.
struct DriverPair {
  double radius;        ///< of both spheres [m]
  double reduced_mass;  ///< [kg]
};

/// One point of the answer.
struct DriverRow {
  double time;             ///< [s]
  double overlap;          ///< [m]
  dem::NormalForce force;  ///< [N]
  dem::NeckHistory neck;   ///< after the update
};

/// Input of one update at time t, reached by a step during which the overlap changed by `change`.
inline dem::NormalInput driver_input(const DriverPair& pair, double overlap, double change, double step, double time) {
  return {overlap, step > 0 ? change / step : 0.0, 0.5 * pair.radius, pair.radius, pair.reduced_mass, step, time};
}

/// Drives a law with necks through overlap(t) [m] from `begin` to `end` [s] in equal steps.  `prepare(law, t)` sets
/// what depends on temperature before each update.
template <class Law>
std::vector<DriverRow> drive(Law law, const DriverPair& pair, dem::NeckHistory neck, double begin, double end,
                             int steps, const std::function<double(double)>& overlap,
                             const std::function<void(Law&, double)>& prepare) {
  std::vector<DriverRow> rows;
  const double step = (end - begin) / steps;
  double before = overlap(begin);
  for (int n = 0; n <= steps; ++n) {
    const double time = begin + n * step, now = overlap(time);
    prepare(law, time);
    // As the contact pass does: a pair without overlap and without a neck is not asked.
    dem::NormalForce force;
    if (now < 0 || neck.phase != dem::NeckPhase::loose)
      force = law.update(driver_input(pair, now, now - before, n == 0 ? 0.0 : step, time), neck);
    rows.push_back({time, now, force, neck});
    before = now;
  }
  return rows;
}

}  // namespace densify::test
