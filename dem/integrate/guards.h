#pragma once
// Guards: what ends a run that is no longer sound, and what warns of one that is no longer quasi-static.  Always on,
// and looked at every few dozen steps (at each one without inertia).  They read the state and never change it.

#include <array>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "dem/state/particles.h"

namespace densify::dem {

struct EnergySums;
class NearList;
class PairTable;
struct Setup;
struct State;

enum class Guarding : std::uint8_t {
  on,
  off  ///< for who measures an instability: only what cannot go on at all still ends a run
};

/// Where a warning or a stop begins.
struct GuardSettings {
  Guarding guarding = Guarding::on;
  double largest_overlap = 1.5;  ///< over the smaller radius: two spheres deeper in each other end a run
  double quasi_static_ratio =
      1;  ///< kinetic over elastic energy of a loaded specimen above which it is not quasi-static
};

/// What the guards look at: a state with its forces, before it moves on.
struct GuardView {
  const Setup& setup;
  const State& state;
  const PairTable& table;
  const NearList& near;
  double pressure;     ///< on the punch [Pa]
  double growth_rate;  ///< largest relative growth of the radii by heat, since the last pass [1/s]
};

class Guards {
 public:
  static constexpr std::uint64_t particle_interval = 32;  ///< steps between two looks at all particles
  static constexpr std::uint64_t contact_interval = 128;  ///< and at all contacts

  /// Looks when it is time to, by the number of the step.  Throws RunError with the cause, the particle and its deepest
  /// contact.
  void look(const GuardView& view);
  /// Looks at particles and overlaps at once, whatever the step: before a row or a checkpoint is written.
  void require_sound(const GuardView& view) const;
  /// Forgets what has been seen: another state took the place of the last one.
  void forget();

  /// Time of the last look at the contacts, NaN before one [s]; who resumes a run gives it back.
  double last_look() const { return time_; }
  void resume(double last_look) { time_ = last_look; }

  /// Process time for which the quasi-static criterion did not hold, so far [s].
  double not_quasi_static() const { return not_quasi_static_; }
  /// The largest kinetic over elastic energy seen in a loaded specimen, and when [1, s].
  double largest_ratio() const { return largest_ratio_; }
  double time_of_largest_ratio() const { return time_of_largest_ratio_; }

 private:
  void look_at_particles(const GuardView&) const;
  void look_at_contacts(const GuardView&);
  void require_balance(const GuardView&, const EnergySums&);

  // Of the last look at the contacts:
  bool looked_ = false;
  double time_ = std::numeric_limits<double>::quiet_NaN();  // [s]; none
  std::uint64_t steps_ = 0;
  double budget_ = 0;          // mechanical energy that there can be [J]
  double supply_rate_ = 0;     // [W]
  double drive_ = 0;           // [J]
  double pressure_ = 0;        // [Pa]
  double punch_position_ = 0;  // [m]
  std::vector<Vec3> loaded_;   // positions of the particles under a load [m]

  double not_quasi_static_ = 0, largest_ratio_ = 0, time_of_largest_ratio_ = 0;
};

/// Throws RunError when position, velocity, force or radius of a particle is not finite.
void require_finite(const State&);

}  // namespace densify::dem
