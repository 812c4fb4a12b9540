#include "dem/history_row.h"

#include <algorithm>
#include <cmath>

namespace densify::dem {

namespace {

bool has_walls(const Setup& s) {
  return s.container.shape == ContainerShape::cylinder || s.container.shape == ContainerShape::box;
}

void add_tensor(std::vector<double>& row, const Mat3& t) {
  for (auto [i, j] : {std::pair{0, 0}, {1, 1}, {2, 2}, {0, 1}, {0, 2}, {1, 2}}) row.push_back(t(i, j));
}

void add_cell_columns(std::vector<HistoryColumn>& columns, bool by_stress) {
  const auto add = [&](const std::string& before, const std::string& after, const std::string& unit) {
    for (const char* ij : tensor_names) columns.push_back({before + ij + after, unit});
  };
  add("strain_", "", "1");
  add("strain_rate_", "_per_s", "1/s");
  if (!by_stress) return;
  add("stress_goal_", "_Pa", "Pa");
  add("stress_mean_", "_Pa", "Pa");
}

void add_cell(std::vector<double>& row, const Simulation& sim, HistoryMemory& memory) {
  const State& s = sim.state();
  const Mat3& f = s.cell_drive.deformation;
  for (const auto& [i, j] : tensor_places) row.push_back(i == j ? std::log(f(i, i)) : f(i, j) / f(j, j));
  for (const auto& [i, j] : tensor_places) row.push_back(s.cell.velocity_gradient(i, j));
  if (!sim.stress_driven()) return;
  for (std::size_t c = 0; c < 6; ++c) {
    const CellGoal goal = sim.cell_goal(c);
    row.push_back(goal.control == CellControl::stress ? goal.value : unset);
  }
  for (std::size_t c = 0; c < 6; ++c)
    row.push_back(memory.cell_time > 0 ? memory.cell_impulse[c] / memory.cell_time
                                       : sim.cell_stress()(tensor_places[c][0], tensor_places[c][1]));
  memory.cell_impulse.fill(0);
  memory.cell_time = 0;
}

void add_energy_columns(std::vector<HistoryColumn>& columns) {
  for (const char* name :
       {"boundary_work", "sintering_work", "expansion_work", "stiffness_work", "stored_energy", "viscous_dissipation",
        "damping_dissipation", "friction_work", "motion_work", "energy_residual"})
    columns.push_back({std::string(name) + "_J", "J"});
}

void add_energies(std::vector<double>& row, const EnergySums& e) {
  row.insert(row.end(), {e.boundary, e.sintering, e.expansion, e.stiffness, e.stored, e.viscous, e.damping, e.friction,
                         e.motion, e.residual()});
}

/// Inertial number between two rows: D from the density, which knows nothing of thermal growth.
double inertial_number(const Simulation& sim, const Measures& m, const HistoryMemory& memory) {
  const State& s = sim.state();
  const double pressure = std::max(m.contact_pressure, pressure_floor(sim.peak_load()));
  const double rate = std::abs(m.relative_density / memory.density - 1) / (s.time - memory.time);
  double mass = 0;
  for (const Body& b : s.particles.body) mass += 1 / b.inverse_mass;
  return pressure > 0 ? rate * mean_diameter(sim) * std::sqrt(mass / solid_volume_now(sim) / pressure) : 0.0;
}

/// The estimate of the density's error, moved on to this row.
double error_at_row(const Simulation& sim, const Measures& m, HistoryMemory& memory) {
  const State& s = sim.state();
  if (s.cell.periodic && !sim.stress_driven()) return 0;  // the density is imposed
  ErrorEstimate& e = memory.error;
  if (std::isnan(e.initial)) e.initial = m.relative_density;
  if (s.time > memory.time) {
    const auto& free = sim.setup().integration.inertia_free;
    const double share = s.inertia_free
                             ? ErrorEstimate::share_without_inertia(free.step_tolerance, free.tangential_share)
                             : ErrorEstimate::share(inertial_number(sim, m, memory), !s.contacts.neck.empty());
    e.advance(memory.density, m.relative_density, share);
  }
  const double peak = sim.peak_load();
  // A cell has no envelope to which single particles could stick out when the load is gone.
  const bool of_specimen = peak > 0 && !s.cell.periodic && !s.contacts.neck.empty();
  const double relieved = of_specimen ? 1 - sim.load().size / peak : 0.0;
  return e.error(m.relative_density, relieved, s.particles.size());
}

}  // namespace

std::vector<double> HistoryMemory::numbers() const {
  std::vector<double> n{initial.size[0], initial.size[1], initial.size[2], initial.volume, density,  time,
                        punch_impulse,   punch_time,      error.bias,      error.initial,  cell_time};
  n.insert(n.end(), cell_impulse.begin(), cell_impulse.end());
  const auto e = energy.numbers();
  n.insert(n.end(), e.begin(), e.end());
  return n;
}

HistoryMemory HistoryMemory::from(std::span<const double> n) {
  HistoryMemory m;
  m.initial = {Vec3(n[0], n[1], n[2]), n[3]};
  m.density = n[4];
  m.time = n[5];
  m.punch_impulse = n[6];
  m.punch_time = n[7];
  m.error = {n[8], n[9]};
  m.cell_time = n[10];
  std::copy_n(n.begin() + 11, 6, m.cell_impulse.begin());
  m.energy = EnergySums::from(n.subspan(17).first<EnergySums::size>());
  return m;
}

std::vector<HistoryColumn> history_columns(const Setup& setup) {
  std::vector<HistoryColumn> c{{"time_s", "s"},
                               {"stage", ""},
                               {"temperature_K", "K"},
                               {"pressure_Pa", "Pa"},
                               {"relative_density", "1"},
                               {"relative_density_error", "1"},
                               {"relative_density_bias", "1"},
                               {"relative_density_inner", "1"},
                               {"shrinkage_x", "1"},
                               {"shrinkage_y", "1"},
                               {"shrinkage_z", "1"},
                               {"shrinkage_volume", "1"},
                               {"densification_rate_per_s", "1/s"},
                               {"coordination_number", "1"}};
  auto tensor = [&](const std::string& name) {
    for (const char* ij : {"xx", "yy", "zz", "xy", "xz", "yz"}) c.push_back({name + ij + "_Pa", "Pa"});
  };
  tensor("stress_");
  if (setup.contact.sintering) {
    tensor("sintering_stress_");
    tensor("viscoelastic_stress_");
    c.insert(c.end(), {{"mean_neck_radius_m", "m"}, {"neck_equilibrium_fraction", "1"}});
    if (!std::isnan(setup.contact.sintering->closing_porosity))
      c.insert(c.end(), {{"mean_local_density", "1"}, {"largest_local_density", "1"}, {"closing_neck_fraction", "1"}});
  }
  if (has_walls(setup))
    c.insert(c.end(), {{"punch_pressure_Pa", "Pa"},
                       {"punch_pressure_mean_Pa", "Pa"},
                       {"bottom_pressure_Pa", "Pa"},
                       {"lateral_pressure_Pa", "Pa"}});
  if (setup.cell_path) add_cell_columns(c, setup.cell_path->by_stress());
  if (setup.energies) add_energy_columns(c);
  if (setup.integration.inertia == Inertia::equalised) c.push_back({"inertial_number", "1"});
  c.insert(c.end(), {{"unbalanced_force_ratio", "1"},
                     {"kinetic_over_elastic_energy", "1"},
                     {"damping_force_share", "1"},
                     {"largest_overlap", "1"},
                     {"time_step_s", "s"},
                     {"steps", "1"}});
  return c;
}

std::vector<double> history_row(const Simulation& sim, const Measures& m, HistoryMemory& memory) {
  const State& s = sim.state();
  const Setup& setup = sim.setup();
  const double rate = s.time > memory.time ? (m.relative_density - memory.density) / (s.time - memory.time) : 0.0;
  memory.density_error = error_at_row(sim, m, memory);
  std::vector<double> row{s.time,
                          sim.temperature(),
                          sim.pressure(),
                          m.relative_density,
                          memory.density_error,
                          memory.error.bias,
                          m.relative_density_inner,
                          m.envelope.size[0] / memory.initial.size[0],
                          m.envelope.size[1] / memory.initial.size[1],
                          m.envelope.size[2] / memory.initial.size[2],
                          m.envelope.volume / memory.initial.volume,
                          rate,
                          m.coordination_number};
  add_tensor(row, m.stress);
  if (setup.contact.sintering) {
    add_tensor(row, m.sintering_stress);
    add_tensor(row, m.stress - m.sintering_stress);
    row.insert(row.end(), {m.mean_neck_radius, m.equilibrium_fraction});
    if (!std::isnan(setup.contact.sintering->closing_porosity))
      row.insert(row.end(), {m.mean_local_density, m.largest_local_density, m.closing_fraction});
  }
  if (has_walls(setup)) {
    const double area = sim.punch_area();
    const double mean = memory.punch_time > 0 ? memory.punch_impulse / memory.punch_time / area : m.punch_pressure;
    row.insert(row.end(), {m.punch_pressure, mean, m.bottom_pressure, m.lateral_pressure});
  }
  if (setup.cell_path) add_cell(row, sim, memory);
  if (setup.energies) add_energies(row, memory.energy);
  if (setup.integration.inertia == Inertia::equalised) row.push_back(s.control.inertial_number);
  row.insert(row.end(), {m.unbalanced_force_ratio, m.elastic_energy > 0 ? m.kinetic_energy / m.elastic_energy : unset,
                         m.damping_share, m.largest_overlap, s.last_step, double(s.steps)});
  memory.density = m.relative_density;
  memory.time = s.time;
  memory.punch_impulse = memory.punch_time = 0;
  return row;
}

}  // namespace densify::dem
