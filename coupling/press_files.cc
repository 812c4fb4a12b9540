#include "coupling/press_files.h"

#include <deal.II/numerics/data_out.h>
#include <fmt/core.h>

#include <Eigen/Geometry>
#include <cmath>
#include <fstream>
#include <numbers>
#include <sstream>

#include "base/check.h"
#include "dem/io/atomic_file.h"
#include "dem/io/hdf5_file.h"

namespace densify::coupling {

namespace {

constexpr std::uint64_t format = 4;

/// Numbers of living volume elements, but for their states.
template <class Memory, class Visit>
void visit_live_numbers(Memory& m, Visit visit) {
  visit(m.largest_stress);
  for (auto* x : {&m.count.elements, &m.count.steps, &m.count.solutions, &m.count.rounds, &m.count.bytes}) visit(*x);
  for (auto* x : {&m.count.largest_mismatch, &m.count.mismatch_work, &m.count.contact_work, &m.count.dropped_stress})
    visit(*x);
}

std::string element_name(std::size_t k) {
  return fmt::format("elements/{:06d}", k);
}

/// Numbers of a row that a checkpoint keeps, in order.
template <class Row, class Visit>
void visit_numbers(Row& r, Visit visit) {
  for (auto* x : {&r.time,
                  &r.temperature,
                  &r.pressure,
                  &r.density.mean,
                  &r.density.least,
                  &r.density.most,
                  &r.density_error,
                  &r.height,
                  &r.travel,
                  &r.volume,
                  &r.forces.punch,
                  &r.forces.bottom,
                  &r.forces.wall_pressure,
                  &r.forces.wall_friction,
                  &r.stored,
                  &r.dissipated,
                  &r.thermal,
                  &r.slid,
                  &r.work,
                  &r.step})
    visit(*x);
}

}  // namespace

std::string press_history_header() {
  return "time_s,stage,temperature_K,pressure_Pa,relative_density,relative_density_error,relative_density_least,"
         "relative_density_most,height_m,radius_m,punch_travel_m,punch_force_N,bottom_force_N,wall_force_N,"
         "wall_friction_N,elastic_energy_J,dissipated_J,thermal_work_J,friction_work_J,work_J,time_step_s,steps,"
         "newton_iterations,rejected\n";
}

std::string press_history_row(const fem::PressRow& r) {
  return fmt::format(
      "{},{},{},{},{},{:.6g},{},{},{},{},{},{},{},{},{},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{},{},{},{}\n", r.time,
      r.stage, r.temperature, r.pressure, r.density.mean, r.density_error, r.density.least, r.density.most, r.height,
      std::sqrt(r.volume / (std::numbers::pi * r.height)), r.travel, r.forces.punch, r.forces.bottom,
      r.forces.wall_pressure, r.forces.wall_friction, r.stored, r.dissipated, r.thermal, r.slid, r.work, r.step,
      r.steps, r.iterations, r.rejected);
}

void write_press_checkpoint(const std::filesystem::path& path, const PressCheckpoint& c) {
  dem::Hdf5Writer file(path);
  file.attribute("/", "format", format);
  file.text("scene", c.scene);
  file.text("stage", c.run.row.stage);
  file.text("fields", c.fields);
  file.list("displacement", c.body.displacement, "m");
  file.list("before", c.body.before, "m");
  file.list("points", c.body.points, "");
  file.list("wall", c.body.wall, "");
  file.list("rate", c.run.rate, "1/s");
  file.list("rate_before", c.run.rate_before, "1/s");
  std::vector<double> numbers{c.body.temperature,
                              c.body.last_step,
                              c.body.largest_scale,
                              c.body.shear,
                              c.body.punch_closed,
                              c.run.next,
                              c.run.step,
                              c.run.step_before,
                              c.run.height_at_ejection,
                              c.run.stage_travel,
                              c.run.stage_pressure,
                              c.fields_at,
                              double(c.run.row.steps),
                              double(c.run.row.iterations),
                              double(c.run.row.rejected)};
  visit_numbers(c.run.row, [&](const double& x) { numbers.push_back(x); });
  file.list("numbers", numbers, "");
  std::vector<double> live;
  visit_live_numbers(c.live, [&](const auto& x) { live.push_back(double(x)); });
  file.list("live", live, "");
  for (std::size_t k = 0; k < c.live.images.size(); ++k)
    file.list(element_name(k), std::vector<std::uint8_t>(c.live.images[k].begin(), c.live.images[k].end()), "");
  file.commit(dem::Durability::power_loss);
}

PressCheckpoint read_press_checkpoint(const std::filesystem::path& path) {
  const dem::Hdf5Reader file(path);
  if (file.attribute<std::uint64_t>("/", "format") != format)
    throw InputError(
        fmt::format("{}: is of another version of this program; start the run anew in another folder", path.string()));
  PressCheckpoint c;
  c.scene = file.text("scene");
  c.run.row.stage = file.text("stage");
  c.fields = file.text("fields");
  c.body.displacement = file.read<double>("displacement");
  c.body.before = file.read<double>("before");
  c.body.points = file.read<double>("points");
  c.body.wall = file.read<double>("wall");
  c.run.rate = file.read<double>("rate");
  c.run.rate_before = file.read<double>("rate_before");
  const std::vector<double> numbers = file.read<double>("numbers");
  std::size_t k = 0;
  for (double* x : {&c.body.temperature, &c.body.last_step, &c.body.largest_scale, &c.body.shear, &c.body.punch_closed,
                    &c.run.next, &c.run.step, &c.run.step_before, &c.run.height_at_ejection, &c.run.stage_travel,
                    &c.run.stage_pressure, &c.fields_at})
    *x = numbers.at(k++);
  for (int* x : {&c.run.row.steps, &c.run.row.iterations, &c.run.row.rejected}) *x = int(numbers.at(k++));
  visit_numbers(c.run.row, [&](double& x) { x = numbers.at(k++); });
  const std::vector<double> live = file.read<double>("live");
  k = 0;
  visit_live_numbers(c.live, [&]<class T>(T& x) { x = T(live.at(k++)); });
  for (std::size_t e = 0; file.has(element_name(e)); ++e) {
    const auto bytes = file.read<std::uint8_t>(element_name(e));
    c.live.images.emplace_back(bytes.begin(), bytes.end());
  }
  return c;
}

template <int dim>
std::string write_press_fields(const std::filesystem::path& folder, const std::string& name,
                               const fem::PressBody<dim>& body) {
  // Means of each element's points: fields of the material live at points, not at nodes.
  const auto points = body.points();
  const auto& dofs = body.dofs();
  const unsigned each = body.points_of_element();
  const char* names[] = {"relative_density", "mean_stress", "stress_rr",       "stress_tt",
                         "stress_zz",        "stress_rz",   "von_mises_stress"};
  constexpr std::size_t fields = std::size(names);
  std::vector<dealii::Vector<float>> values(fields, dealii::Vector<float>(dofs.get_triangulation().n_active_cells()));
  std::size_t point = 0;
  for (const auto& cell : dofs.active_cell_iterators()) {
    if (!cell->is_locally_owned()) continue;
    double sums[fields] = {}, volume = 0;
    for (unsigned q = 0; q < each; ++q, ++point) {
      const fem::PointRecord& p = points[point];
      const Vec3 r = dim == 2 ? Vec3(Vec3::UnitX()) : Vec3(Vec3(p.place[0], p.place[1], 0).normalized());
      const Vec3 z = Vec3::UnitZ(), t = z.cross(r);
      const double mean = p.stress.trace() / 3;
      const double mises = std::sqrt(1.5) * (p.stress - mean * Mat3::Identity()).norm();
      const double all[] = {p.density,           mean, r.dot(p.stress * r), t.dot(p.stress * t), z.dot(p.stress * z),
                            r.dot(p.stress * z), mises};
      for (std::size_t f = 0; f < fields; ++f) sums[f] += p.volume * all[f];
      volume += p.volume;
    }
    for (std::size_t f = 0; f < fields; ++f) values[f][cell->active_cell_index()] = float(sums[f] / volume);
  }
  dealii::DataOut<dim> out;
  out.attach_dof_handler(dofs);
  const std::vector<dealii::DataComponentInterpretation::DataComponentInterpretation> vector(
      dim, dealii::DataComponentInterpretation::component_is_part_of_vector);
  out.add_data_vector(body.displacement(), std::vector<std::string>(dim, "displacement"),
                      dealii::DataOut<dim>::type_dof_data, vector);
  for (std::size_t f = 0; f < fields; ++f) out.add_data_vector(values[f], names[f]);
  out.build_patches(body.mapping(), 1, dealii::DataOut<dim>::curved_inner_cells);
  const unsigned ranks = dealii::Utilities::MPI::n_mpi_processes(body.comm());
  const unsigned rank = dealii::Utilities::MPI::this_mpi_process(body.comm());
  const auto write = [&](const std::string& file, auto&& writer) {
    std::ostringstream text;
    writer(text);
    dem::write_atomically(folder / file, {text.str()}, dem::Durability::kill);
  };
  const auto piece = [&](unsigned k) {
    return ranks == 1 ? fmt::format("{}.vtu", name) : fmt::format("{}.{}.vtu", name, k);
  };
  write(piece(rank), [&](std::ostream& s) { out.write_vtu(s); });
  if (ranks == 1) return piece(0);
  const std::string whole = fmt::format("{}.pvtu", name);
  if (rank == 0) {
    std::vector<std::string> pieces;
    for (unsigned k = 0; k < ranks; ++k) pieces.push_back(piece(k));
    write(whole, [&](std::ostream& s) { out.write_pvtu_record(s, pieces); });
  }
  return whole;
}

void write_press_collection(const std::filesystem::path& folder, const std::string& lines) {
  std::string text = "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\">\n<Collection>\n";
  std::istringstream all(lines);
  for (std::string time, file; all >> time >> file;)
    text += fmt::format("<DataSet timestep=\"{}\" file=\"fields/{}\"/>\n", time, file);
  text += "</Collection>\n</VTKFile>\n";
  dem::write_atomically(folder / "fields.pvd", {text}, dem::Durability::kill);
}

template std::string write_press_fields(const std::filesystem::path&, const std::string&, const fem::PressBody<2>&);
template std::string write_press_fields(const std::filesystem::path&, const std::string&, const fem::PressBody<3>&);

}  // namespace densify::coupling
