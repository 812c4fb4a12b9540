#pragma once
// Where the work on a periodic cell goes: what its boundary, sintering forces and heat give, and what springs store
// and dashpots, dampers, friction and motion take.

#include <array>
#include <span>

#include "dem/simulation.h"

namespace densify::dem {

/// Sums since the start of the process [J].
struct EnergySums {
  double boundary = 0;          ///< work on the cell, V sigma : L dt
  double sintering = 0;         ///< work that the sintering forces do, at the cost of surface energy
  double expansion = 0;         ///< work of thermal growth against the forces
  double stiffness = 0;         ///< what springs hold more because heat changes their stiffness
  double viscous = 0;           ///< taken by the dashpots of necks
  double damping = 0;           ///< taken by dampers
  double friction = 0;          ///< taken by friction, and stored in its springs
  double motion = 0;            ///< given to the motion of the particles relative to the cell, and to what calms it
  double stored = 0;            ///< in the normal springs now
  double stored_first = unset;  ///< at the first evaluation

  double given() const { return boundary + sintering + expansion + stiffness; }
  double taken() const { return stored - stored_first + viscous + damping + friction + motion; }
  double residual() const { return given() - taken(); }

  static constexpr std::size_t size = 10;
  std::array<double, size> numbers() const {
    return {boundary, sintering, expansion, stiffness, viscous, damping, friction, motion, stored, stored_first};
  }
  static EnergySums from(std::span<const double, size> n) {
    return {n[0], n[1], n[2], n[3], n[4], n[5], n[6], n[7], n[8], n[9]};
  }
};

/// Takes a simulation of a periodic cell without walls and loads through its steps and adds up.  A force of time n
/// counts over half of the step before and half of the step after, as the leap-frog has it; a dashpot over its step
/// with the mean force of the spring in series.
class EnergyBalance {
 public:
  /// Simulation::evaluate.
  void evaluate(Simulation&, Recording&, EnergySums&);
  /// Simulation::move, after `evaluate` with the same record.
  void move(Simulation&, const Recording&, EnergySums&);

 private:
  struct Link {
    Vec3 branch;         // at the evaluation [m]
    double growth_rate;  // thermal, of the distance at rest [m/s]
  };

  void add_contacts(const Simulation&, const Recording&, const std::vector<double>& modulus_before,
                    const std::vector<double>& expansion_before, EnergySums&);
  void add_half(const Simulation&, const Recording&, double step, EnergySums&) const;

  std::vector<NeckHistory> neck_before_;
  std::vector<Link> link_;  // of the list
};

}  // namespace densify::dem
