#include "dem/measure/envelope.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace densify::dem {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

double sphere_volume(double r) {
  return 4.0 / 3 * M_PI * r * r * r;
}

/// Points spread evenly in the unit ball: a Fibonacci spiral with radii at equal shares of volume.
struct BallPoints {
  static constexpr std::size_t count = 256;
  std::array<double, count> x, y, z;
};

const BallPoints& ball_points() {
  static const auto points = [] {
    BallPoints p;
    const double golden = M_PI * (3 - std::sqrt(5.0));
    const auto n = double(BallPoints::count);
    for (std::size_t k = 0; k < BallPoints::count; ++k) {
      const double z = 1 - (2 * double(k) + 1) / n, rho = std::sqrt(1 - z * z);
      // A second irrational sequence decouples the radius from the direction.
      const double share = std::fmod(0.5 + double(k) * 0.7548776662466927, 1.0);
      p.x[k] = std::cbrt(share) * rho * std::cos(golden * double(k));
      p.y[k] = std::cbrt(share) * rho * std::sin(golden * double(k));
      p.z[k] = std::cbrt(share) * z;
    }
    return p;
  }();
  return points;
}

using Depths = std::array<double, BallPoints::count>;  // of each point in a region, negative outside

/// For points of a ball, one coordinate of it: at most as deep as between two planes.
void lower_to_planes(Depths& depth, const Depths& point, double centre, double r, double low, double high) {
  for (std::size_t k = 0; k < BallPoints::count; ++k) {
    const double x = centre + r * point[k];
    depth[k] = std::min(depth[k], std::min(x - low, high - x));
  }
}

/// And as deep as in a cylinder about the z axis (in squares).
void lower_to_cylinder(Depths& depth, const BallPoints& points, const Vec3& centre, double r, double radius) {
  const double cx = centre[0], cy = centre[1], square = radius * radius;
  for (std::size_t k = 0; k < BallPoints::count; ++k) {
    const double x = cx + r * points.x[k], y = cy + r * points.y[k];
    depth[k] = std::min(depth[k], square - (x * x + y * y));
  }
}

}  // namespace

double mean_diameter(const Simulation& sim) {
  double sum = 0;
  for (double r : sim.state().particles.reference_radius) sum += 2 * r;
  return sum / double(sim.state().particles.size());
}

double solid_volume_now(const Simulation& sim) {
  double v = 0;
  for (const auto& b : sim.state().particles.body) v += sphere_volume(b.radius);
  return v;
}

Envelope measure_envelope(const Simulation& sim) {
  const State& s = sim.state();
  if (s.cell.periodic) return {Vec3(s.cell.h.colwise().norm()), s.cell.volume()};

  Vec3 low = Vec3::Constant(infinity), high = Vec3::Constant(-infinity);
  for (const auto& b : s.particles.body) {
    low = low.cwiseMin(b.position - Vec3::Constant(b.radius));
    high = high.cwiseMax(b.position + Vec3::Constant(b.radius));
  }
  auto touches = [&](const char* name) {
    const auto w = sim.wall(name);
    return w && *w < s.walls.normal_force().size() && s.walls.normal_force()[*w] > 0;
  };
  auto plane = [&](const char* name, int axis) { return s.walls.wall[*sim.wall(name)].point[axis]; };
  if (touches("bottom")) low[2] = plane("bottom", 2);
  if (touches("punch")) high[2] = plane("punch", 2);
  const ContainerShape shape = sim.setup().container.shape;
  if (shape == ContainerShape::box &&
      (touches("wall x-") || touches("wall x+") || touches("wall y-") || touches("wall y+")))
    for (int axis : {0, 1}) {
      low[axis] = plane(axis == 0 ? "wall x-" : "wall y-", axis);
      high[axis] = plane(axis == 0 ? "wall x+" : "wall y+", axis);
    }
  if (touches("die")) {
    const double r = s.walls.wall[*sim.wall("die")].radius;
    low[0] = low[1] = -r;
    high[0] = high[1] = r;
  }
  Envelope e{high - low, 0};
  e.volume = e.size.prod() * (shape == ContainerShape::cylinder ? 0.25 * M_PI : 1.0);
  return e;
}

double relative_density(const Simulation& sim, const Envelope& e) {
  return solid_volume_now(sim) / e.volume;
}

double inner_relative_density(const Simulation& sim, double distance) {
  const State& s = sim.state();
  if (s.cell.periodic) return solid_volume_now(sim) / s.cell.volume();
  if (s.walls.wall.empty()) return unset;
  Vec3 low = Vec3::Constant(-infinity), high = Vec3::Constant(infinity);
  double radius = infinity;
  for (const auto& w : s.walls.wall) {
    if (w.shape == WallShape::cylinder) {
      radius = w.radius - distance;
      continue;
    }
    for (int axis = 0; axis < 3; ++axis) {
      if (w.normal[axis] > 0.5) low[axis] = w.point[axis] + distance;
      if (w.normal[axis] < -0.5) high[axis] = w.point[axis] - distance;
    }
  }
  // A punch that has lifted off must not stretch the region beyond the powder.
  double top = -infinity, base = infinity;
  for (const auto& b : s.particles.body) {
    top = std::max(top, b.position[2] + b.radius);
    base = std::min(base, b.position[2] - b.radius);
  }
  high[2] = std::min(high[2], top - distance);
  low[2] = std::max(low[2], base + distance);
  const bool round = radius < infinity;
  if (high[2] <= low[2] || (round ? radius <= 0 : high[0] <= low[0] || high[1] <= low[1])) return unset;
  const double region = (high[2] - low[2]) * (round ? M_PI * radius * radius : (high[0] - low[0]) * (high[1] - low[1]));

  const BallPoints& points = ball_points();
  double volume = 0;
  for (const auto& b : s.particles.body) {
    const double r = b.radius, x = b.position[0], y = b.position[1], rho = std::sqrt(x * x + y * y);
    const bool beside =
        round ? rho + r <= radius : x - r >= low[0] && x + r <= high[0] && y - r >= low[1] && y + r <= high[1];
    const bool between = b.position[2] - r >= low[2] && b.position[2] + r <= high[2];
    if (beside && between) {
      volume += sphere_volume(r);
      continue;
    }
    if (b.position[2] + r < low[2] || b.position[2] - r > high[2] || (round && rho - r > radius)) continue;
    Depths depth;
    depth.fill(infinity);
    if (!between) lower_to_planes(depth, points.z, b.position[2], r, low[2], high[2]);
    if (!beside && round) lower_to_cylinder(depth, points, b.position, r, radius);
    if (!beside && !round)
      for (int axis : {0, 1})
        lower_to_planes(depth, axis == 0 ? points.x : points.y, b.position[axis], r, low[axis], high[axis]);
    const auto inside = std::count_if(depth.begin(), depth.end(), [](double d) { return d >= 0; });
    volume += sphere_volume(r) * double(inside) / double(BallPoints::count);
  }
  return volume / region;
}

}  // namespace densify::dem
