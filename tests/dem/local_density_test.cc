// Local densities: Voronoi cells of crystals in closed form, of unlike spheres by their radical plane, and a room that
// the cells fill.

#include "dem/measure/local_density.h"

#include <gtest/gtest.h>

#include "tests/support/setups.h"

namespace densify::test {
namespace {

using dem::Cell;
using dem::PowderRoom;
using dem::Walls;

constexpr double radius = 2e-6;

double sphere(double r) {
  return 4.0 / 3 * M_PI * r * r * r;
}

/// Unequal spheres at random places of a cube at the origin.
Particles random_spheres(std::size_t number, double edge) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> u(0, 1);
  Particles p;
  for (std::size_t k = 0; k < number; ++k) {
    const double x = u(random), y = u(random), z = u(random), size = u(random);
    add_sphere(p, edge * Vec3(x, y, z), edge * (0.03 + 0.12 * size * size), Vec3::Zero());
  }
  return p;
}

double sum(const std::vector<double>& values) {
  double s = 0;
  for (const double v : values) s += v;
  return s;
}

// Every cell of a crystal is the volume of the cell over its points, whichever edges of the lattice make the cell and
// however it is turned: 1e-9, since Voro++ takes points within 1e-11 for one.
TEST(LocalDensity, CellsOfCrystals) {
  const Mat3 turn = Eigen::AngleAxisd(0.7, Vec3(1, 2, -1).normalized()).toRotationMatrix();
  Mat3 other_edges = Mat3::Identity();
  other_edges(0, 1) = other_edges(1, 2) = 1;
  for (const Lattice lattice : {Lattice::simple_cubic, Lattice::body_centred, Lattice::face_centred})
    for (const bool turned : {false, true}) {
      dem::Setup s = empty_setup(copper(), elastic_model(dem::Elasticity::linear, 1), hold(1, 300, 0));
      fill_periodic(s, lattice, 3, 2 * radius * 0.98, radius);
      if (turned) {
        s.cell.h = turn * s.cell.h * other_edges;
        for (auto& b : s.particles.body) b.position = turn * b.position;
      }
      const PowderRoom room = powder_room(s.particles, s.cell, Walls{});
      const double expected = s.cell.volume() / double(s.particles.size());
      for (const double v : voronoi_volumes(s.particles, s.cell, room))
        ASSERT_NEAR(v / expected, 1, 1e-9) << int(lattice) << turned;
      EXPECT_NEAR(powder_density(s.particles, room), sphere(radius) / expected, 1e-12);
    }
}

// The radical plane of spheres r1, r2 at distance d is (d^2 + r1^2 - r2^2)/(2 d) from the first.
TEST(LocalDensity, RadicalPlaneOfTwoSpheres) {
  constexpr double r1 = 3e-6, r2 = 1e-6, d = 3.5e-6;
  Particles p;
  add_sphere(p, Vec3(3e-6, 3e-6, 3e-6), r1, Vec3::Zero());
  add_sphere(p, Vec3(3e-6, 3e-6, 3e-6 + d), r2, Vec3::Zero());
  const PowderRoom room = powder_room(p, Cell{}, Walls{});
  EXPECT_NEAR(room.volume / (6e-6 * 6e-6 * (r1 + d + r2)), 1, 1e-12);
  const auto v = voronoi_volumes(p, Cell{}, room);
  const double plane = (d * d + r1 * r1 - r2 * r2) / (2 * d);
  EXPECT_NEAR(v[0] / (6e-6 * 6e-6 * (r1 + plane)), 1, 1e-9);
  EXPECT_NEAR(v[1] / (6e-6 * 6e-6 * (d - plane + r2)), 1, 1e-9);
}

// The cells fill a periodic cell and a box; a cylinder's planes are outside of it, here of few large spheres by 3 %.
TEST(LocalDensity, CellsFillTheRoom) {
  constexpr double edge = 1e-5;
  Particles p = random_spheres(200, edge);
  Cell cell;
  cell.periodic = true;
  cell.h = edge * Mat3::Identity();
  EXPECT_NEAR(sum(voronoi_volumes(p, cell, powder_room(p, cell, Walls{}))) / cell.volume(), 1, 1e-9);
  Walls box({{"bottom", dem::WallShape::plane, Vec3::Zero(), Vec3::UnitZ(), 0, Vec3::Zero(), 0},
             {"punch", dem::WallShape::plane, Vec3(0, 0, edge), -Vec3::UnitZ(), 0, Vec3::Zero(), 0},
             {"wall x-", dem::WallShape::plane, Vec3::Zero(), Vec3::UnitX(), 0, Vec3::Zero(), 0},
             {"wall x+", dem::WallShape::plane, Vec3(edge, 0, 0), -Vec3::UnitX(), 0, Vec3::Zero(), 0},
             {"wall y-", dem::WallShape::plane, Vec3::Zero(), Vec3::UnitY(), 0, Vec3::Zero(), 0},
             {"wall y+", dem::WallShape::plane, Vec3(0, edge, 0), -Vec3::UnitY(), 0, Vec3::Zero(), 0}},
            {});
  const PowderRoom in_box = powder_room(p, Cell{}, box);
  EXPECT_NEAR(in_box.volume / (edge * edge * edge), 1, 1e-12);
  EXPECT_NEAR(sum(voronoi_volumes(p, Cell{}, in_box)) / in_box.volume, 1, 1e-9);

  Particles inside;
  for (const auto& b : p.body) {
    const Vec3 x = b.position - Vec3(0.5 * edge, 0.5 * edge, 0);
    if (x.head<2>().norm() < 0.45 * edge) add_sphere(inside, x, b.radius, Vec3::Zero());
  }
  Walls die({{"die", dem::WallShape::cylinder, Vec3::Zero(), Vec3::UnitZ(), 0.5 * edge, Vec3::Zero(), 0}}, {});
  const PowderRoom in_die = powder_room(inside, Cell{}, die);
  const double filled = sum(voronoi_volumes(inside, Cell{}, in_die)) / in_die.volume;
  EXPECT_GT(filled, 1);
  EXPECT_LT(filled, 1.04);
}

// A particle counts with what it touches, spheres over cells; one that touches nothing counts alone.
TEST(LocalDensity, OfAParticleAndItsContacts) {
  dem::Setup s = empty_setup(copper(), elastic_model(dem::Elasticity::linear, 1), hold(1, 300, 0));
  constexpr double edge = 1.2e-5;
  add_sphere(s.particles, Vec3(2e-6, 6e-6, 6e-6), 2e-6, Vec3::Zero());
  add_sphere(s.particles, Vec3(5e-6, 6e-6, 6e-6), 1.5e-6, Vec3::Zero());
  add_sphere(s.particles, Vec3(9e-6, 6e-6, 6e-6), 1e-6, Vec3::Zero());
  make_periodic(s, edge);
  Simulation sim(s);
  const auto& state = sim.state();
  const PowderRoom room = powder_room(state.particles, state.cell, state.walls);
  const auto own = voronoi_volumes(state.particles, state.cell, room);
  const auto local = local_densities(state.particles, state.cell, room, state.contacts);
  const std::size_t a = place(state.particles, 0), b = place(state.particles, 1), c = place(state.particles, 2);
  const double both = (sphere(2e-6) + sphere(1.5e-6)) / (own[a] + own[b]);
  EXPECT_NEAR(local[a] / both, 1, 1e-12);
  EXPECT_NEAR(local[b] / both, 1, 1e-12);
  EXPECT_NEAR(local[c] / (sphere(1e-6) / own[c]), 1, 1e-12);
}

}  // namespace
}  // namespace densify::test
