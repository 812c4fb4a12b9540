#include "dem/boundary/cell_drive.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "dem/boundary/tracking_mean.h"

namespace densify::dem {

namespace {

const CellGoal& goal_before(const CellPath& path, std::size_t stage, std::size_t component) {
  return stage == 0 ? path.start[component] : path.stages[stage - 1][component];
}

bool comes_under_control(const CellPath& path, std::size_t stage, std::size_t component) {
  const CellGoal& before = goal_before(path, stage, component);
  return path.stages[stage][component].control == CellControl::stress &&
         (before.control == CellControl::rate || std::isnan(before.value));
}

}  // namespace

bool CellPath::by_stress(std::size_t stage) const {
  return std::any_of(stages[stage].begin(), stages[stage].end(),
                     [](const CellGoal& g) { return g.control == CellControl::stress; });
}

bool CellPath::by_stress() const {
  for (std::size_t s = 0; s < stages.size(); ++s)
    if (by_stress(s)) return true;
  return false;
}

double CellPath::peak_stress() const {
  double peak = 0;
  const auto look = [&](const CellGoals& goals) {
    for (const CellGoal& g : goals)
      if (g.control == CellControl::stress && !std::isnan(g.value)) peak = std::max(peak, std::abs(g.value));
  };
  look(start);
  for (const CellGoals& goals : stages) look(goals);
  return peak;
}

double goal(const CellPath& path, const Schedule& schedule, const CellDrive& drive, std::size_t component,
            double time) {
  const std::size_t stage = schedule.stage_at(time);
  const CellGoal& end = path.stages[stage][component];
  const CellGoal& before = goal_before(path, stage, component);
  double from = before.value;
  if (comes_under_control(path, stage, component))
    from = drive.found[component];
  else if (before.control != end.control)
    from = end.value;
  const double finish = schedule.stage_end(stage), begin = stage == 0 ? 0.0 : schedule.stage_end(stage - 1);
  if (time >= finish) return end.value;
  return from + (end.value - from) * ((time - begin) / (finish - begin));
}

void enter_stage(CellDrive& drive, const CellPath& path, const Schedule& schedule, double time, const Mat3& stress) {
  const std::size_t stage = schedule.stage_at(time);
  if (drive.stage == stage) return;
  drive.stage = stage;
  for (std::size_t c = 0; c < 6; ++c)
    if (comes_under_control(path, stage, c)) drive.found[c] = stress(tensor_places[c][0], tensor_places[c][1]);
}

void weigh(CellDrive& drive, const CellStiffness& sums, double share, double step, double safety) {
  constexpr double damping_ratio = 0.3, periods = 0.5, ready_share = 0.05;
  const double own = sums.stiffness.largest_eigenvalue(), at_limit = step / safety;
  const double k = std::max(own, ready_share * sums.ready_stiffness),
               c = std::max(sums.damping.largest_eigenvalue(), ready_share * sums.ready_damping);
  const double least = (1 + 1 / share) * (0.25 * at_limit * at_limit * k + 0.5 * at_limit * c);
  const double frequency = std::sqrt((own > 0 ? own : k) / least);
  drive.mass = least * (1 + damping_ratio * frequency * step);  // the cell's own damper takes its share of the limit
  drive.damping = 2 * damping_ratio * frequency * drive.mass;
  drive.memory = periods * 2 * std::numbers::pi / frequency;
}

void kick(CellDrive& drive, Cell& cell, const CellPath& path, const Schedule& schedule, double time, const Mat3& stress,
          double kick_step, double step) {
  const std::size_t stage = schedule.stage_at(time);
  const double volume = cell.volume();
  // Without contact there is no vibration to still, and a mean that runs ahead would drive the cell.
  const double damping = stress.isZero(0) ? 0.0 : drive.damping;
  for (std::size_t c = 0; c < 6; ++c) {
    const auto [i, j] = tensor_places[c];
    double& rate = cell.velocity_gradient(i, j);
    if (path.stages[stage][c].control == CellControl::rate) {
      rate = goal(path, schedule, drive, c, time + 0.5 * step);
      drive.mean[c] = rate;
      drive.slope[c] = 0;
      continue;
    }
    const double shear = i == j ? 1 : 2;  // L_xy = 2 D_xy
    const double power = shear * volume * (goal(path, schedule, drive, c, time) - stress(i, j));
    rate += kick_step / drive.mass * (power - damping * (rate - drive.mean[c]));
    follow(rate, drive.memory, kick_step, drive.mean[c], drive.slope[c]);
  }
  drive.deformation += step * cell.velocity_gradient * drive.deformation;
}

}  // namespace densify::dem
