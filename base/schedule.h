#pragma once
// The process: temperature and pressure over time, linear through stages (thesis Figs 5.1 and 5.2).

#include <functional>
#include <string>
#include <vector>

namespace densify {

class Section;

/// One stage of the process; temperature and pressure run linearly from their values at its start.
struct Stage {
  std::string name;
  double duration = 0.0;         ///< [s]
  double end_temperature = 0.0;  ///< [K]
  double end_pressure = 0.0;     ///< [Pa]
};

/// T(t) and p(t) from t = 0; constant after the last stage.  A stage holds its start and not its end: at a breakpoint
/// rates and stage_at() are those of the stage that begins.
class Schedule {
 public:
  /// Start temperature [K], start pressure [Pa], stages in order.  Throws InputError on no stage, a duration that is
  /// not positive, a negative temperature or pressure, or anything not finite.
  Schedule(double start_temperature, double start_pressure, std::vector<Stage> stages);

  const std::vector<Stage>& stages() const { return stages_; }

  /// End of the last stage [s].
  double end() const { return points_.back().time; }

  /// Index of the stage at time `t` [s]; the last one from end() on.
  std::size_t stage_at(double t) const;

  /// End of a stage [s].
  double stage_end(std::size_t stage) const { return points_[stage + 1].time; }

  /// Temperature [K] at time `t` [s]; at stage_end(k) the given end_temperature bit for bit.
  double temperature(double t) const;

  /// dT/dt [K/s] to the right of `t` [s].
  double temperature_rate(double t) const;

  /// Pressure [Pa] at time `t` [s]; at stage_end(k) the given end_pressure bit for bit.
  double pressure(double t) const;

  /// dp/dt [Pa/s] to the right of `t` [s].
  double pressure_rate(double t) const;

  /// The first end of a stage later than `t` [s]; infinity from end() on.
  double next_breakpoint(double t) const;

  /// The highest temperature of the process [K].
  double peak_temperature() const;

  /// The highest pressure of the process [Pa].
  double peak_pressure() const;

 private:
  struct Point {
    double time;         // [s]
    double temperature;  // [K]
    double pressure;     // [Pa]
  };

  double value(double t, double Point::*member) const;
  double rate(double t, double Point::*member) const;

  std::vector<Stage> stages_;
  std::vector<Point> points_;  // start, then the end of each stage
};

/// Reads start_temperature, start_pressure and the [[stage]] list of a process section.  Throws InputError at the key
/// that goes back in time, leaves the duration open or gives it twice.  A visit for help returns a stand-in.
/// `also` visits each stage after its own keys, for who has more to say of it, with the pressure that the stage begins
/// with and the one that it gives itself, NaN if none [Pa].
Schedule read_schedule(Section& process,
                       const std::function<void(Section& stage, double before, double given)>& also = {});

}  // namespace densify
