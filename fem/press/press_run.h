#pragma once
// A whole pressing: the schedule's stages, then ejection, in steps that an error estimate chooses.

#include <cmath>
#include <functional>
#include <string>

#include "base/schedule.h"
#include "fem/press/press_body.h"

namespace densify::fem {

struct Press {
  double die_radius;         ///< of the bore at the start of the process [m]
  double die_expansion = 0;  ///< of the die [1/K]
  double ejection_time = 0;  ///< how long the die takes to leave the body after the process; 0: it stays [s]
  /// How far the punches have come together since the start at the end of each stage that is driven by it; NaN: driven
  /// by pressure, which goes on from the one that there is; empty: all of them are [m].
  std::vector<double> travel = {};
};

struct StepControl {
  double accuracy = 1e-3;       ///< of the relative density at the end, by the estimate
  double smallest_step = 1e-9;  ///< over the process: a step that must be shorter ends the run
  /// Error of a step over the difference of its densification from that of the two steps before carried on: 1/12 of a
  /// rule of the middle (its own error is 1/24 where the rate bends evenly).
  double error_share = 1.0 / 12;
};

/// What is known after a step, of the whole body.
struct PressRow {
  double time = 0;  ///< [s]
  std::string stage;
  double temperature = 0;  ///< [K]
  double pressure = 0;     ///< of the punches, on the unloaded section [Pa]
  Densities density{};
  double density_error = 0;                     ///< sum of the estimates of the steps
  double height = 0;                            ///< [m]
  double travel = 0;                            ///< of the punches towards each other since the start [m]
  double volume = 0;                            ///< [m^3]
  PressForces forces;                           ///< [N]
  double stored = 0;                            ///< elastic energy [J]
  double dissipated = 0;                        ///< in the body, by now [J]
  double thermal = 0;                           ///< work on the thermal strain, by now [J]
  double slid = 0;                              ///< by friction at the wall, by now [J]
  double work = 0;                              ///< of punch and die on the body, by now [J]
  double step = 0;                              ///< the last one [s]
  int steps = 0, iterations = 0, rejected = 0;  ///< by now
};

/// What the steps to come depend on besides the body.
struct PressMemory {
  PressRow row;
  double next = 0, step = 0, step_before = 0;   ///< to try, and the last two [s]
  double height_at_ejection = 0;                ///< [m]
  double stage_travel = 0, stage_pressure = 0;  ///< that the stage began with [m], [Pa]
  std::vector<double> rate, rate_before;        ///< of the points of all ranks [1/s]
};

/// Drives a body through a process.  A step's error is `error_share` of what its densification differs from that of the
/// two steps before carried on; it is to be below the share of `accuracy` that the step's densification has of 1/2, and
/// a little for time that passes.  Ends of stages are met exactly, and the estimate begins anew there.
template <int dim>
class PressRun {
 public:
  PressRun(PressBody<dim>&, const Schedule&, const Press&, const StepControl&);

  bool done() const { return row_.time >= end_; }

  /// One accepted step.  Throws RunError with the cause when no step is short enough.
  const PressRow& advance();

  const PressRow& row() const { return row_; }

  PressMemory memory() const;  ///< collective
  void restore(const PressMemory&);
  double end() const { return end_; }

 private:
  double die_radius(double time) const;
  bool by_travel(std::size_t stage) const { return !press_.travel.empty() && !std::isnan(press_.travel[stage]); }
  PressLoad load_at(double time, double step) const;
  double error_of(double step, const std::vector<double>& rate) const;
  /// Of a function of values of the owned points, by unloaded volume; collective.
  double mean(const std::vector<double>& values, const std::function<double(std::size_t, double)>& of) const;

  PressBody<dim>& body_;
  const Schedule& schedule_;
  const Press press_;
  const StepControl control_;
  const double end_, start_temperature_;
  double height_at_ejection_ = 0, stage_travel_ = 0, stage_pressure_;
  PressRow row_;
  double next_ = 0;                         // step to try [s]
  std::vector<double> rate_, rate_before_;  // d ln(density)/dt of points in the last two steps [1/s]
  double step_ = 0, step_before_ = 0;       // their lengths; 0: none since the stage began [s]
};

extern template class PressRun<2>;
extern template class PressRun<3>;

}  // namespace densify::fem
