#pragma once
// Small worlds for tests: materials, arrangements of spheres, and what one reads of them.

#include <Eigen/Geometry>
#include <random>

#include "dem/simulation.h"

namespace densify::test {

using dem::Particles;
using dem::Setup;
using dem::Simulation;

/// Copper of Table 5.1 (D_gb delta = 3.832e-19 m^3/s as prefactor x width), active at every temperature.
inline dem::Material copper() {
  dem::Material m;
  m.name = "Cu";
  m.density = 8920;
  m.youngs_modulus = PiecewiseLinear(1e11);
  m.poissons_ratio = PiecewiseLinear(0.3);
  m.diffusion = {1.18e-29, 3.832e-19 / 5e-10, 0, 5e-10};
  m.surface_energy = 1.72;
  m.dihedral_angle = 146 * M_PI / 180;
  m.activation_temperature = 0;
  return m;
}

/// NiAl of Table 5.4 with constant elasticity.
inline dem::Material nickel_aluminide() {
  dem::Material m;
  m.name = "NiAl";
  m.density = 5910;
  m.thermal_expansion = 11.5e-6;
  m.youngs_modulus = PiecewiseLinear(183e9);
  m.poissons_ratio = PiecewiseLinear(0.34);
  m.diffusion = {1.20e-29, 2.55e-5, 185e3, 0.5e-9};
  m.surface_energy = 1.57;
  m.dihedral_angle = 147 * M_PI / 180;
  m.activation_temperature = 0.5 * 1911;
  return m;
}

/// An undamped, frictionless contact of loose particles.
inline dem::ContactModel elastic_model(dem::Elasticity elasticity, double normal_stiffness) {
  dem::ContactModel m;
  m.elasticity = elasticity;
  m.normal_stiffness = normal_stiffness;
  m.damping_ratio = 0;
  return m;
}

/// One stage at constant temperature [K] and pressure [Pa].
inline Schedule hold(double duration, double temperature, double pressure) {
  return Schedule(temperature, pressure, {{"hold", duration, temperature, pressure}});
}

/// A setup without particles: one material, constant temperature.
inline Setup empty_setup(const dem::Material& material, const dem::ContactModel& model, const Schedule& schedule) {
  return Setup{{material}, {}, model, {}, {}, schedule, {}, schedule.temperature(0), {}, {}};
}

inline void add_sphere(Particles& p, const Vec3& x, double r, const Vec3& v) {
  p.id.push_back(std::uint32_t(p.size()));
  p.body.push_back({x, r, v, 0});
  p.reference_radius.push_back(r);
  p.material.push_back(0);
}

enum class Lattice { simple_cubic, body_centred, face_centred };

/// Points of a lattice with nearest neighbours `spacing` apart, `n`^3 cubic cells from the origin; `edge` is the size
/// of the whole.
inline std::vector<Vec3> lattice_points(Lattice lattice, int n, double spacing, double& edge) {
  std::vector<Vec3> basis{{0, 0, 0}};
  double a = spacing;
  if (lattice == Lattice::body_centred) {
    a = 2 * spacing / std::sqrt(3.0);
    basis.push_back({0.5, 0.5, 0.5});
  } else if (lattice == Lattice::face_centred) {
    a = spacing * std::sqrt(2.0);
    basis.insert(basis.end(), {{0.5, 0.5, 0}, {0.5, 0, 0.5}, {0, 0.5, 0.5}});
  }
  std::vector<Vec3> points;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
      for (int k = 0; k < n; ++k)
        for (const Vec3& b : basis) points.push_back(a * (Vec3(i, j, k) + b));
  edge = n * a;
  return points;
}

/// Makes the cell of the setup a periodic cube at the origin.
inline void make_periodic(Setup& s, double edge) {
  s.container.shape = dem::ContainerShape::periodic;
  s.cell.periodic = true;
  s.cell.h = edge * Mat3::Identity();
}

/// A periodic crystal of equal spheres.
inline void fill_periodic(Setup& s, Lattice lattice, int n, double spacing, double radius) {
  double edge;
  for (const Vec3& x : lattice_points(lattice, n, spacing, edge))
    add_sphere(s.particles, x + Vec3::Constant(0.25 * edge / n), radius, Vec3::Zero());
  make_periodic(s, edge);
}

/// A free FCC cluster of overlapping spheres, shaken, with radii spread by +-15 %.
inline void fill_cluster(Setup& s, int n, double spacing, double radius, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> u(-1, 1);
  double edge;
  for (const Vec3& x : lattice_points(Lattice::face_centred, n, spacing, edge))
    add_sphere(s.particles, x + 0.03 * radius * Vec3(u(random), u(random), u(random)), radius * (1 + 0.15 * u(random)),
               Vec3::Zero());
}

/// Random velocities up to `speed` with no total momentum, for equal masses.
inline void shake(Particles& p, double speed, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> u(-1, 1);
  Vec3 mean = Vec3::Zero();
  for (auto& b : p.body) {
    b.velocity = speed * Vec3(u(random), u(random), u(random));
    mean += b.velocity / double(p.size());
  }
  for (auto& b : p.body) b.velocity -= mean;
}

/// What the normal law of pair k sees at the present state, without thermal growth and at rest in time.
inline dem::NormalInput normal_input(const Simulation& sim, std::size_t k) {
  const auto& state = sim.state();
  const auto& list = state.contacts;
  const auto& model = sim.setup().contact;
  const dem::Body &a = state.particles.body[list.i(k)], &b = state.particles.body[list.j(k)];
  Vec3 branch = b.position - a.position, v = b.velocity - a.velocity;
  if (state.cell.periodic) {
    branch += state.cell.shift(list.image(k));
    v += state.cell.velocity_gradient * branch;
  }
  dem::NormalInput in;
  in.overlap = branch.norm() - a.radius - b.radius;
  in.rate = v.dot(branch.normalized());
  in.elastic_radius = elastic_radius(model, a.radius, b.radius);
  in.sintering_radius = model.sintering ? sintering_radius(model.sintering->radius, a.radius, b.radius) : 0;
  in.reduced_mass = 1 / (a.inverse_mass + b.inverse_mass);
  in.time = state.time;
  return in;
}

/// Joins every overlapping pair by a neck of the given phase that is free of stress now.
inline void bond_all(Simulation& sim, dem::NeckPhase phase, double neck_over_radius) {
  auto& state = sim.mutable_state();
  auto& list = state.contacts;
  list.neck.assign(list.size(), dem::NeckHistory{});
  for (std::size_t k = 0; k < list.size(); ++k) {
    const auto in = normal_input(sim, k);
    if (in.overlap < 0) list.neck[k] = {neck_over_radius * in.sintering_radius, 0, 0, phase};
  }
}

/// Place in memory of the particle with number `id`.
inline std::size_t place(const Particles& p, std::uint32_t id) {
  for (std::size_t q = 0; q < p.size(); ++q)
    if (p.id[q] == id) return q;
  return p.size();
}

inline const dem::Body& body(const Simulation& sim, std::uint32_t id) {
  return sim.state().particles.body[place(sim.state().particles, id)];
}

inline Vec3 momentum(const Particles& p) {
  Vec3 sum = Vec3::Zero();
  for (const auto& b : p.body) sum += b.velocity / b.inverse_mass;
  return sum;
}

/// Orbital and spin angular momentum about the origin [kg m^2/s].
inline Vec3 angular_momentum(const Particles& p) {
  Vec3 sum = Vec3::Zero();
  for (std::size_t q = 0; q < p.size(); ++q) {
    const auto& b = p.body[q];
    sum += b.position.cross(b.velocity) / b.inverse_mass;
    if (!p.angular_velocity.empty()) sum += 0.4 * b.radius * b.radius / b.inverse_mass * p.angular_velocity[q];
  }
  return sum;
}

inline double kinetic_energy(const Particles& p) {
  double sum = 0;
  for (std::size_t q = 0; q < p.size(); ++q) {
    const auto& b = p.body[q];
    sum += 0.5 * b.velocity.squaredNorm() / b.inverse_mass;
    if (!p.angular_velocity.empty())
      sum += 0.2 * b.radius * b.radius / b.inverse_mass * p.angular_velocity[q].squaredNorm();
  }
  return sum;
}

/// Root of the summed squared distances from the mean centre [m].
inline double gyration(const Particles& p) {
  Vec3 mean = Vec3::Zero();
  for (const auto& b : p.body) mean += b.position / double(p.size());
  double sum = 0;
  for (const auto& b : p.body) sum += (b.position - mean).squaredNorm();
  return std::sqrt(sum);
}

inline double elastic_energy(const dem::Recording& record) {
  double sum = 0;
  for (const auto& c : record.contact) sum += c.elastic_energy;
  for (const auto& c : record.wall) sum += c.elastic_energy;
  return sum;
}

/// (6.10) with tension positive: sum over contacts of force on i times branch from i to j, over the volume [Pa].
inline Mat3 contact_stress(const Simulation& sim, const dem::Recording& record, double volume) {
  Mat3 sum = Mat3::Zero();
  const auto& state = sim.state();
  for (std::size_t k = 0; k < record.contact.size(); ++k) {
    if (!record.contact[k].touching) continue;
    Vec3 branch =
        state.particles.body[state.contacts.j(k)].position - state.particles.body[state.contacts.i(k)].position;
    if (state.cell.periodic) branch += state.cell.shift(state.contacts.image(k));
    sum += record.contact[k].force * branch.transpose();
  }
  return sum / volume;
}

}  // namespace densify::test
