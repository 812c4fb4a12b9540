// The length of a simulation's next step, and the masses that follow from it.

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "base/check.h"
#include "dem/simulation.h"

namespace densify::dem {

namespace {

std::string seconds(double t) {
  char text[32];
  std::snprintf(text, sizeof text, "%.4g s", t);
  return text;
}

}  // namespace

StepControl step_control(const IntegrationSettings& settings, const Schedule& schedule) {
  constexpr double share_of_process = 1e-3, largest_share = 2.5e-3, share_per_accuracy = 0.27, span = 160;
  StepControl c;
  const double share = std::isnan(settings.accuracy) ? share_of_process
                                                     : std::min(largest_share, share_per_accuracy * settings.accuracy);
  c.measure = settings.inertia_measure;
  c.largest_step = std::isnan(settings.largest_step) ? share * schedule.end() : settings.largest_step;
  c.smallest_step = std::isnan(settings.smallest_step) ? c.largest_step / span : settings.smallest_step;
  c.load_steps = settings.load_steps;
  c.peak_pressure = schedule.peak_pressure();
  return c;
}

void choose_settings(IntegrationSettings& s, double accuracy) {
  s.accuracy = accuracy;
  s.inertia = Inertia::equalised;
  s.inertia_measure = 5.0 / 3 * accuracy;
  s.load_steps = 7.5 / accuracy;
  s.skin = 0.8;
}

StepLimit Simulation::step_limit() {
  const PunchNode punch{state_.punch.mass, state_.punch.damping, punch_wall_.value_or(0)};
  const auto limit = [&](const PassPairs& pairs) {
    StepLimit l =
        critical_step(state_.particles, state_.contacts, pairs, state_.cell, table_, setup_.contact, state_.walls,
                      punch, {state_.time, state_.last_step}, setup_.integration.rule, setup_.integration.threads);
    if (stress_driven()) l.critical /= 1 + cell_share();  // room for the cell's own motion
    return l;
  };
  if (!pass_.near().empty() && may_have_travelled_ < pass_.near().skin())
    return limit({pass_.near(), pass_.chunks(), pores()});
  NearList all;
  all.take_all(state_.contacts);
  Chunks chunks;
  chunks.build(state_.contacts, all, state_.particles.size(), setup_.integration.threads);
  return limit({all, chunks, pores()});
}

void Simulation::require_stable_step() {
  const double fixed = setup_.integration.fixed_step;
  if (equalised()) return;
  const StepLimit limit = step_limit();
  constexpr double most_steps = 1e14;  // years, even of two spheres at a tenth of a microsecond a step
  const double step = std::isnan(fixed) ? setup_.integration.step_safety * limit.critical : fixed;
  const bool explicit_steps = setup_.integration.method != IntegrationMethod::inertia_free;
  if (explicit_steps && !((setup_.schedule.end() - state_.time) / step < most_steps))
    throw InputError("integration.mass_scaling: the process of " + seconds(setup_.schedule.end()) +
                     " would take more than 1e14 steps of " + seconds(step) +
                     "; use a larger mass_scaling, or a shorter process");
  if (fixed > limit.critical)
    throw InputError("integration.fixed_step: " + seconds(fixed) + " is above the stability limit of " +
                     seconds(limit.critical) + " (particle " + std::to_string(state_.particles.id[limit.particle]) +
                     "); use a smaller one, a larger mass_scaling, or leave it out");
}

double Simulation::choose_step() {
  const auto& settings = setup_.integration;
  // The viscosity of a young neck grows as a^4, by orders of magnitude in a few steps: its limit m/eta follows at once.
  const bool dashpots = setup_.contact.sintering && setup_.contact.sintering->model == SinteringModel::viscous &&
                        !state_.contacts.neck.empty() && std::isnan(settings.fixed_step);
  // A punch that strikes presses Hertz springs by a tenth of a radius within an interval, and stiffens them as much.
  const double mean_radius = state_.contacts.skin / settings.skin;
  constexpr double striking = 3e-3;  // of the mean radius in a step
  const bool strikes = std::abs(state_.punch.velocity) * state_.last_step > striking * mean_radius;
  const std::uint64_t interval = dashpots || strikes ? 1 : std::uint64_t(settings.limit_interval);
  if (state_.steps % interval == 0 || state_.stable_step == 0) {
    const StepLimit limit = step_limit();
    state_.critical_step = limit.critical;
    if (settings.fixed_step > limit.critical && settings.guards.guarding == Guarding::on)
      throw RunError("integration.fixed_step of " + seconds(settings.fixed_step) +
                     " has come above the stability limit of " + seconds(limit.critical) + " (particle " +
                     std::to_string(state_.particles.id[limit.particle]) + "); use a smaller one, or leave it out");
    state_.stable_step = settings.step_safety * limit.critical;
    if (!std::isnan(settings.fixed_step)) state_.stable_step = settings.fixed_step;
    if (!std::isnan(settings.largest_step)) state_.stable_step = std::min(state_.stable_step, settings.largest_step);
    if (stress_driven()) weigh_cell(limit.cell, state_.stable_step);
    if (state_.punch.mass > 0) state_.punch.tune(limit.punch_stiffness, setup_.container.punch_settings.damping_ratio);
  }
  double step = state_.stable_step;
  if (stress_driven() && std::isnan(settings.fixed_step)) step = std::min(step, cell_leap());
  if (state_.punch.mass > 0 && std::isnan(settings.fixed_step)) {
    // A jump of the pressure must not throw the punch into the powder between two looks at its contacts.
    constexpr double leap = 0.01;  // of the mean radius, from rest in a step
    const double force = state_.walls.normal_force()[*punch_wall_] - pressure() * state_.punch.area;
    step = std::min(step, std::sqrt(leap * mean_radius * state_.punch.mass / std::abs(force)));
  }
  // Breakpoints of the schedule are met exactly; the last two steps before one share the way.
  const double left = setup_.schedule.next_breakpoint(state_.time) - state_.time;
  if (left <= step) return left;
  return left < 2 * step ? 0.5 * left : step;
}

void Simulation::plan_equalised_step() {
  const auto& settings = setup_.integration;
  if (state_.stable_step == 0) {
    state_.stable_step = std::isnan(settings.fixed_step) ? control_.smallest_step : settings.fixed_step;
    // The first pass needs masses for its dampers.
    stiffness_.next_step = state_.stable_step;
    stiffness_.of.assign(state_.particles.size(), StiffnessSum{});
    equalise(state_.particles, stiffness_, setup_.contact, table_, settings.step_safety, 0, settings.threads);
  }
  if (std::isnan(settings.fixed_step))
    state_.stable_step = std::min(state_.stable_step, schedule_limit(control_, setup_.schedule, load(), state_.time,
                                                                     state_.stable_step, state_.contacts.neck.empty()));
  state_.critical_step = state_.stable_step / settings.step_safety;
  // Breakpoints of the schedule are met exactly: the last steps before one share the way.
  constexpr double sharing = 10;
  const double left = setup_.schedule.next_breakpoint(state_.time) - state_.time;
  const double steps = std::max(1.0, std::ceil(left / state_.stable_step * (1 - 1e-12)));
  stiffness_.next_step = steps <= sharing ? left / steps : state_.stable_step;
}

Column Simulation::column() const {
  const double bottom = state_.walls.wall[*wall("bottom")].point[2];
  return {bottom, state_.walls.wall[*punch_wall_].point[2] - bottom};
}

void Simulation::equalise_inertia() {
  const auto& settings = setup_.integration;
  if (state_.last_step > 0 && stiffness_.next_step > state_.last_step * (1 + 1e-9))
    calm(state_.particles, state_.last_step / stiffness_.next_step);
  const bool pressed = state_.punch.mass > 0;
  equalise(state_.particles, stiffness_, setup_.contact, table_, settings.step_safety,
           pressed           ? carriage_share
           : stress_driven() ? cell_share()
                             : 0.0,
           settings.threads);
  if (pressed) equalise_punch();
  if (stress_driven()) weigh_cell(equalised_cell_stiffness(), stiffness_.next_step);
  if (state_.steps % control_interval != 0) return;
  const double pressure =
      std::max(contact_pressure(state_.particles, stiffness_), pressure_floor(control_.peak_pressure));
  double growth = 0;  // mean over the materials
  if (state_.last_step > 0)
    for (const double e : expansion_step_) growth += e / state_.last_step / double(expansion_step_.size());
  measure_inertia(state_.control, state_.particles, state_.cell, pressure, growth);
  if (std::isnan(settings.fixed_step))
    state_.stable_step = controlled_step(control_, state_.control, state_.stable_step);
}

void Simulation::equalise_punch() {
  const double step = stiffness_.next_step, safety = setup_.integration.step_safety;
  column_mass_ = column_mass(state_.particles, column());
  // Ready for two first contacts with particles of mean size.
  const double mean_radius = state_.contacts.skin / setup_.integration.skin;
  double contacts = state_.walls.step_stiffness()[*punch_wall_];
  for (std::uint8_t m = 0; m < table_.materials(); ++m)
    contacts =
        std::max(contacts, 2 * first_contact_stiffness(setup_.contact, table_.row(m, m), mean_radius, step, safety));
  state_.punch.mass = mass_for_step((1 + carriage_share) * contacts, step, safety);
}

void Simulation::refuse_idle_step(double step) const {
  throw RunError("the step of " + seconds(step) + " no longer moves the process time of " + seconds(state_.time) +
                 " on; the contacts have become too stiff or the masses too small, try a larger mass_scaling");
}

}  // namespace densify::dem
