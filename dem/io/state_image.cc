#include "dem/io/state_image.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "base/check.h"

namespace densify::dem {

namespace {

constexpr std::size_t body_columns = sizeof(Body) / sizeof(double);

std::vector<double> flat(const Mat3& m) {
  return {m.data(), m.data() + 9};
}

std::vector<double> flat(const std::vector<Body>& body) {
  std::vector<double> values(body.size() * body_columns);
  if (!body.empty()) std::memcpy(values.data(), body.data(), body.size() * sizeof(Body));
  return values;
}

/// Refuses a state in which something does not fit.
void require(bool fits, const std::string& what) {
  if (!fits) throw FileError(what + " does not fit the scene");
}

std::vector<Vec3> read_vectors(const Hdf5Reader& file, const std::string& name, std::size_t rows) {
  const Hdf5Shape s = file.shape(name);
  require(s.rows == rows && s.columns == 3, name);
  const auto values = file.read<double>(name);
  std::vector<Vec3> vectors(rows);
  for (std::size_t r = 0; r < rows; ++r) vectors[r] = Vec3(values[3 * r], values[3 * r + 1], values[3 * r + 2]);
  return vectors;
}

template <class T>
std::vector<T> read_list(const Hdf5Reader& file, const std::string& name, std::size_t rows) {
  auto values = file.read<T>(name);
  require(values.size() == rows, name);
  return values;
}

Mat3 read_matrix(const Hdf5Reader& file, const std::string& name) {
  const auto values = read_list<double>(file, name, 9);
  return Eigen::Map<const Mat3>(values.data());
}

Vec3 read_vector(const Hdf5Reader& file, const std::string& name) {
  const auto values = read_list<double>(file, name, 3);
  return {values[0], values[1], values[2]};
}

void write_walls(Hdf5Writer& file, const std::string& group, const std::vector<Wall>& walls) {
  std::vector<std::string> names;
  std::vector<std::uint8_t> shapes;
  std::vector<Vec3> points, normals, velocities;
  std::vector<double> radii, radius_rates;
  for (const auto& w : walls) {
    names.push_back(w.name);
    shapes.push_back(std::uint8_t(w.shape));
    points.push_back(w.point);
    normals.push_back(w.normal);
    velocities.push_back(w.velocity);
    radii.push_back(w.radius);
    radius_rates.push_back(w.radius_rate);
  }
  file.texts(group + "/name", names);
  file.list(group + "/shape", shapes, "");
  file.table(group + "/point", points, "m");
  file.table(group + "/normal", normals, "1");
  file.table(group + "/velocity", velocities, "m/s");
  file.list(group + "/radius", radii, "m");
  file.list(group + "/radius_rate", radius_rates, "m/s");
}

/// Reads walls that must be those of the setup by name and shape.
std::vector<Wall> read_walls(const Hdf5Reader& file, const std::string& group, const std::vector<Wall>& expected) {
  const std::size_t n = expected.size();
  const auto names = file.texts(group + "/name");
  require(names.size() == n, group);
  const auto shapes = read_list<std::uint8_t>(file, group + "/shape", n);
  const auto points = read_vectors(file, group + "/point", n), normals = read_vectors(file, group + "/normal", n);
  const auto velocities = read_vectors(file, group + "/velocity", n);
  const auto radii = read_list<double>(file, group + "/radius", n);
  const auto radius_rates = read_list<double>(file, group + "/radius_rate", n);
  std::vector<Wall> walls;
  for (std::size_t w = 0; w < n; ++w) {
    require(names[w] == expected[w].name && shapes[w] == std::uint8_t(expected[w].shape), group);
    walls.push_back({names[w], expected[w].shape, points[w], normals[w], radii[w], velocities[w], radius_rates[w]});
  }
  return walls;
}

void write_contacts(Hdf5Writer& file, const ContactList& list) {
  file.list("/contacts/first", list.first, "");
  file.list("/contacts/second", list.second, "");
  std::vector<std::uint64_t> buckets;
  for (const auto& b : list.buckets) buckets.insert(buckets.end(), {b.begin, b.end, b.material_a, b.material_b});
  file.list("/contacts/buckets", buckets, "");
  file.table("/contacts/tangential", list.tangential, "m");
  std::vector<double> radius, elastic, since;
  std::vector<std::uint8_t> phase;
  for (const auto& h : list.neck) {
    radius.push_back(h.radius);
    elastic.push_back(h.elastic);
    since.push_back(h.since);
    phase.push_back(std::uint8_t(h.phase));
  }
  file.list("/contacts/neck_radius", radius, "m");
  file.list("/contacts/neck_elastic", elastic, "m");
  file.list("/contacts/neck_since", since, "s");
  file.list("/contacts/neck_phase", phase, "");
  file.table("/contacts/reference_position", list.reference_position, "m");
  file.list("/contacts/reference_h", flat(list.reference_h), "m");
  file.list("/contacts/reference_expansion", list.reference_expansion, "1");
  file.attribute("/contacts", "skin", list.skin);
  file.attribute("/contacts", "largest_radius", list.largest_radius);
  file.attribute("/contacts", "builds", std::uint64_t(list.builds));
}

void read_buckets(const Hdf5Reader& file, ContactList& list, const Particles& particles) {
  const auto flat_buckets = file.read<std::uint64_t>("/contacts/buckets");
  require(flat_buckets.size() % 4 == 0, "/contacts/buckets");
  std::size_t next = 0;
  for (std::size_t b = 0; b < flat_buckets.size(); b += 4) {
    const std::uint64_t begin = flat_buckets[b], end = flat_buckets[b + 1];
    require(begin == next && end >= begin && end <= list.size(), "/contacts/buckets");
    for (std::size_t k = begin; k < end; ++k) {
      const auto [low, high] = std::minmax(particles.material[list.i(k)], particles.material[list.j(k)]);
      require(low == flat_buckets[b + 2] && high == flat_buckets[b + 3], "/contacts/buckets");
    }
    list.buckets.push_back({begin, end, std::uint8_t(flat_buckets[b + 2]), std::uint8_t(flat_buckets[b + 3])});
    next = end;
  }
  require(next == list.size(), "/contacts/buckets");
}

ContactList read_contacts(const Hdf5Reader& file, const Particles& particles, const Simulation& simulation) {
  ContactList list;
  const std::size_t n = particles.size();
  list.first = file.read<std::uint32_t>("/contacts/first");
  list.second = read_list<std::uint32_t>(file, "/contacts/second", list.first.size());
  for (std::size_t k = 0; k < list.size(); ++k)
    require(list.i(k) < n && list.j(k) < n && list.image(k) < 27, "/contacts/first");
  read_buckets(file, list, particles);
  list.tangential = read_vectors(file, "/contacts/tangential", simulation.setup().contact.friction ? list.size() : 0);

  const auto radius = file.read<double>("/contacts/neck_radius");
  const std::size_t necks = radius.size();
  require(necks == 0 || (necks == list.size() && simulation.setup().contact.sintering), "/contacts/neck_radius");
  const auto elastic = read_list<double>(file, "/contacts/neck_elastic", necks);
  const auto since = read_list<double>(file, "/contacts/neck_since", necks);
  const auto phase = read_list<std::uint8_t>(file, "/contacts/neck_phase", necks);
  for (std::size_t k = 0; k < necks; ++k) {
    require(phase[k] <= std::uint8_t(NeckPhase::reactivating), "/contacts/neck_phase");
    list.neck.push_back({radius[k], elastic[k], since[k], NeckPhase(phase[k])});
  }
  list.reference_position = read_vectors(file, "/contacts/reference_position", n);
  list.reference_h = read_matrix(file, "/contacts/reference_h");
  list.reference_expansion =
      read_list<double>(file, "/contacts/reference_expansion", simulation.setup().materials.size());
  list.skin = file.attribute<double>("/contacts", "skin");
  list.largest_radius = file.attribute<double>("/contacts", "largest_radius");
  list.builds = file.attribute<std::uint64_t>("/contacts", "builds");
  return list;
}

Particles read_particles(const Hdf5Reader& file, const Simulation& simulation) {
  Particles p;
  const std::size_t n = simulation.state().particles.size();
  const Hdf5Shape s = file.shape("/particles/body");
  require(s.rows == n && s.columns == body_columns, "/particles/body");
  const auto body = file.read<double>("/particles/body");
  p.body.resize(n);
  for (std::size_t q = 0; q < n; ++q) {
    const double* b = body.data() + q * body_columns;
    p.body[q] = {Vec3(b[0], b[1], b[2]), b[3], Vec3(b[4], b[5], b[6]), b[7]};
    require(std::isfinite(b[3]) && b[3] > 0 && std::isfinite(b[7]), "/particles/body");
  }
  p.reference_radius = read_list<double>(file, "/particles/reference_radius", n);
  p.material = read_list<std::uint8_t>(file, "/particles/material", n);
  for (const auto m : p.material) require(m < simulation.setup().materials.size(), "/particles/material");
  p.id = read_list<std::uint32_t>(file, "/particles/id", n);
  p.force = read_vectors(file, "/particles/force", n);
  const std::size_t rotating = simulation.setup().contact.friction ? n : 0;
  p.angular_velocity = read_vectors(file, "/particles/angular_velocity", rotating);
  p.torque = read_vectors(file, "/particles/torque", rotating);
  return p;
}

}  // namespace

void write_state(Hdf5Writer& file, const State& state) {
  const Particles& p = state.particles;
  file.table("/particles/body", flat(p.body), body_columns, "");
  file.list("/particles/reference_radius", p.reference_radius, "m");
  file.list("/particles/material", p.material, "");
  file.list("/particles/id", p.id, "");
  file.table("/particles/force", p.force, "N");
  file.table("/particles/angular_velocity", p.angular_velocity, "rad/s");
  file.table("/particles/torque", p.torque, "N m");
  write_contacts(file, state.contacts);

  write_walls(file, "/walls/now", state.walls.wall);
  write_walls(file, "/walls/reference", state.walls.reference());
  std::vector<std::uint32_t> particle;
  std::vector<std::uint8_t> wall;
  std::vector<Vec3> tangential;
  for (const auto& c : state.walls.contacts()) {
    particle.push_back(c.particle);
    wall.push_back(c.wall);
    tangential.push_back(c.tangential);
  }
  file.list("/walls/contact_particle", particle, "");
  file.list("/walls/contact_wall", wall, "");
  file.table("/walls/contact_tangential", tangential, "m");

  const Punch& u = state.punch;
  file.list<double>("/state/punch",
                    {u.mass, u.area, u.damping, u.memory, u.velocity, u.mean_velocity, u.mean_acceleration}, "");
  file.list<std::uint8_t>("/state/cell_periodic", {std::uint8_t(state.cell.periodic)}, "");
  file.list("/state/cell_h", flat(state.cell.h), "m");
  const Vec3& o = state.cell.origin;
  file.list<double>("/state/cell_origin", {o[0], o[1], o[2]}, "m");
  file.list("/state/cell_velocity_gradient", flat(state.cell.velocity_gradient), "1/s");
  file.list("/state/expansion", state.expansion, "1");
  file.list("/state/active_since", state.active_since, "s");
  file.list<double>("/state/clock",
                    {state.temperature, state.time, state.last_step, state.stable_step, state.critical_step}, "");
  file.list("/state/strain_rate", flat(state.control.strain_rate), "1/s");
  file.list<double>("/state/inertial_number", {state.control.inertial_number}, "1");
  if (const CellDrive& d = state.cell_drive; d.stage != CellDrive::no_stage) {
    std::vector<double> n{d.mass, d.damping, d.memory};
    for (const auto* six : {&d.mean, &d.slope, &d.found}) n.insert(n.end(), six->begin(), six->end());
    file.list("/state/cell_drive", n, "");
    file.list("/state/cell_deformation", flat(d.deformation), "1");
    file.attribute("/state", "cell_stage", d.stage);
  }
  if (const LocalDensity& l = state.local_density; !l.of.empty()) {
    file.list("/state/local_density", l.of, "1");
    file.list<double>("/state/local_density_of_powder", {l.powder}, "1");
    file.attribute("/state", "local_density_builds", l.builds);
  }
  file.attribute("/state", "steps", state.steps);
  file.attribute("/state", "inertia_free", std::uint64_t(state.inertia_free));
}

namespace {

CellDrive read_cell_drive(const Hdf5Reader& file) {
  CellDrive d;
  if (!file.has("/state/cell_drive")) return d;
  const auto n = read_list<double>(file, "/state/cell_drive", 21);
  d.mass = n[0], d.damping = n[1], d.memory = n[2];
  for (std::size_t c = 0; c < 6; ++c) d.mean[c] = n[3 + c], d.slope[c] = n[9 + c], d.found[c] = n[15 + c];
  d.stage = file.attribute<std::uint64_t>("/state", "cell_stage");
  d.deformation = read_matrix(file, "/state/cell_deformation");
  return d;
}

}  // namespace

namespace {

LocalDensity read_local_density(const Hdf5Reader& file, const ContactModel& model, std::size_t particles) {
  if (!file.has("/state/local_density")) return {};
  require(model.sintering && !std::isnan(model.sintering->closing_porosity), "/state/local_density");
  return {read_list<double>(file, "/state/local_density", particles),
          read_list<double>(file, "/state/local_density_of_powder", 1)[0],
          file.attribute<std::uint64_t>("/state", "local_density_builds")};
}

}  // namespace

State read_state(const Hdf5Reader& file, const Simulation& simulation) {
  const State& now = simulation.state();
  State s;
  s.particles = read_particles(file, simulation);
  s.contacts = read_contacts(file, s.particles, simulation);

  s.walls = now.walls;  // keeps the material
  s.walls.wall = read_walls(file, "/walls/now", now.walls.wall);
  s.walls.reference() = read_walls(file, "/walls/reference", now.walls.wall);
  const auto particle = file.read<std::uint32_t>("/walls/contact_particle");
  const auto wall = read_list<std::uint8_t>(file, "/walls/contact_wall", particle.size());
  const auto tangential = read_vectors(file, "/walls/contact_tangential", particle.size());
  s.walls.contacts().clear();
  for (std::size_t c = 0; c < particle.size(); ++c) {
    require(particle[c] < s.particles.size() && wall[c] < s.walls.wall.size(), "/walls/contact_particle");
    s.walls.contacts().push_back({particle[c], wall[c], tangential[c]});
  }

  const auto u = read_list<double>(file, "/state/punch", 7);
  s.punch = {u[0], u[1], u[2], u[3], u[4], u[5], u[6]};
  s.cell.periodic = read_list<std::uint8_t>(file, "/state/cell_periodic", 1)[0] != 0;
  require(s.cell.periodic == now.cell.periodic, "/state/cell_periodic");
  s.cell.h = read_matrix(file, "/state/cell_h");
  s.cell.origin = read_vector(file, "/state/cell_origin");
  s.cell.velocity_gradient = read_matrix(file, "/state/cell_velocity_gradient");
  s.cell_drive = read_cell_drive(file);
  s.local_density = read_local_density(file, simulation.setup().contact, s.particles.size());
  s.expansion = read_list<double>(file, "/state/expansion", now.expansion.size());
  s.active_since = read_list<double>(file, "/state/active_since", now.active_since.size());
  const auto clock = read_list<double>(file, "/state/clock", 5);
  s.temperature = clock[0];
  s.time = clock[1];
  s.last_step = clock[2];
  s.stable_step = clock[3];
  s.critical_step = clock[4];
  s.control.strain_rate = read_matrix(file, "/state/strain_rate");
  s.control.inertial_number = read_list<double>(file, "/state/inertial_number", 1)[0];
  s.steps = file.attribute<std::uint64_t>("/state", "steps");
  s.inertia_free = file.attribute<std::uint64_t>("/state", "inertia_free") != 0;
  require(std::isfinite(s.time) && std::isfinite(s.temperature), "/state/clock");
  return s;
}

}  // namespace densify::dem
