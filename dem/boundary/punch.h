#pragma once
// The load-controlled punch: a plane with a fictitious mass and a damper of its own.

#include <cmath>
#include <numbers>

#include "dem/boundary/tracking_mean.h"

namespace densify::dem {

struct PunchSettings {
  double mass_fraction = 0.002;  ///< fictitious mass over the scaled mass of the powder, at least one particle's mean
  double damping_ratio = 0.1;    ///< of the critical damping against its contacts' stiffness
};

/// m dv/dt = F_powder - p A - c (v - v_mean).  The damper acts against a running mean of the velocity over two
/// periods that follows a steady acceleration without lag (a critically damped second-order filter), so that it stills
/// vibration and takes no share of the load while the powder densifies.
struct Punch {
  double mass = 0;               ///< 0 = no moving punch [kg]
  double area = 0;               ///< A [m^2]
  double damping = 0;            ///< c [N s/m]
  double memory = 0;             ///< time constant of the running mean [s]
  double velocity = 0;           ///< outward positive [m/s]
  double mean_velocity = 0;      ///< [m/s]
  double mean_acceleration = 0;  ///< [m/s^2]

  /// New stiffness sum of the contacts [N/m]; without any contact the last damper stays.
  void tune(double stiffness, double damping_ratio) {
    if (stiffness <= 0) return;
    damping = 2 * damping_ratio * std::sqrt(mass * stiffness);
    constexpr double periods = 2;
    memory = periods * 2 * std::numbers::pi * std::sqrt(mass / stiffness);
  }

  /// Leap-frog kick under the powder's outward force and the applied pressure [N, Pa, s].
  void kick(double powder_force, double pressure, double step) {
    // Without contact there is no vibration to still, and a mean that runs ahead would drive the punch.
    const double damper = powder_force != 0 ? damping * (velocity - mean_velocity) : 0.0;
    velocity += (powder_force - pressure * area - damper) / mass * step;
    if (memory <= 0) return;
    follow(velocity, memory, step, mean_velocity, mean_acceleration);
  }
};

}  // namespace densify::dem
