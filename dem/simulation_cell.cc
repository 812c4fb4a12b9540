// The cell of a simulation that the process drives.

#include <algorithm>
#include <cmath>

#include "base/check.h"
#include "dem/simulation.h"

namespace densify::dem {

namespace {

constexpr double leap = 0.005;  // strain of a step in which a cell at rest is let go

/// Of the stresses that drive a cell now, what the largest is off its goal [Pa].
double largest_excess(const Simulation& sim) {
  const Setup& setup = sim.setup();
  const std::size_t stage = setup.schedule.stage_at(sim.state().time);
  double excess = 0;
  for (std::size_t c = 0; c < 6; ++c) {
    if (setup.cell_path->stages[stage][c].control != CellControl::stress) continue;
    const auto [i, j] = tensor_places[c];
    excess = std::max(excess, std::abs(sim.cell_goal(c).value - sim.cell_stress()(i, j)));
  }
  return excess;
}

}  // namespace

CellGoal Simulation::cell_goal(std::size_t component) const {
  const CellPath& path = *setup_.cell_path;
  const Schedule& schedule = setup_.schedule;
  return {path.stages[schedule.stage_at(state_.time)][component].control,
          goal(path, schedule, state_.cell_drive, component, state_.time)};
}

double Simulation::pressure() const {
  if (!stress_driven()) return setup_.schedule.pressure(state_.time);
  double sum = 0;
  for (std::size_t c = 0; c < 3; ++c) {
    const CellGoal now = cell_goal(c);
    if (now.control != CellControl::stress) return unset;
    sum -= now.value;
  }
  return sum / 3;
}

double Simulation::peak_load() const {
  return stress_driven() ? setup_.cell_path->peak_stress() : setup_.schedule.peak_pressure();
}

ProcessLoad Simulation::load() const {
  const Schedule& schedule = setup_.schedule;
  if (!stress_driven()) return {pressure(), std::abs(schedule.pressure_rate(state_.time))};
  ProcessLoad load{0, 0};
  const double t = state_.time, end = schedule.next_breakpoint(t);
  for (std::size_t c = 0; c < 6; ++c) {
    const CellGoal now = cell_goal(c);
    if (now.control != CellControl::stress) continue;
    load.size = std::max(load.size, std::abs(now.value));
    if (!std::isfinite(end)) continue;
    const double later = setup_.cell_path->stages[schedule.stage_at(t)][c].value;
    load.rate = std::max(load.rate, std::abs(later - now.value) / (end - t));
  }
  return load;
}

/// From the pass just done and the masses that follow from it; in one order for every number of threads.
CellStiffness Simulation::equalised_cell_stiffness() const {
  CellStiffness cell;
  double sum = 0;
  for (std::size_t p = 0; p < state_.particles.size(); ++p) {
    const Body& b = state_.particles.body[p];
    const double square = b.radius * b.radius;
    cell.stiffness.add(stiffness_.of[p], 2 * square);
    sum += square / b.inverse_mass;
  }
  const double at_limit = stiffness_.next_step / setup_.integration.step_safety;
  cell.ready_stiffness = 4 * sum / ((1 + cell_share()) * at_limit * at_limit);
  return cell;
}

void Simulation::weigh_cell(CellStiffness sums, double step) {
  // With friction a contact may be stiffer across than along its normal.
  const double across =
      setup_.contact.friction ? std::max(1.0, setup_.contact.friction->tangential_stiffness_ratio) : 1.0;
  if (across > 1) {
    const CellStiffness once = sums;
    sums.stiffness.add(once.stiffness, across - 1);
    sums.damping.add(once.damping, across - 1);
  }
  weigh(state_.cell_drive, sums, cell_share(), step, setup_.integration.step_safety);
  if (!equalised()) return;
  // Contacts that flow at once leave their load to a cell that hardly anything holds: it must not be thrown.
  CellDrive& drive = state_.cell_drive;
  const double heavier = state_.cell.volume() * largest_excess(*this) * step * step / (leap * drive.mass);
  if (!(heavier > 1)) return;
  drive.mass *= heavier;
  drive.damping *= std::sqrt(heavier);
  drive.memory *= std::sqrt(heavier);
}

/// e of `weigh`.  Where masses follow from the step, 1.5 makes the cell 6.6 times lighter for particles of 2.3 times
/// the mass, and the stress follows its goal the better.  Real masses would pay for it with shorter steps; with
/// friction the heavier particles would slide further than a balance of energy within 1 % allows.
double Simulation::cell_share() const {
  constexpr double light_cell = 1.5;
  return equalised() && !setup_.contact.friction ? light_cell : carriage_share;
}

/// The step in which a cell at rest strains by a small share: a jump of a stress must not throw it. [s]
double Simulation::cell_leap() const {
  return std::sqrt(leap * state_.cell_drive.mass / (state_.cell.volume() * largest_excess(*this)));
}

CellAnswer Simulation::strain(CellStretch stretch) {
  if (!state_.cell.periodic || setup_.cell_path || setup_.integration.inertia_free.from != InertiaFreeFrom::start ||
      setup_.integration.method != IntegrationMethod::inertia_free)
    throw std::logic_error("Simulation::strain needs a free periodic cell without inertia from the start");
  strained_from_ = state_.time;
  int steps = 0;
  double error = 0;
  while (state_.time < stretch.end) {
    if (!evaluated_) evaluate(nullptr);
    move(&stretch);
    error += inertia_free_.error();
    ++steps;
    stretch.guess = nullptr;
  }
  CellAnswer answer = inertia_free_.answer();
  answer.error = error;
  answer.steps = steps;
  return answer;
}

void Simulation::drive_cell(LeapfrogSteps steps) {
  constexpr double furthest = 0.05;  // strain of one step
  constexpr double apart = 1.05;     // of the volume at which particles touched last
  const double volume = state_.cell.volume();
  if (!cell_stress_.isZero(0) || std::isnan(touching_volume_)) touching_volume_ = volume;
  if (stress_driven() && setup_.cell_path->by_stress(setup_.schedule.stage_at(state_.time)) &&
      volume > apart * touching_volume_)
    throw RunError("no two particles touch, and the cell has grown by " +
                   std::to_string(100 * (volume / touching_volume_ - 1)) +
                   " % since: nothing brings it back; keep some pressure on loose grains, or let necks form before it "
                   "is taken away");
  kick(state_.cell_drive, state_.cell, *setup_.cell_path, setup_.schedule, state_.time, cell_stress_, steps.kick,
       steps.drift);
  const double strain = steps.drift * state_.cell.velocity_gradient.norm();
  if (!(strain < furthest))
    throw RunError("the cell deforms by " + std::to_string(strain) +
                   " in one step; the rates are too fast for the step, or nothing resists the stress that drives it");
}

}  // namespace densify::dem
