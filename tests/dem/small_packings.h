#pragma once
// Packings of several dozen particles that use every feature of the state: friction, necks, thermal expansion, walls
// and punch, or a sheared periodic cell.  Activation falls into the run.

#include <random>

#include "dem/simulation.h"

namespace densify::dem::testing {

inline Material warm_powder(const char* name, double density) {
  Material m;
  m.name = name;
  m.density = density;
  m.thermal_expansion = 1.15e-5;
  m.youngs_modulus = PiecewiseLinear({{300.0, 180e9}, {1700.0, 120e9}});
  m.poissons_ratio = PiecewiseLinear({{300.0, 0.3}, {1700.0, 0.33}});
  m.diffusion = {1.2e-29, 2.67e-2, 100e3, 0.5e-9};
  m.surface_energy = 1.57;
  m.dihedral_angle = 2.6;
  m.activation_temperature = 955;
  return m;
}

inline Setup common_setup(int threads) {
  const Schedule schedule(953, 0, {{"press", 0.05, 954, 30e6}, {"heat", 0.1, 958, 30e6}, {"hold", 10, 958, 30e6}});
  Setup s{{}, {}, {}, {}, {}, schedule, {}, 293.15, {}, {}};
  s.materials = {warm_powder("soft", 5900), warm_powder("hard", 4000)};
  Interface mixed;
  mixed.a = 0, mixed.b = 1;
  mixed.diffusion = s.materials[0].diffusion;
  mixed.surface_energy = 0.8;
  mixed.dihedral_angle = 2.4;
  s.interfaces = {mixed};
  s.contact.friction = FrictionModel{0.2, 0.1, 2.0 / 7.0, 0};
  s.contact.sintering = SinteringSettings{};
  s.contact.sintering->relaxation_time = 0.05;
  s.integration.mass_scaling = 1e12;
  s.integration.skin = 0.02;  // small, so that the list is built several times
  s.integration.threads = threads;
  return s;
}

/// Adds an nx x ny x nz lattice of slightly different spheres at `spacing`, each moved and spun a little [m].
inline void add_lattice(Setup& s, Eigen::Vector3i counts, double spacing, const Vec3& corner, double rho_max) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> unit(-1, 1);
  auto any = [&] {
    const double x = unit(random), y = unit(random), z = unit(random);
    return Vec3(x, y, z);
  };
  for (int x = 0; x < counts[0]; ++x)
    for (int y = 0; y < counts[1]; ++y)
      for (int z = 0; z < counts[2]; ++z) {
        const Vec3 at = corner + spacing * Vec3(x + 0.5, y + 0.5, z + 0.5);
        if (at.head<2>().norm() > rho_max) continue;
        Particles& p = s.particles;
        p.body.push_back({at + 0.002 * spacing * any(), 0, 1e-7 * any(), 0});
        p.reference_radius.push_back(spacing * (0.501 + 0.004 * unit(random)));
        p.material.push_back(std::uint8_t((x + y + z) % 2));
        p.id.push_back(std::uint32_t(p.id.size()));
        p.angular_velocity.push_back(0.1 * any());
      }
}

inline Setup periodic_packing(int threads) {
  Setup s = common_setup(threads);
  add_lattice(s, {4, 4, 4}, 4e-6, Vec3::Zero(), 1);
  s.container.shape = ContainerShape::periodic;
  s.cell.periodic = true;
  s.cell.h = 16e-6 * Mat3::Identity();
  s.cell.velocity_gradient << -0.02, 0.05, 0, 0, -0.02, 0, 0, 0, -0.03;
  return s;
}

/// The periodic packing with stresses and rates that drive its cell.
inline Setup driven_packing(int threads) {
  Setup s = periodic_packing(threads);
  s.cell.velocity_gradient.setZero();
  CellGoals goals;
  for (std::size_t c = 0; c < 2; ++c) goals[c] = {CellControl::stress, -30e6};
  goals[2] = {CellControl::rate, -0.03};
  goals[3] = {CellControl::rate, 0.05};
  s.cell_path = CellPath{{}, {goals, goals, goals}};
  return s;
}

inline Setup cylinder_packing(int threads) {
  Setup s = common_setup(threads);
  add_lattice(s, {4, 4, 4}, 4e-6, Vec3(-8e-6, -8e-6, 0), 7e-6);
  s.container.shape = ContainerShape::cylinder;
  s.container.punch_settings.mass_fraction = 0.2;  // steps long enough to reach activation in a few hundred
  s.container.size = Vec3(16.7e-6, 16.7e-6, 16.02e-6);
  s.container.wall_expansion = 5e-6;
  return s;
}

/// Packings whose pores resist from the first necks on.
inline Setup closing_packing(int threads) {
  Setup s = driven_packing(threads);
  s.contact.sintering->closing_porosity = 0.6;
  return s;
}
inline Setup closing_cylinder(int threads) {
  Setup s = cylinder_packing(threads);
  s.contact.sintering->closing_porosity = 0.6;
  return s;
}

inline void run_steps(Simulation& simulation, int steps) {
  for (int k = 0; k < steps; ++k) simulation.advance();
}

/// Every bit of a state that a trajectory depends on, in one string.
class StateBits {
 public:
  explicit StateBits(const State& s) {
    const Particles& p = s.particles;
    add(p.body), add(p.reference_radius), add(p.material), add(p.id), add(p.force), add(p.angular_velocity);
    add(p.torque), add(s.cell.h), add(s.cell.origin), add(s.cell.velocity_gradient), add(s.cell.periodic);
    const ContactList& c = s.contacts;
    add(c.first), add(c.second), add(c.tangential), add(c.reference_position), add(c.reference_h);
    add(c.reference_expansion), add(c.skin), add(c.largest_radius), add(c.builds);
    for (const auto& b : c.buckets) add(b.begin), add(b.end), add(b.material_a), add(b.material_b);
    for (const auto& h : c.neck) add(h.radius), add(h.elastic), add(h.since), add(h.phase);
    for (const auto* walls : {&s.walls.wall, &s.walls.reference()})
      for (const auto& w : *walls)
        add(w.shape), add(w.point), add(w.normal), add(w.radius), add(w.velocity), add(w.radius_rate), bits_ += w.name;
    for (const auto& w : s.walls.contacts()) add(w.particle), add(w.wall), add(w.tangential);
    add(s.punch), add(s.expansion), add(s.temperature), add(s.time), add(s.last_step), add(s.stable_step);
    add(s.critical_step), add(s.steps), add(s.inertia_free), add(s.active_since), add(s.control.strain_rate);
    add(s.control.inertial_number), add(s.cell_drive);
    add(s.local_density.of), add(s.local_density.powder), add(s.local_density.builds);
  }
  bool operator==(const StateBits&) const = default;
  std::size_t size() const { return bits_.size(); }

 private:
  template <class T>
  void add(const T& value) {
    bits_.append(reinterpret_cast<const char*>(&value), sizeof value);
  }
  template <class T>
  void add(const std::vector<T>& values) {
    add(values.size());
    bits_.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
  }
  std::string bits_;
};

}  // namespace densify::dem::testing
