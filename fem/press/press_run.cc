#include "fem/press/press_run.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/check.h"
#include "fem/press/gathered.h"
#include "fem/press/step_refused.h"

namespace densify::fem {

namespace {

constexpr double first_share = 0.01;         // of a stage, its first step
constexpr double largest_share = 0.1;        // of a stage, any step
constexpr double least_share = 1e-3;         // of a stage: no error asks for a shorter step
constexpr double densification_scale = 0.5;  // over which the accuracy is spread
constexpr double idle_share = 0.02;          // of it, for the time that passes
constexpr double ejection_steps = 40;

}  // namespace

template <int dim>
PressRun<dim>::PressRun(PressBody<dim>& body, const Schedule& schedule, const Press& press, const StepControl& control)
    : body_(body),
      schedule_(schedule),
      press_(press),
      control_(control),
      end_(schedule.end() + press.ejection_time),
      start_temperature_(schedule.temperature(0)),
      stage_pressure_(schedule.pressure(0)) {
  row_.stage = schedule.stages().front().name;
  row_.temperature = start_temperature_;
  row_.density = body.densities();
  row_.height = body.height();
  row_.volume = body.volume();
}

template <int dim>
double PressRun<dim>::die_radius(double time) const {
  return press_.die_radius * (1 + press_.die_expansion * (schedule_.temperature(time) - start_temperature_));
}

template <int dim>
PressLoad PressRun<dim>::load_at(double time, double step) const {
  PressLoad load{step, schedule_.temperature(time), die_radius(time), std::numeric_limits<double>::infinity(),
                 schedule_.pressure(time)};
  load.moving = body_.punches();
  const std::size_t stage = schedule_.stage_at(row_.time);
  const double end = schedule_.stage_end(stage), duration = schedule_.stages()[stage].duration;
  const double share = time < end ? 1 - (end - time) / duration : 1;
  if (by_travel(stage)) {
    load.pressure.reset();
    load.punch_travel = stage_travel_ + share * (press_.travel[stage] - stage_travel_);
  } else if (stage > 0 && by_travel(stage - 1)) {  // the scheduled one has not been there
    load.pressure = stage_pressure_ + share * (schedule_.stages()[stage].end_pressure - stage_pressure_);
  }
  if (time > schedule_.end()) {  // the die goes down by the height of the body and a tenth
    const double way = 1.1 * height_at_ejection_;
    load.die_top = 1.05 * height_at_ejection_ - way * (time - schedule_.end()) / press_.ejection_time;
    load.die_rise = -way * step / press_.ejection_time;
    load.pressure = 0;
    load.moving = Punches::upper;
  }
  return load;
}

template <int dim>
double PressRun<dim>::error_of(double step, const std::vector<double>& rate) const {
  // Nothing to compare with: the square of its densification, of the order of its own error.
  if (step_ == 0) return mean(rate, [&](std::size_t, double r) { return std::pow(r * step, 2); });
  const double slope_step = 0.5 * (step_ + step_before_);
  const bool carried_on = step_before_ > 0;
  const double ahead = carried_on ? 0.5 * (step + step_) / slope_step : 0;
  const double share = carried_on ? control_.error_share : 0.5;
  return std::sqrt(mean(rate, [&](std::size_t k, double r) {
    const double expected = rate_[k] + (carried_on ? ahead * (rate_[k] - rate_before_[k]) : 0);
    return std::pow((r - expected) * step * share, 2);
  }));
}

template <int dim>
double PressRun<dim>::mean(const std::vector<double>& values,
                           const std::function<double(std::size_t, double)>& of) const {
  double total = 0, all = 0;
  for (std::size_t k = 0; k < values.size(); ++k)
    total += body_.weights()[k] * of(k, values[k]), all += body_.weights()[k];
  return dealii::Utilities::MPI::sum(total, body_.comm()) / dealii::Utilities::MPI::sum(all, body_.comm());
}

template <int dim>
PressMemory PressRun<dim>::memory() const {
  return {row_,
          next_,
          step_,
          step_before_,
          height_at_ejection_,
          stage_travel_,
          stage_pressure_,
          gathered(rate_, body_.comm()),
          gathered(rate_before_, body_.comm())};
}

template <int dim>
void PressRun<dim>::restore(const PressMemory& m) {
  row_ = m.row;
  next_ = m.next, step_ = m.step, step_before_ = m.step_before, height_at_ejection_ = m.height_at_ejection;
  stage_travel_ = m.stage_travel, stage_pressure_ = m.stage_pressure;
  rate_ = own_part(m.rate, body_.weights().size(), body_.comm());
  rate_before_ = own_part(m.rate_before, body_.weights().size(), body_.comm());
}

template <int dim>
const PressRow& PressRun<dim>::advance() {
  const bool ejection = row_.time >= schedule_.end();
  const double stage_end = ejection ? end_ : schedule_.next_breakpoint(row_.time);
  const std::size_t stage = schedule_.stage_at(row_.time);
  const double length = ejection ? press_.ejection_time : schedule_.stages()[stage].duration;
  if (ejection && height_at_ejection_ == 0) height_at_ejection_ = row_.height;
  if (next_ == 0) next_ = first_share * length;
  next_ = std::min(next_, ejection ? length / ejection_steps : largest_share * length);
  double last_error = std::numeric_limits<double>::infinity();
  for (;;) {
    double step = next_;
    const double left = stage_end - row_.time;
    if (step > 0.99 * left)
      step = left;
    else if (step > 0.5 * left)
      step = 0.5 * left;
    const double time = step == left ? stage_end : row_.time + step;
    if (step < control_.smallest_step * end_)
      throw RunError("the body takes no step of " + std::to_string(step) + " s at " + std::to_string(row_.time) +
                     " s: " + row_.stage);
    const PressLoad load = load_at(time, step);
    PressOutcome outcome;
    double error = 0, allowed = 0;
    std::vector<double> rate;
    try {
      outcome = body_.try_step(load);
      rate = body_.densification();
      for (double& r : rate) r /= step;
      error = error_of(step, rate);
      const double densification = mean(rate, [&](std::size_t, double r) { return std::abs(r * step); });
      allowed =
          control_.accuracy * (densification / densification_scale + idle_share * step / end_) + body_.resolution();
    } catch (const StepRefused& refused) {
      ++row_.rejected;
      next_ = 0.4 * step;
      if (next_ < control_.smallest_step * end_)
        throw RunError(std::string(refused.what()) + ", however short the step, at " + std::to_string(row_.time) +
                       " s");
      continue;
    }
    row_.iterations += outcome.iterations;
    const double order = step_before_ > 0 ? 3 : 2;
    const double factor = error > 0 ? 0.85 * std::pow(allowed / error, 1 / order) : 2;
    // Particles that snap move at once however short the step is; in a long one there is more than that.
    const bool snapped = error > 0.9 * last_error && step <= first_share * length;
    last_error = error;
    if (error > allowed && step > least_share * length && !snapped) {
      ++row_.rejected;
      next_ = step * std::clamp(factor, 0.2, 0.8);
      continue;
    }
    const double height = row_.height, lower = body_.lower_rise();
    body_.accept();
    row_.time = time;
    row_.temperature = schedule_.temperature(std::min(time, schedule_.end()));
    row_.pressure = load.pressure ? *load.pressure : outcome.forces.punch / body_.section();
    row_.density = body_.densities();
    row_.density_error += error * row_.density.mean;
    row_.height = body_.height();
    row_.travel = load.pressure ? body_.unloaded_height() - row_.height : load.punch_travel;
    row_.volume = body_.volume();
    row_.forces = outcome.forces;
    row_.stored = outcome.stored;
    row_.dissipated += outcome.dissipated;
    row_.thermal += outcome.thermal;
    row_.slid += outcome.slid;
    const double die_growth = load.die_radius - die_radius(time - step), rise = body_.lower_rise() - lower;
    row_.work += outcome.forces.punch * (height - row_.height - rise) + outcome.forces.bottom * rise -
                 outcome.forces.wall_pressure * die_growth + outcome.forces.wall_friction * load.die_rise;
    row_.step = step;
    ++row_.steps;
    next_ = std::max(next_, step) * std::clamp(factor, 0.3, 1.6);
    if (factor < 1) next_ = std::max(next_, least_share * length);
    if (time >= stage_end) {  // what comes may be another law: begin anew
      step_ = step_before_ = 0;
      next_ = 0;
      stage_travel_ = row_.travel, stage_pressure_ = std::max(row_.pressure, 0.0);
      row_.stage = time >= end_              ? row_.stage
                   : time >= schedule_.end() ? "ejection"
                                             : schedule_.stages()[schedule_.stage_at(time)].name;
    } else {
      step_before_ = step_, step_ = step;
      rate_before_ = std::move(rate_), rate_ = std::move(rate);
    }
    return row_;
  }
}

template class PressRun<2>;
template class PressRun<3>;

}  // namespace densify::fem
