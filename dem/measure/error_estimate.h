#pragma once
// What the numerical error of a relative density is likely to be, from what the run itself shows.

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace densify::dem {

/// Running estimate of the numerical error of the relative density.
///
/// Inertia adds per change of density a share c I, with the inertial number I = |D| d sqrt(rho'/p) of the masses as
/// they move: in a loose powder, which follows its load by jumps, a large one, in a sintering one a small one.  The
/// process forgets: what is too loose densifies faster.  So dE = (c I - E/lambda) |d rho|.  On top stands the noise of
/// one trajectory: contacts that open and close amplify rounding, so that two runs from one packing differ, after
/// unloading more than before.  Constants are measured, not derived, and good for pressed powders (doc/accuracy.md).
struct ErrorEstimate {
  static constexpr double loose_share = 160, sintering_share = 6;  ///< c
  static constexpr double largest_share = 0.15;                    ///< of c I: a collapse is soon forgotten
  static constexpr double memory = 0.1;                            ///< lambda
  static constexpr double solver_share = 20;                       ///< without inertia: E per step_tolerance
  static constexpr double tangential_share = 0.6;    ///< without inertia: E per inertia_free.tangential_share
  static constexpr double largest_tangential = 0.1;  ///< of it
  static constexpr double noise_share = 0.24;        ///< s sqrt(N) per density gained
  static constexpr double unloading_share = 0.15;    ///< s sqrt(N) per density, of what no longer carries its peak load
  static constexpr double deviations = 4;            ///< of the noise that count as error
  static constexpr std::size_t fewest_chaotic = 8;   ///< particles; fewer follow their path whatever the rounding

  double bias = 0;                ///< E
  double initial = std::nan("");  ///< rho_0

  /// c I of an inertial number.
  static double share(double inertial_number, bool sintering) {
    return std::min(largest_share, (sintering ? sintering_share : loose_share) * inertial_number);
  }
  /// What stands for c I without inertia.
  static double share_without_inertia(double step_tolerance, double tangential) {
    return (solver_share * step_tolerance + std::min(largest_tangential, tangential_share * tangential)) / memory;
  }

  /// Moves on to a density; `share` is c I between the last density and this one.
  void advance(double density_before, double density, double share) {
    const double forgotten = std::exp(-std::abs(density - density_before) / memory);
    bias = forgotten * bias + (1 - forgotten) * memory * share;
  }

  /// Standard deviation of the density of one run; `relieved` is the share of its peak load that a sintered powder no
  /// longer carries.
  double noise(double density, double relieved, std::size_t particles) const {
    if (particles < fewest_chaotic) return 0;
    return std::hypot(noise_share * (density - initial), unloading_share * relieved * density) /
           std::sqrt(double(particles));
  }

  /// Not exceeded in 95 of 100 runs.
  double error(double density, double relieved, std::size_t particles) const {
    return std::hypot(bias, deviations * noise(density, relieved, particles));
  }
};

}  // namespace densify::dem
