#pragma once
// What the summary of a run warns of: of the whole process, whatever its interruptions.

#include <array>
#include <span>
#include <string>
#include <vector>

#include "dem/simulation.h"

namespace densify::dem {

/// Travels with the checkpoint.
struct RunWatch {
  double moving = 0;                           ///< process time that was not quasi-static [s]
  double largest_ratio = 0, largest_time = 0;  ///< of kinetic over elastic energy, and when [1, s]
  double damping_share = 0, damping_time = 0;  ///< of the contact forces, when it first was too much [1, s]

  double last_look = unset;  ///< of the guards at the contacts [s]

  static constexpr std::size_t size = 6;
  static RunWatch from(std::span<const double>);
  std::array<double, size> numbers() const;

  /// Keeps the first share of the dampers in the forces of loose contacts that is above 1 %.
  void note_damping(double share, double time);
  /// With what the guards have seen since.
  RunWatch and_then(const Guards&) const;
  /// In words; `time` is how far the process has come [s].
  std::vector<std::string> warnings(const IntegrationSettings&, double time) const;
};

}  // namespace densify::dem
