#include "dem/run_watch.h"

#include <cmath>
#include <cstdio>

namespace densify::dem {

namespace {

std::string text(const char* format, double a) {
  char buffer[120];
  std::snprintf(buffer, sizeof buffer, format, a);
  return buffer;
}

/// The key that makes masses smaller when it is lowered.
const char* what_sets_masses(const IntegrationSettings& s) {
  return !std::isnan(s.accuracy)          ? "accuracy"
         : s.inertia == Inertia::uniform  ? "mass_scaling"
         : !std::isnan(s.inertia_measure) ? "inertia_measure"
                                          : "fixed_step";
}

}  // namespace

RunWatch RunWatch::from(std::span<const double> n) {
  return {n[0], n[1], n[2], n[3], n[4], n[5]};
}

std::array<double, RunWatch::size> RunWatch::numbers() const {
  return {moving, largest_ratio, largest_time, damping_share, damping_time, last_look};
}

void RunWatch::note_damping(double share, double time) {
  constexpr double too_much = 0.01;
  if (damping_share == 0 && share > too_much) damping_share = share, damping_time = time;
}

RunWatch RunWatch::and_then(const Guards& seen) const {
  RunWatch w = *this;
  w.last_look = seen.last_look();
  w.moving += seen.not_quasi_static();
  if (seen.largest_ratio() > largest_ratio) {
    w.largest_ratio = seen.largest_ratio();
    w.largest_time = seen.time_of_largest_ratio();
  }
  return w;
}

std::vector<std::string> RunWatch::warnings(const IntegrationSettings& settings, double time) const {
  constexpr double tolerated_motion = 0.05;  // share of the process
  std::vector<std::string> all;
  if (damping_share > 0)
    all.push_back("dampers carry " + text("%.1f %%", 100 * damping_share) + " of the contact forces at process time " +
                  text("%.4g s", damping_time) +
                  ": the scaled masses make (4.24) viscous; lower contact.damping_ratio or " +
                  what_sets_masses(settings));
  // The quasi-static criterion: inertia must not take part in the process for more than a short while.
  if (moving > tolerated_motion * time)
    all.push_back("not quasi-static for " + text("%.3g %%", 100 * moving / time) +
                  " of the process: kinetic energy above " + text("%.3g", settings.guards.quasi_static_ratio) +
                  " of the elastic energy, at most " + text("%.3g", largest_ratio) + " at process time " +
                  text("%.4g s", largest_time) + "; lower " + what_sets_masses(settings) +
                  ", or raise the damping ratios");
  return all;
}

}  // namespace densify::dem
