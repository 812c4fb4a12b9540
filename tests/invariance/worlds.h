#pragma once
// The worlds that invariance is tried on: each uses other parts of the model, none is symmetric.

#include "tests/support/setups.h"

namespace densify::test {

enum class World { frictional, sintering, bonded };

inline const World all_worlds[] = {World::frictional, World::sintering, World::bonded};

/// A free cluster of 32 unequal spheres, shaken: flying together with friction, sintering from small necks, or bonded.
inline Setup make_world(World world) {
  constexpr double radius = 5e-6;
  auto contact = elastic_model(dem::Elasticity::hertz, dem::unset);
  contact.damping_ratio = 0.2;
  if (world == World::frictional) contact.friction = dem::FrictionModel{0.4, 0.4, 2.0 / 7, 0.1};
  if (world != World::frictional) {
    contact.sintering = dem::SinteringSettings{};
    contact.sintering->relaxation_time = 5;
  }
  auto material = nickel_aluminide();
  const double temperature = world == World::sintering ? 1500 : 400;
  const Schedule schedule(temperature, 0, {{"heat", 1e4, temperature + (world == World::frictional ? 0 : 100), 0}});
  Setup s = empty_setup(material, contact, schedule);
  fill_cluster(s, 2, (world == World::frictional ? 2.3 : 1.97) * radius, radius, 29);
  s.integration.mass_scaling = world == World::frictional ? 1 : 1e14;
  shake(s.particles, world == World::frictional ? 0.1 : 1e-9, 31);
  if (world == World::frictional)
    for (std::size_t p = 0; p < s.particles.size(); ++p) {
      s.particles.body[p].velocity += 3e5 * (Vec3::Constant(1.2e-5) - s.particles.body[p].position);
      s.particles.angular_velocity.push_back(2e4 * Vec3(std::sin(double(p)), std::cos(2.0 * double(p)), 0.3));
    }
  return s;
}

/// Joins the overlapping spheres by necks free of stress where the world has necks.
inline void begin_world(World world, Simulation& sim) {
  if (world == World::bonded) bond_all(sim, dem::NeckPhase::dormant, 0.3);
  if (world == World::sintering) bond_all(sim, dem::NeckPhase::activating, 0.1);
}

inline Simulation run_world(World world, Setup s, int steps) {
  Simulation sim(std::move(s));
  begin_world(world, sim);
  for (int n = 0; n < steps; ++n) sim.advance(nullptr);
  return sim;
}

/// Largest distance between two runs' particles, by number, after `map` of the first, over the mean radius.
template <class Map>
double difference(const Simulation& a, const Simulation& b, Map&& map) {
  double worst = 0;
  for (std::uint32_t id = 0; id < a.state().particles.size(); ++id)
    worst = std::max(worst, (map(body(a, id).position) - body(b, id).position).norm() / body(b, id).radius);
  return worst;
}

/// How far the particles have moved against each other, over the radius.
inline double moved(const Setup& start, const Simulation& end) {
  double worst = 0;
  const auto& p = start.particles;
  for (std::uint32_t id = 1; id < p.size(); ++id) {
    const Vec3 before = p.body[id].position - p.body[0].position;
    worst = std::max(worst, (body(end, id).position - body(end, 0).position - before).norm() / p.body[id].radius);
  }
  return worst;
}

}  // namespace densify::test
