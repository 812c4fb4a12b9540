#include "dem/measure/local_density.h"

#include <Eigen/QR>
#include <cmath>
#include <limits>
#include <voro++/voro++.hh>

namespace densify::dem {

namespace {

constexpr int memory_of_block = 8;  // particles, at first

double sphere_volume(double r) {
  return 4.0 / 3 * M_PI * r * r * r;
}

/// Blocks of Voro++ along an edge: its optimum of particles in each, for edges of one room.
int blocks(double edge, double volume, std::size_t particles) {
  const double size = std::cbrt(volume * voro::optimal_particles / double(particles));
  return std::max(1, int(edge / size));
}

template <class Container>
std::vector<double> volumes_of(Container& container, std::size_t particles, double unit) {
  std::vector<double> volume(particles, 0.0);  // 0: a small sphere whose surroundings leave it nothing
  voro::voronoicell cell;
  if constexpr (std::is_same_v<Container, voro::container_periodic_poly>) {
    voro::c_loop_all_periodic loop(container);
    if (!loop.start()) return volume;
    do {
      if (container.compute_cell(cell, loop)) volume[std::size_t(loop.pid())] = unit * unit * unit * cell.volume();
    } while (loop.inc());
  } else {
    voro::c_loop_all loop(container);
    if (!loop.start()) return volume;
    do {
      if (container.compute_cell(cell, loop)) volume[std::size_t(loop.pid())] = unit * unit * unit * cell.volume();
    } while (loop.inc());
  }
  return volume;
}

}  // namespace

PowderRoom powder_room(const Particles& particles, const Cell& cell, const Walls& walls) {
  PowderRoom room;
  if (cell.periodic) {
    room.volume = cell.volume();
    return room;
  }
  constexpr double infinity = std::numeric_limits<double>::infinity();
  room.low.setConstant(infinity), room.high.setConstant(-infinity);
  double furthest = 0;  // from the axis
  for (const Body& b : particles.body) {
    room.low = room.low.cwiseMin(b.position - Vec3::Constant(b.radius));
    room.high = room.high.cwiseMax(b.position + Vec3::Constant(b.radius));
    furthest = std::max(furthest, b.position.head<2>().norm() + b.radius);
  }
  for (const Wall& w : walls.wall) {
    if (w.shape == WallShape::cylinder) {
      room.round = true;
      const double radius = std::min(furthest, w.radius);
      room.low.head<2>().setConstant(-radius), room.high.head<2>().setConstant(radius);
      continue;
    }
    for (int axis = 0; axis < 3; ++axis) {
      if (w.normal[axis] > 0.5) room.low[axis] = std::max(room.low[axis], w.point[axis]);
      if (w.normal[axis] < -0.5) room.high[axis] = std::min(room.high[axis], w.point[axis]);
    }
  }
  room.volume = (room.high - room.low).prod() * (room.round ? 0.25 * M_PI : 1.0);
  return room;
}

double powder_density(const Particles& particles, const PowderRoom& room) {
  double solid = 0;
  for (const Body& b : particles.body) solid += sphere_volume(b.radius);
  return solid / room.volume;
}

std::vector<double> voronoi_volumes(const Particles& particles, const Cell& cell, const PowderRoom& room) {
  const std::size_t n = particles.size();
  const double unit = std::cbrt(room.volume / double(n));  // Voro++ has lengths of about 1 in mind
  const auto scaled = [&](const Vec3& x) { return Vec3(x / unit); };
  if (cell.periodic) {
    // The same cell turned so that its edges are a lower triangle, as Voro++ wants it.
    Mat3 edges = Mat3(cell.h / unit).householderQr().matrixQR().triangularView<Eigen::Upper>();
    for (int k = 0; k < 3; ++k)
      if (edges(k, k) < 0) edges.row(k) *= -1;
    const auto along = [&](int k) { return blocks(unit * edges(k, k), room.volume, n); };
    voro::container_periodic_poly container(edges(0, 0), edges(0, 1), edges(1, 1), edges(0, 2), edges(1, 2),
                                            edges(2, 2), along(0), along(1), along(2), memory_of_block);
    const Mat3 to_fraction = cell.h.inverse();
    for (std::size_t p = 0; p < n; ++p) {
      const Vec3 x = edges * (to_fraction * (particles.body[p].position - cell.origin));
      container.put(int(p), x[0], x[1], x[2], particles.body[p].radius / unit);
    }
    return volumes_of(container, n, unit);
  }
  const Vec3 low = scaled(room.low), high = scaled(room.high);
  const auto along = [&](int k) { return blocks(unit * (high[k] - low[k]), room.volume, n); };
  voro::container_poly container(low[0], high[0], low[1], high[1], low[2], high[2], along(0), along(1), along(2), false,
                                 false, false, memory_of_block);
  voro::wall_cylinder round(0, 0, 0, 0, 0, 1, high[0]);
  if (room.round) container.add_wall(round);
  for (std::size_t p = 0; p < n; ++p) {
    const Vec3 x = scaled(particles.body[p].position);
    container.put(int(p), x[0], x[1], x[2], particles.body[p].radius / unit);
  }
  return volumes_of(container, n, unit);
}

std::vector<double> local_densities(const Particles& particles, const Cell& cell, const PowderRoom& room,
                                    const ContactList& list) {
  const std::vector<double> own = voronoi_volumes(particles, cell, room);
  std::vector<double> solid(particles.size()), space = own;
  for (std::size_t p = 0; p < particles.size(); ++p) solid[p] = sphere_volume(particles.body[p].radius);
  const ImageShifts shifts(cell);
  for (std::size_t k = 0; k < list.size(); ++k) {
    const std::uint32_t i = list.i(k), j = list.j(k);
    if (i == j) continue;
    const Body &a = particles.body[i], &b = particles.body[j];
    const double reach = a.radius + b.radius;
    const bool necked = !list.neck.empty() && list.neck[k].phase != NeckPhase::loose;
    if (!necked && (b.position - a.position + shifts[list.image(k)]).squaredNorm() >= reach * reach) continue;
    solid[i] += sphere_volume(b.radius), space[i] += own[j];
    solid[j] += sphere_volume(a.radius), space[j] += own[i];
  }
  for (std::size_t p = 0; p < solid.size(); ++p) solid[p] = space[p] > 0 ? solid[p] / space[p] : 1.0;
  return solid;
}

}  // namespace densify::dem
