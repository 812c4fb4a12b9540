#include "dem/powder/compaction.h"

#include <algorithm>
#include <cmath>

#include "base/check.h"
#include "dem/powder/placement.h"

namespace densify::dem {

namespace {

// Reduced units: a particle of mean radius weighs 1 kg, every spring is 1 N/m, so a pair swings once in four seconds.
// Masses go with the surface, as the number of contacts does: one step then suits large and small particles alike. Slow
// against that: walls that take `closing` seconds, gravity that presses a column of the specimen's height by about a
// thousandth of a radius.
constexpr double closing = 6000, settling = 3000, rest_of_overlap_check = 1000;
constexpr double weight_per_column = 1e-3;

double solid(std::span<const double> diameters) {
  double v = 0;
  for (double d : diameters) v += M_PI / 6 * d * d * d;
  return v;
}

Setup packing_setup(const CompactionGoal& goal, std::size_t materials, int threads) {
  Setup s{
      {}, {},
      {}, {},
      {}, Schedule(300, 0, {{"closing", closing, 300, 0}, {"settling", settling + 20 * rest_of_overlap_check, 300, 0}}),
      {}, 300,
      {}, {}};
  Material any;
  any.density = 1;
  s.materials.assign(materials, any);
  s.contact.elasticity = Elasticity::linear;
  s.contact.normal_stiffness = 1;
  s.contact.damping_ratio = 0.3;
  if (goal.friction > 0) s.contact.friction = FrictionModel{goal.friction, goal.friction, 2.0 / 7, 0.2};
  s.container = goal.container;
  s.container.punch = false;  // the punch is moved, not loaded
  s.container.wall_expansion = 0;
  s.integration.step_safety = 0.5;
  s.integration.drag = 0.01;
  s.integration.skin = 0.3;
  s.integration.threads = threads;
  return s;
}

/// Mean overlap of touching pairs and the coordination number.
void measure_contacts(const State& state, GreenBody& body, double mean_radius) {
  std::size_t touching = 0;
  double overlap = 0;
  const auto& list = state.contacts;
  for (std::size_t k = 0; k < list.size(); ++k) {
    const Body &a = state.particles.body[list.i(k)], &b = state.particles.body[list.j(k)];
    Vec3 branch = b.position - a.position;
    if (state.cell.periodic) branch += state.cell.shift(list.image(k));
    const double u = a.radius + b.radius - branch.norm();
    if (u <= 0) continue;
    ++touching;
    overlap += u;
  }
  body.coordination_number = 2 * double(touching) / double(state.particles.size());
  body.mean_overlap = touching ? overlap / double(touching) / mean_radius : 0;
}

}  // namespace

GreenBody compact(std::span<const double> diameters, std::span<const std::uint8_t> materials,
                  const CompactionGoal& goal, int threads, const PackingProgress& progress) {
  const std::size_t n = diameters.size();
  const bool periodic = goal.container.shape == ContainerShape::periodic;
  const bool round = goal.container.shape == ContainerShape::cylinder;
  const double volume = solid(diameters);
  double mean_radius = 0;
  for (double d : diameters) mean_radius += 0.5 * d / double(n);

  // Final container; the loose one is wider, so that the lateral walls move inward too.
  Container target = goal.container;
  constexpr double widening = 1.15;
  PlacementContainer loose = PeriodicContainer{Vec3::Ones()};
  const Vec3& size = goal.container.size;
  if (round) {
    target.size[2] = volume / (goal.green_density * 0.25 * M_PI * size[0] * size[0]);
    loose = CylinderContainer{widening * size[0]};
  } else if (!periodic) {
    target.size[2] = volume / (goal.green_density * size[0] * size[1]);
    loose = BoxContainer{widening * size[0], widening * size[1]};
  } else if (size.prod() > 0) {
    loose = PeriodicContainer{size};
  }
  const Placement placed = place_loosely(diameters, loose, goal.seed);

  Setup setup = packing_setup(goal, 1 + *std::max_element(materials.begin(), materials.end()), threads);
  setup.container.size = placed.extent;
  if (round) setup.container.size = Vec3(widening * size[0], widening * size[0], placed.extent[2]);
  const double column = placed.extent[2] / (2 * mean_radius);
  if (!periodic) setup.integration.gravity = Vec3(0, 0, -weight_per_column * mean_radius / column);
  if (periodic) {
    const double target_edge_ratio = std::cbrt(placed.solid_fraction / goal.green_density);
    setup.cell.periodic = true;
    setup.cell.h = placed.extent.asDiagonal();
    setup.cell.velocity_gradient = std::log(target_edge_ratio) / closing * Mat3::Identity();
  }
  for (std::size_t p = 0; p < n; ++p) {
    setup.particles.body.push_back({placed.position[p], 0.5 * diameters[p], Vec3::Zero(), 1});
    setup.particles.reference_radius.push_back(0.5 * diameters[p]);
    setup.particles.material.push_back(materials[p]);
    setup.particles.id.push_back(std::uint32_t(p));
  }

  Simulation sim(setup);
  State& state = sim.mutable_state();
  for (auto& b : state.particles.body) b.inverse_mass = mean_radius * mean_radius / (b.radius * b.radius);

  auto place_walls = [&](double share) {  // between the loose container and the target, with their velocities
    const double speed = share < 1 ? 1 / closing : 0;
    for (auto& w : state.walls.wall) {
      if (w.shape == WallShape::cylinder) {
        const double from = 0.5 * widening * size[0], to = 0.5 * size[0];
        w.radius = from + share * (to - from);
        w.radius_rate = speed * (to - from);
      } else if (w.name == "punch") {
        const double from = placed.extent[2], to = target.size[2];
        w.point[2] = from + share * (to - from);
        w.velocity[2] = speed * (to - from);
      } else if (w.normal[2] < 0.5) {
        const int axis = std::abs(w.normal[0]) > 0.5 ? 0 : 1;
        const double over = 0.5 * (widening - 1) * size[axis];  // the loose box is centred on the final one
        const double from = w.normal[axis] > 0 ? -over : size[axis] + over, to = w.normal[axis] > 0 ? 0 : size[axis];
        w.point[axis] = from + share * (to - from);
        w.velocity[axis] = speed * (to - from);
      }
    }
  };
  if (!round && !periodic)  // placement counts from its own corner
    for (auto& b : state.particles.body)
      b.position -= Vec3(0.5 * (widening - 1) * size[0], 0.5 * (widening - 1) * size[1], 0);

  GreenBody body;
  body.container = target;
  double next_check = closing + settling;
  double before = 0;
  while (true) {
    const double share = std::min(1.0, state.time / closing);
    if (!periodic) place_walls(share);
    if (share >= 1 && !setup.integration.gravity.isZero(0)) {
      sim.set_gravity(Vec3::Zero());
      setup.integration.gravity.setZero();
    }
    if (share >= 1 && periodic) state.cell.velocity_gradient.setZero();
    if (state.time >= next_check) {
      measure_contacts(state, body, mean_radius);
      if (body.mean_overlap <= goal.largest_overlap || sim.finished() || body.mean_overlap > 0.98 * before) break;
      before = body.mean_overlap;
      next_check += rest_of_overlap_check;
    }
    sim.advance();
    if (state.steps % 200 == 0 && progress) progress(std::min(1.0, state.time / (closing + settling)));
  }
  if (body.mean_overlap > goal.largest_overlap)
    throw InputError("specimen.packing.green_density: " + std::to_string(goal.green_density) +
                     " is not reachable: the spheres overlap by " + std::to_string(100 * body.mean_overlap) +
                     " % of the mean radius (at most " + std::to_string(100 * goal.largest_overlap) +
                     " %); lower green_density or friction, or allow more with largest_overlap");

  body.particles = state.particles;
  for (auto& b : body.particles.body) b.velocity.setZero();
  body.particles.angular_velocity.clear();
  body.particles.torque.clear();
  body.cell = state.cell;
  if (periodic) body.container.size = state.cell.h.diagonal();
  body.relative_density = volume / (periodic ? state.cell.volume() : (round ? 0.25 * M_PI : 1.0) * target.size.prod());
  body.steps = state.steps;
  return body;
}

}  // namespace densify::dem
