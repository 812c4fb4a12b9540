#pragma once
// How much inertia disturbs a quasi-static process, and the step that keeps the disturbance at a wanted size.

#include <algorithm>
#include <limits>
#include <vector>

#include "base/schedule.h"
#include "dem/contact/step_stiffness.h"
#include "dem/state/cell.h"

namespace densify::dem {

/// Settings of the step control of equalised inertia.
struct StepControl {
  double measure = unset_measure;               ///< inertial number to keep; NaN: the step is fixed
  double smallest_step = 0;                     ///< [s]
  double largest_step = 0;                      ///< [s]
  double peak_pressure = 0;                     ///< of the process [Pa]
  double load_steps = 0;                        ///< that a load of the peak pressure takes while the powder is loose
  double transition = 0;                        ///< duration of activation and deactivation [s]
  double flow_step = 0;                         ///< while necks begin to flow under a stress; 0: as any other [s]
  std::vector<double> activation_temperatures;  ///< of the pairs that sinter [K]

  static constexpr double unset_measure = std::numeric_limits<double>::quiet_NaN();
};

/// What the control remembers.
struct ControlState {
  Mat3 strain_rate = Mat3::Zero();  ///< running mean over some twenty steps [1/s]
  double inertial_number = 0;
};

/// Least pressure that inertia is measured against, of the largest load of the process [Pa].
inline double pressure_floor(double peak_load) {
  return 0.01 * peak_load;
}

/// Steps between two evaluations of the inertial number.
inline constexpr std::uint64_t control_interval = 5;

/// The uniform flow v = velocity + gradient (x - centre) that fits the particles' velocities best.
struct UniformFlow {
  Vec3 centre = Vec3::Zero(), velocity = Vec3::Zero();  ///< [m], [m/s]
  Mat3 gradient = Mat3::Zero();                         ///< [1/s]
};
UniformFlow fitted_flow(const Particles&);

/// Leaves the uniform flow and a `share` of what the velocities differ from it.  A longer step brings masses that grow
/// with its square; with a share of old over new step the vibration keeps its energy instead of growing with them.
void calm(Particles&, double share);

/// Pressure that the contacts carry, sum over the particles of force times radius over three times the volume of the
/// spheres [Pa].
double contact_pressure(const Particles&, const StepStiffness&);

/// Updates the running mean of the strain rate and the inertial number I = |D| d sqrt(rho'/p) with the mean diameter d,
/// the density rho' of the masses as they move and a pressure p [Pa] (da Cruz et al., Phys. Rev. E 72 (2005) 021309).
/// D is the rate beyond the `growth` of the radii, at which a body that warms deforms like nothing [1/s].
void measure_inertia(ControlState&, const Particles&, const Cell&, double pressure, double growth);

/// The next step [s]: I goes with the step, so that the wanted number is a proportion away; the change over one
/// control_interval is limited so that steps follow each other smoothly.
double controlled_step(const StepControl&, const ControlState&, double step);

/// The load of a process at a time: the pressure on the punch, or the largest stress that drives the cell.
struct ProcessLoad {
  double size, rate;  ///< [Pa], [Pa/s]
};

/// The longest step from a time on that does justice to the schedule [s].  What is loose rearranges by jumps, as many
/// for each share of the load whatever the rate: load_steps for the peak pressure.  In any state the pressure changes
/// by at most a twentieth of itself (down to 0.002 of its peak), and a transition of the contacts (4.47-4.54) takes
/// some sixty steps.  Viscosities fall from where nothing flows to where everything does within the last thousandths of
/// an activation: there the step is at most flow_step.
double schedule_limit(const StepControl&, const Schedule&, ProcessLoad, double time, double step, bool loose);

}  // namespace densify::dem
