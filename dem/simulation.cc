#include "dem/simulation.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "base/check.h"
#include "dem/integrate/leapfrog.h"

namespace densify::dem {

namespace {

std::vector<Wall> make_walls(const Container& c) {
  std::vector<Wall> walls;
  auto plane = [&](const char* name, const Vec3& point, const Vec3& normal) {
    walls.push_back({name, WallShape::plane, point, normal, 0, Vec3::Zero(), 0});
  };
  switch (c.shape) {
    case ContainerShape::cylinder:
      walls.push_back({"die", WallShape::cylinder, Vec3::Zero(), Vec3::UnitZ(), 0.5 * c.size[0], Vec3::Zero(), 0});
      plane("bottom", Vec3::Zero(), Vec3::UnitZ());
      plane("punch", Vec3(0, 0, c.size[2]), -Vec3::UnitZ());
      break;
    case ContainerShape::box:
      plane("wall x-", Vec3::Zero(), Vec3::UnitX());
      plane("wall x+", Vec3(c.size[0], 0, 0), -Vec3::UnitX());
      plane("wall y-", Vec3::Zero(), Vec3::UnitY());
      plane("wall y+", Vec3(0, c.size[1], 0), -Vec3::UnitY());
      plane("bottom", Vec3::Zero(), Vec3::UnitZ());
      plane("punch", Vec3(0, 0, c.size[2]), -Vec3::UnitZ());
      break;
    default:
      break;
  }
  return walls;
}

/// The lowest 21 bits of x, each followed by two zeros.
std::uint64_t spread(std::uint64_t x) {
  x &= 0x1fffff;
  x = (x | x << 32) & 0x1f00000000ffff;
  x = (x | x << 16) & 0x1f0000ff0000ff;
  x = (x | x << 8) & 0x100f00f00f00f00f;
  x = (x | x << 4) & 0x10c30c30c30c30c3;
  return (x | x << 2) & 0x1249249249249249;
}

/// Order of the particles along a Morton curve through cells of about one particle, so that neighbours are near in
/// memory and a range of particles is compact in space.
std::vector<std::uint32_t> spatial_order(const Particles& particles) {
  Vec3 low = Vec3::Constant(1e300), high = Vec3::Constant(-1e300);
  double mean = 0;
  for (std::size_t p = 0; p < particles.size(); ++p) {
    low = low.cwiseMin(particles.body[p].position);
    high = high.cwiseMax(particles.body[p].position);
    mean += particles.reference_radius[p] / double(particles.size());
  }
  const Vec3 span = (high - low).cwiseMax(mean);
  const double edge = std::max(2 * mean, span.maxCoeff() / 1e6);
  auto cell_of = [&](std::uint32_t p) {
    const Vec3 s = (particles.body[p].position - low) / edge;
    return spread(std::uint64_t(s[2])) << 2 | spread(std::uint64_t(s[1])) << 1 | spread(std::uint64_t(s[0]));
  };
  std::vector<std::pair<std::uint64_t, std::uint32_t>> keyed(particles.size());
  for (std::uint32_t p = 0; p < keyed.size(); ++p) keyed[p] = {cell_of(p), p};
  std::sort(keyed.begin(), keyed.end());
  std::vector<std::uint32_t> order(keyed.size());
  for (std::size_t p = 0; p < order.size(); ++p) order[p] = keyed[p].second;
  return order;
}

template <class T>
void permute(std::vector<T>& values, const std::vector<std::uint32_t>& order) {
  if (values.empty()) return;
  std::vector<T> sorted(values.size());
  for (std::size_t p = 0; p < order.size(); ++p) sorted[p] = values[order[p]];
  values = std::move(sorted);
}

bool activation_has_begun(const PairTable& table) {
  for (std::uint8_t a = 0; a < table.materials(); ++a)
    for (std::uint8_t b = a; b < table.materials(); ++b)
      if (table.row(a, b).activation_step) return true;
  return false;
}

std::string seconds(double t) {
  char text[32];
  std::snprintf(text, sizeof text, "%.4g s", t);
  return text;
}

double sphere_volume(double r) {
  return 4.0 / 3 * M_PI * r * r * r;
}

}  // namespace

StepControl step_control(const IntegrationSettings& settings, const Schedule& schedule) {
  constexpr double share_of_process = 1e-3, span = 20, share_of_peak = 0.01;
  StepControl c;
  c.measure = settings.inertia_measure;
  c.largest_step = std::isnan(settings.largest_step) ? share_of_process * schedule.end() : settings.largest_step;
  c.smallest_step = std::isnan(settings.smallest_step) ? c.largest_step / span : settings.smallest_step;
  for (const Stage& stage : schedule.stages())
    c.pressure_floor = std::max(c.pressure_floor, share_of_peak * stage.end_pressure);
  return c;
}

Simulation::Simulation(Setup setup)
    : setup_(std::move(setup)),
      table_(setup_.materials, setup_.interfaces, setup_.contact),
      pass_(setup_.contact, setup_.integration.threads) {
  if (setup_.particles.size() == 0)
    throw InputError("powder: no particles (the powder is empty); give a number of at least 1");
  if (setup_.integration.method == IntegrationMethod::inertia_free && setup_.contact.friction)
    throw InputError(
        "integration.method: \"inertia_free\" has no rotations, which [contact.friction] needs; remove one");
  Particles& particles = setup_.particles;
  const auto order = spatial_order(particles);
  permute(particles.body, order);
  permute(particles.reference_radius, order);
  permute(particles.material, order);
  permute(particles.id, order);
  permute(particles.angular_velocity, order);
  for (auto& load : setup_.loads) {
    const auto found = std::find(particles.id.begin(), particles.id.end(), load.particle);
    if (found == particles.id.end())
      throw InputError("load: particle " + std::to_string(load.particle) + " does not exist; the specimen has " +
                       std::to_string(particles.size()) + ", counted from 0");
    load.particle = std::uint32_t(found - particles.id.begin());
  }

  const std::size_t n = particles.size();
  particles.force.assign(n, Vec3::Zero());
  if (setup_.contact.friction) {
    particles.angular_velocity.resize(n, Vec3::Zero());
    particles.torque.assign(n, Vec3::Zero());
  } else {
    particles.angular_velocity.clear();
  }
  double mean_radius = 0, powder_mass = 0;
  for (std::size_t p = 0; p < n; ++p) {
    const double mass = setup_.materials[particles.material[p]].density * sphere_volume(particles.reference_radius[p]);
    particles.body[p].inverse_mass = 1 / (setup_.integration.mass_scaling * mass);
    particles.body[p].radius = particles.reference_radius[p];
    mean_radius += particles.reference_radius[p] / double(n);
    powder_mass += mass;
  }
  state_.particles = std::move(setup_.particles);
  setup_.particles = Particles{};
  state_.cell = setup_.cell;
  state_.contacts.skin = setup_.integration.skin * mean_radius;
  state_.expansion.assign(setup_.materials.size(), 1.0);
  expansion_step_.assign(setup_.materials.size(), 0.0);
  state_.walls = Walls(make_walls(setup_.container), setup_.container.material);
  punch_wall_ = wall("punch");
  if (punch_wall_ && setup_.container.punch) {
    const double fraction = std::max(setup_.container.punch_settings.mass_fraction, 1 / double(n));
    state_.punch.mass = fraction * setup_.integration.mass_scaling * powder_mass;
    state_.punch.area = punch_area();
  }
  if (equalised()) control_ = step_control(setup_.integration, setup_.schedule);
  Vec3 unused;
  for (const auto& w : state_.walls.wall)
    for (std::size_t p = 0; p < n; ++p)
      if (Walls::gap(w, state_.particles.body[p].position, unused) < 0)
        throw InputError("specimen: particle " + std::to_string(state_.particles.id[p]) +
                         " lies outside the container (" + w.name + "); move it inside or enlarge the container");
  set_environment();
  rebuild_lists();
}

std::optional<std::size_t> Simulation::wall(std::string_view name) const {
  for (std::size_t w = 0; w < state_.walls.wall.size(); ++w)
    if (state_.walls.wall[w].name == name) return w;
  return std::nullopt;
}

double Simulation::punch_area() const {
  const auto& walls = state_.walls.wall;
  if (const auto die = wall("die")) return M_PI * walls[*die].radius * walls[*die].radius;
  const auto x = wall("wall x+"), y = wall("wall y+");
  if (!x || !y) return 0;
  return (walls[*x].point[0] - walls[*wall("wall x-")].point[0]) *
         (walls[*y].point[1] - walls[*wall("wall y-")].point[1]);
}

double Simulation::real_mass(std::size_t p) const {
  const Particles& particles = state_.particles;
  if (equalised())
    return setup_.materials[particles.material[p]].density * sphere_volume(particles.reference_radius[p]);
  const double scaling = state_.inertia_free ? 1.0 : setup_.integration.mass_scaling;
  return 1 / (particles.body[p].inverse_mass * scaling);
}

double Simulation::solid_volume() const {
  double v = 0;
  for (double r : state_.particles.reference_radius) v += sphere_volume(r);
  return v;
}

void Simulation::set_environment() {
  const double t = temperature();
  std::fill(expansion_step_.begin(), expansion_step_.end(), 0.0);
  // At constant temperature only the clock of an activation that has just begun still matters.
  const bool changed = t != state_.temperature;
  for (auto& w : state_.walls.wall) w.thermal_rate = 0;
  if (changed || table_unsettled_) {
    table_.update(t, state_.time);
    state_.active_since = table_.active_since();
    table_unsettled_ = setup_.contact.sintering && activation_has_begun(table_);
  }
  if (!changed) return;
  const double dt = t - setup_.reference_temperature;
  const double old_dt = std::isnan(state_.temperature) ? 0.0 : state_.temperature - setup_.reference_temperature;
  bool grows = false;
  for (std::size_t m = 0; m < setup_.materials.size(); ++m) {
    const double e = 1 + setup_.materials[m].thermal_expansion * dt;
    // The first environment sets the radii of the given specimen; growth counts from there.
    if (!std::isnan(state_.temperature)) expansion_step_[m] = (e - state_.expansion[m]) / e;
    grows = grows || e != state_.expansion[m];
    state_.expansion[m] = e;
  }
  if (grows)
    for (std::size_t p = 0; p < state_.particles.size(); ++p)
      state_.particles.body[p].radius =
          state_.particles.reference_radius[p] * state_.expansion[state_.particles.material[p]];
  const double a = setup_.container.wall_expansion;
  if (a != 0) {
    const double stretch = (1 + a * dt) / (1 + a * old_dt);
    const double rate = state_.last_step > 0 ? (1 - 1 / stretch) / state_.last_step : 0.0;
    for (auto& w : state_.walls.wall) {
      if (w.shape == WallShape::cylinder)
        w.radius *= stretch;
      else if (std::abs(w.normal[2]) < 0.5)
        w.point *= stretch;  // lateral planes of a box
      else
        continue;
      w.thermal_rate = rate;
    }
    if (state_.punch.mass > 0) state_.punch.area = punch_area();
  }
  for (const double growth : expansion_step_)
    may_have_travelled_ += 1.1 * std::abs(growth) * 2 * state_.contacts.largest_radius;
  state_.temperature = t;
}

void Simulation::rebuild_lists() {
  const HistoryNeeds needs{setup_.contact.friction.has_value(),
                           setup_.contact.sintering && (table_.any_active() || !state_.contacts.neck.empty())};
  try {
    pass_.near().clear();  // room for the search
    rebuild(state_.contacts, state_.particles, state_.cell, state_.expansion, needs);
  } catch (const InputError& error) {  // a cell that has become too narrow is no mistake of the input any more
    if (state_.steps == 0) throw;
    throw RunError(error.what());
  }
  state_.walls.rebuild(state_.particles, state_.contacts.skin);
  pass_.list_changed(state_.contacts, state_.particles.size());
  prune_near(0);
}

void Simulation::keep_list_fresh() {
  const bool first_necks =
      setup_.contact.sintering && state_.contacts.neck.empty() && state_.contacts.size() > 0 && table_.any_active();
  bool rebuilding = first_necks || state_.walls.age(state_.contacts.skin) >= 1;
  // The list is rebuilt exactly when its own age says so, whatever was pruned since; the bound only spares looking.
  const bool prune = pass_.near().empty() || !(may_have_travelled_ < pass_.near().skin());
  if (!rebuilding && (prune || !(may_have_travelled_ < list_slack_))) {
    const double age =
        list_age(state_.contacts, state_.particles, state_.cell, state_.expansion, setup_.integration.threads);
    if (std::isnan(age)) require_finite(state_);
    rebuilding = age >= 1;
    if (!rebuilding && prune)
      prune_near(age);
    else if (!rebuilding)
      set_list_slack(age);
  }
  if (rebuilding) rebuild_lists();
}

/// Called after a move in which no particle was faster than `fastest` against the flow of its cell [m/s, s].
void Simulation::note_travel(double fastest, double step) {
  const double flow = state_.cell.periodic ? state_.cell.velocity_gradient.norm() : 0.0;
  const double reach = 2 * state_.contacts.largest_radius + state_.contacts.skin;
  const double above = flow > 0 ? 1.5 : 1 + 1e-9;  // strains between two prunings multiply
  may_have_travelled_ += above * step * (2 * fastest + flow * reach);
}

void Simulation::set_list_slack(double list_age) {
  constexpr double rounding = 1e-9;  // of the sum of two distances
  list_slack_ = may_have_travelled_ + (1 - list_age - rounding) * state_.contacts.skin;
}

void Simulation::prune_near(double list_age) {
  pass_.near().prune(state_.contacts, state_.particles, state_.cell);
  pass_.near_changed(state_.contacts, state_.particles.size());
  may_have_travelled_ = 0;
  set_list_slack(list_age);
}

void Simulation::compute_forces(Recording* record) {
  const PassTime clock{state_.time, state_.last_step};
  StepStiffness* const stiffness = equalised() ? &stiffness_ : nullptr;
  pass_.compute(state_.particles, state_.contacts, state_.cell, table_, expansion_step_, clock,
                record ? &record->contact : nullptr, stiffness);
  if (!state_.walls.wall.empty())
    state_.walls.compute(state_.particles, table_, setup_.contact, expansion_step_, clock,
                         record ? &record->wall : nullptr, stiffness);
  else if (record)
    record->wall.clear();
  for (const auto& load : setup_.loads) {
    const double share = load.ramp > 0 ? std::min(1.0, state_.time / load.ramp) : 1.0;
    state_.particles.force[load.particle] += share * load.force;
  }
  if (!setup_.integration.gravity.isZero(0))
    for (std::size_t p = 0; p < state_.particles.size(); ++p)
      state_.particles.force[p] += real_mass(p) * setup_.integration.gravity;
}

GuardView Simulation::guard_view() {
  double growth = 0;
  if (state_.last_step > 0)
    for (double e : expansion_step_) growth = std::max(growth, std::abs(e) / state_.last_step);
  return {setup_, state_, table_, pass_.near(), pressure(), growth};
}

StepLimit Simulation::step_limit() {
  const PunchNode punch{state_.punch.mass, state_.punch.damping, punch_wall_.value_or(0)};
  return critical_step(state_.particles, state_.contacts, state_.cell, table_, setup_.contact, state_.walls, punch,
                       {state_.time, state_.last_step}, setup_.integration.rule);
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
    if (state_.punch.mass > 0) state_.punch.tune(limit.punch_stiffness, setup_.container.punch_settings.damping_ratio);
  }
  double step = state_.stable_step;
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
  Punch& punch = state_.punch;
  equalise(state_.particles, stiffness_, setup_.contact, table_, settings.step_safety,
           punch.mass > 0 ? carriage_share : 0.0, settings.threads);
  if (punch.mass > 0) {
    const double k = column_stiffness(state_.particles, stiffness_, column());
    // Its own damper has one end in the world and counts half as much as one between two masses.
    const double with_damper = (1 + 1 / carriage_share) * k + 2 * punch.damping / stiffness_.next_step;
    const double mass = 0.5 * mass_for_step(with_damper, stiffness_.next_step, settings.step_safety);
    if (mass > 0) punch.mass = mass;
    punch.tune(k, setup_.container.punch_settings.damping_ratio);
  }
  if (state_.steps % control_interval != 0) return;
  const double pressure = std::max(contact_pressure(state_.particles, stiffness_), control_.pressure_floor);
  measure_inertia(state_.control, state_.particles, state_.cell, pressure);
  if (std::isnan(settings.fixed_step))
    state_.stable_step = controlled_step(control_, state_.control, state_.stable_step);
}

