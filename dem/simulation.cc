#include "dem/simulation.h"

#include <algorithm>
#include <cmath>

#include "base/check.h"
#include "dem/state/spatial_order.h"

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

bool activation_has_begun(const PairTable& table) {
  for (std::uint8_t a = 0; a < table.materials(); ++a)
    for (std::uint8_t b = a; b < table.materials(); ++b)
      if (table.row(a, b).activation_step) return true;
  return false;
}

double sphere_volume(double r) {
  return 4.0 / 3 * M_PI * r * r * r;
}

}  // namespace

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
  if (stress_driven()) pass_.keep_virial();
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
  if (equalised()) {
    control_ = step_control(setup_.integration, setup_.schedule);
    control_.peak_pressure = peak_load();
    if (const auto& sintering = setup_.contact.sintering) {
      control_.transition = sintering->relaxation_time;
      constexpr double flow_steps = 4000;  // in a transition
      if (stress_driven() && !setup_.contact.friction) control_.flow_step = control_.transition / flow_steps;
      if (std::isnan(setup_.integration.smallest_step) && control_.flow_step > 0)
        control_.smallest_step = std::min(control_.smallest_step, control_.flow_step);
      for (std::uint8_t a = 0; a < table_.materials(); ++a)
        for (std::uint8_t b = a; b < table_.materials(); ++b)
          control_.activation_temperatures.push_back(table_.interface(a, b).activation_temperature);
    }
  }
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
  // Where the step makes the masses they tell nothing; a packing's own masses are not those of its material.
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
    for (auto& w : state_.walls.wall)
      if (w.stretch(stretch)) w.thermal_rate = rate;
    if (state_.punch.mass > 0) state_.punch.area = punch_area();
  }
  for (const double growth : expansion_step_)
    may_have_travelled_ += 1.1 * std::abs(growth) * 2 * state_.contacts.largest_radius;
  state_.temperature = t;
}

/// Local densities, anew once the powder has moved on; in between they change with its density.
void Simulation::measure_pores() {
  constexpr double change = 0.1, least = 0.01;  // of the density over the porosity; porosity that still counts
  if (!setup_.contact.sintering || std::isnan(setup_.contact.sintering->closing_porosity)) return;
  if (state_.contacts.neck.empty()) return;
  const PowderRoom room = powder_room(state_.particles, state_.cell, state_.walls);
  const double density = powder_density(state_.particles, room);
  LocalDensity& local = state_.local_density;
  if (local.of.empty() || local.builds != state_.contacts.builds ||
      std::abs(density / local.powder - 1) > change * std::max(least, 1 - density)) {
    require_finite(state_);  // the search for the cells would end in a place that is not there
    local = {local_densities(state_.particles, state_.cell, room, state_.contacts), density, state_.contacts.builds};
  }
  pore_scale_ = density / local.powder;
}

PoreClosure Simulation::pores() const {
  if (state_.local_density.of.empty()) return {};
  return {state_.local_density.of.data(), pore_scale_, setup_.contact.sintering->closing_porosity};
}

void Simulation::compute_forces(Recording* record) {
  const PassTime clock{state_.time, state_.last_step};
  StepStiffness* const stiffness = equalised() ? &stiffness_ : nullptr;
  pass_.set_pores(pores());
  pass_.compute(state_.particles, state_.contacts, state_.cell, table_, expansion_step_, clock,
                record ? &record->contact : nullptr, stiffness);
  if (stress_driven()) {
    const Mat3 virial = pass_.virial(state_.particles, state_.cell);
    cell_stress_ = 0.5 / state_.cell.volume() * (virial + virial.transpose());
  }
  if (setup_.cell_path) enter_stage(state_.cell_drive, *setup_.cell_path, setup_.schedule, state_.time, cell_stress_);
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

void Simulation::refresh() {
  if (refreshed_) return;
  set_environment();
  keep_list_fresh();
  measure_pores();
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
  if (!(state_.time + step > state_.time)) refuse_idle_step(step);
  const double kick_step = state_.last_step > 0 ? 0.5 * (state_.last_step + step) : step;
  if (state_.punch.mass > 0) {
    const double force = state_.walls.normal_force()[*punch_wall_];
    if (equalised() && column_mass_ > 0) {
      const double net = force - pressure() * state_.punch.area + column_force(state_.particles, column());
      const double change = net / column_mass_ * kick_step;
      state_.punch.velocity += change;
      carry(state_.particles, column(), change, setup_.integration.threads);
    }
    state_.punch.kick(force, pressure(), kick_step);
    state_.walls.wall[*punch_wall_].velocity = Vec3(0, 0, state_.punch.velocity);
  }
  if (setup_.cell_path) drive_cell({kick_step, step});
  const double fastest =
      leapfrog(state_.particles, state_.cell, {kick_step, step}, setup_.integration.drag, setup_.integration.threads);
  note_travel(fastest, step);
  for (auto& w : state_.walls.wall) w.move(step);
  return step;
}

void Simulation::move(const CellStretch* stretch) {
  if (!evaluated_) throw std::logic_error("Simulation::move needs evaluate before it");
  evaluated_ = refreshed_ = false;
  double step;
  if (moves_without_inertia()) {
    if (!state_.inertia_free) drop_inertia();
    const double longest = setup_.integration.largest_step;
    step = inertia_free_.move(state_, setup_, table_, pores(), state_.punch.mass > 0 ? punch_wall_ : std::nullopt,
                              std::isnan(longest) ? setup_.schedule.end() : longest, stretch);
    may_have_travelled_ = std::numeric_limits<double>::infinity();
  } else {
    step = leapfrog_step();
  }
  double until = setup_.schedule.next_breakpoint(state_.time);
  if (stretch) until = std::min(until, stretch->end);
  state_.time = step >= until - state_.time ? until : state_.time + step;
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
  touching_volume_ = unset;
  state_ = std::move(state);
  table_.active_since() = state_.active_since;
  table_unsettled_ = true;
  const double since_time = state_.time - state_.last_step;
  if (!std::isnan(state_.temperature)) table_.update(state_.temperature, since_time);
  pass_.list_changed();
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
         of(state_.walls.contacts()) + of(stiffness_.of) + pass_.bytes() + inertia_free_.bytes();
}

}  // namespace densify::dem