void Simulation::refresh() {
  if (refreshed_) return;
  set_environment();
  keep_list_fresh();
  refreshed_ = true;
}

void Simulation::evaluate(Recording* record) {
  if (evaluated_) throw std::logic_error("Simulation::evaluate was called twice in one step");
  refresh();
  if (equalised()) plan_equalised_step();
  compute_forces(record);
  guards_.look(guard_view());
  evaluated_ = true;
}

bool Simulation::moves_without_inertia() const {
  if (setup_.integration.method != IntegrationMethod::inertia_free) return false;
  return setup_.integration.inertia_free.from == InertiaFreeFrom::start || !state_.contacts.neck.empty();
}

/// Real masses, so that dampers made from them carry nothing, and no vibration left.
void Simulation::drop_inertia() {
  for (std::size_t p = 0; p < state_.particles.size(); ++p) {
    state_.particles.body[p].inverse_mass = 1 / real_mass(p);
    state_.particles.body[p].velocity.setZero();
  }
  state_.punch.velocity = 0;
  state_.inertia_free = true;
}

double Simulation::leapfrog_step() {
  const double step = equalised() ? stiffness_.next_step : choose_step();
  if (equalised()) equalise_inertia();
  if (!(state_.time + step > state_.time))
    throw RunError("the step of " + seconds(step) + " no longer moves the process time of " + seconds(state_.time) +
                   " on; the contacts have become too stiff or the masses too small, try "
                   "a larger mass_scaling");
  const double kick_step = state_.last_step > 0 ? 0.5 * (state_.last_step + step) : step;
  if (state_.punch.mass > 0) {
    const double before = state_.punch.velocity;
    double force = state_.walls.normal_force()[*punch_wall_];
    if (equalised()) force += column_force(state_.particles, column());
    state_.punch.kick(force, pressure(), kick_step);
    if (equalised()) carry(state_.particles, column(), state_.punch.velocity - before, setup_.integration.threads);
    state_.walls.wall[*punch_wall_].velocity = Vec3(0, 0, state_.punch.velocity);
  }
  const double fastest =
      leapfrog(state_.particles, state_.cell, {kick_step, step}, setup_.integration.drag, setup_.integration.threads);
  note_travel(fastest, step);
  for (auto& w : state_.walls.wall) {
    w.point += step * w.velocity;
    w.radius += step * w.radius_rate;
  }
  return step;
}

void Simulation::move() {
  if (!evaluated_) throw std::logic_error("Simulation::move needs evaluate before it");
  evaluated_ = refreshed_ = false;
  double step;
  if (moves_without_inertia()) {
    if (!state_.inertia_free) drop_inertia();
    const double longest = setup_.integration.largest_step;
    step = inertia_free_.move(state_, setup_, table_, state_.punch.mass > 0 ? punch_wall_ : std::nullopt,
                              std::isnan(longest) ? setup_.schedule.end() : longest);
    may_have_travelled_ = std::numeric_limits<double>::infinity();
  } else {
    step = leapfrog_step();
  }
  const double breakpoint = setup_.schedule.next_breakpoint(state_.time);
  state_.time = state_.time + step >= breakpoint ? breakpoint : state_.time + step;
  state_.last_step = step;
  ++state_.steps;
}

bool Simulation::all_at_equilibrium() const {
  if (state_.contacts.neck.empty()) return false;
  bool any = false;
  for (const auto& h : state_.contacts.neck) {
    if (h.phase == NeckPhase::loose) continue;
    if (h.phase != NeckPhase::arriving && h.phase != NeckPhase::bonded) return false;
    any = true;
  }
  return any;
}

void Simulation::restore(State state) {
  evaluated_ = refreshed_ = false;
  guards_.forget();
  state_ = std::move(state);
  table_.active_since() = state_.active_since;
  table_unsettled_ = true;
  const double since_time = state_.time - state_.last_step;
  if (!std::isnan(state_.temperature)) table_.update(state_.temperature, since_time);
  pass_.list_changed(state_.contacts, state_.particles.size());
  may_have_travelled_ = std::numeric_limits<double>::infinity();
}

std::size_t Simulation::contacts_now() const {
  std::size_t count = 0;
  const auto& list = state_.contacts;
  for (std::size_t k = 0; k < list.size(); ++k) {
    const Body &a = state_.particles.body[list.i(k)], &b = state_.particles.body[list.j(k)];
    const Vec3 shift = state_.cell.periodic ? state_.cell.shift(list.image(k)) : Vec3(Vec3::Zero());
    const double reach = a.radius + b.radius;
    const bool necked = !list.neck.empty() && list.neck[k].phase != NeckPhase::loose;
    count += necked || (b.position - a.position + shift).squaredNorm() < reach * reach;
  }
  return count;
}

std::size_t Simulation::bytes() const {
  auto of = [](const auto& v) { return v.capacity() * sizeof(v[0]); };
  const Particles& p = state_.particles;
  const ContactList& c = state_.contacts;
  return of(p.body) + of(p.reference_radius) + of(p.material) + of(p.id) + of(p.force) + of(p.angular_velocity) +
         of(p.torque) + of(c.first) + of(c.second) + of(c.tangential) + of(c.neck) + of(c.reference_position) +
         of(state_.walls.contacts()) + pass_.bytes() + inertia_free_.bytes();
}

}  // namespace densify::dem
