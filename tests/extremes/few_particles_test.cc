// One particle, two, none in contact, a rattler; and ten million steps.

#include <gtest/gtest.h>

#include <fstream>

#include "dem/run.h"
#include "tests/dem/scratch_folder.h"
#include "tests/extremes/necked_pair.h"
#include "tests/extremes/stopped.h"

namespace densify::test {
namespace {

constexpr double radius = 5e-6;

Setup box(double edge) {
  Setup s = empty_setup(copper(), elastic_model(dem::Elasticity::hertz, dem::unset), hold(1, 300, 0));
  s.container.shape = dem::ContainerShape::box;
  s.container.size = Vec3::Constant(edge);
  s.container.punch = false;
  return s;
}

void expect_finite(Simulation& sim) {
  dem::Recording record;
  sim.evaluate(&record);
  const auto m = measure(sim, record);
  sim.move();
  EXPECT_TRUE(std::isfinite(m.relative_density) && m.relative_density > 0);
  EXPECT_TRUE(m.stress.allFinite() && m.sintering_stress.allFinite());
  EXPECT_EQ(m.coordination_number, 0);
  EXPECT_EQ(m.unbalanced_force_ratio, 0);
  EXPECT_EQ(m.mean_neck_radius, 0);
  EXPECT_EQ(m.equilibrium_fraction, 0);
}

// A free particle flies on by v t: x is the sum of equal steps, which round at 1e-16 each.
TEST(FewParticles, OneAlone) {
  auto s = empty_setup(copper(), elastic_model(dem::Elasticity::hertz, dem::unset), hold(1e-3, 300, 0));
  add_sphere(s.particles, Vec3(1, 2, 3) * radius, radius, Vec3(0.3, -0.2, 0.1));
  Simulation sim(s);
  expect_finite(sim);
  run_at_most(sim, 5000);
  const Vec3 due = Vec3(1, 2, 3) * radius + sim.state().time * Vec3(0.3, -0.2, 0.1);
  EXPECT_LT((body(sim, 0).position - due).norm(), 5000 * 1e-16 * due.norm());
  expect_finite(sim);
}

// Two that never meet, 1e9 radii apart: no contact, no memory for the space between, no force.
TEST(FewParticles, TwoFarApart) {
  auto s = empty_setup(copper(), elastic_model(dem::Elasticity::hertz, dem::unset), hold(1, 300, 0));
  add_sphere(s.particles, Vec3::Zero(), radius, Vec3::Zero());
  add_sphere(s.particles, Vec3(1e9, -1e9, 1e9) * radius, radius, Vec3::Zero());
  Simulation sim(s);
  run_at_most(sim, 1000);
  EXPECT_EQ(body(sim, 1).position, Vec3(Vec3(1e9, -1e9, 1e9) * radius));
  EXPECT_LT(sim.bytes(), 10000u);
}

TEST(FewParticles, NoneInContactInABox) {
  auto s = box(100 * radius);
  for (int i = 0; i < 3; ++i) add_sphere(s.particles, (20 + 20 * i) * Vec3::Constant(radius), radius, Vec3::Zero());
  Simulation sim(s);
  for (int n = 0; n < 3; ++n) {
    expect_finite(sim);
    run_at_most(sim, 200);
  }
}

// A small sphere in an octahedral hole of a pressed crystal, touching nothing: it stays where it is to the last bit,
// and the crystal does not notice.  Thrown, it bounces inside and shares its energy (r^3 of 0.027, so that no large
// sphere can have more than 0.17 of its speed).
TEST(FewParticles, Rattler) {
  for (double speed : {0.0, 1.0}) {
    auto s = empty_setup(copper(), elastic_model(dem::Elasticity::hertz, dem::unset), hold(1, 300, 0));
    const double spacing = 1.999 * radius;
    fill_periodic(s, Lattice::face_centred, 2, spacing, radius);
    const Vec3 centre = s.particles.body[0].position + Vec3(spacing / std::sqrt(2.0), 0, 0);
    add_sphere(s.particles, centre, 0.3 * radius, speed * Vec3(0.6, 0.5, 0.62));
    s.integration.step_safety = 0.05;
    Simulation sim(s);
    const std::uint32_t rattler = 32;
    for (int n = 0; n < 100; ++n) {
      run_at_most(sim, 200);
      const Vec3 moved = body(sim, rattler).position - centre;
      if (speed == 0) {
        EXPECT_EQ(moved, Vec3(Vec3::Zero()));
      } else {
        EXPECT_LT(moved.norm(), 0.5 * radius);  // the room to the spheres around, along the diagonals
      }
      for (std::uint32_t i = 0; i < rattler; ++i) EXPECT_LT(body(sim, i).velocity.norm(), speed == 0 ? 1e-9 : 0.17);
    }
  }
}

// A whole run of the program's kind with one particle under a punch, and with one in the open: rows, summary and
// snapshots hold finite numbers.
TEST(FewParticles, WholeRunOfOne) {
  const dem::testing::ScratchFolder folder;
  std::ofstream(folder / "one.csv") << "x y z radius material\n2 2 1 1 Cu\n";
  for (const char* shape : {"shape = \"box\"\nsize = [\"4 um\", \"4 um\", \"2 um\"]", "shape = \"free\""}) {
    const bool boxed = std::string(shape).find("box") != std::string::npos;
    const std::string text = "[materials.Cu]\nlibrary = \"Cu\"\n[specimen]\n" + std::string(shape) +
                             "\n[specimen.import]\nfile = \"" + (folder / "one.csv").string() +
                             "\"\nlength_unit = \"1 um\"\n[contact]\ndamping_ratio = 0.5\n[process]\n"
                             "start_temperature = \"20 degC\"\n[[process.stage]]\nname = \"press\"\n"
                             "duration = \"10 us\"\n" +
                             (boxed ? "pressure = \"1 MPa\"\n" : "") + "[integration]\nmass_scaling = 1\n";
    dem::RunOptions options;
    options.folder = folder / (boxed ? "boxed" : "free");
    const auto summary = dem::run(dem::read_scene_text(text, {}), options);
    EXPECT_TRUE(std::isfinite(summary.last.relative_density)) << shape;
    const std::string history = dem::testing::content_of(options.folder / "history.csv");
    EXPECT_GT(std::count(history.begin(), history.end(), '\n'), 100);
    EXPECT_EQ(history.find("inf"), std::string::npos) << shape;
  }
}

/// Memory of this process that is in use [B].
std::size_t resident() {
  std::ifstream file("/proc/self/statm");
  std::size_t all = 0, pages = 0;
  file >> all >> pages;
  return pages * 4096;
}

// 1e7 steps of a bonded pair that swings without damping at 0.8 of its limit, turning and flying: momentum to 1e-12 of
// its parts, no growth of energy (the amplitude of a leap-frog does not change), and not one page more memory.
TEST(ManySteps, TenMillion) {
  auto contact = elastic_model(dem::Elasticity::linear, 1e5);
  contact.sintering = dem::SinteringSettings{};
  contact.sintering->damping_ratio = 0;
  auto s = empty_setup(copper(), contact, hold(1e3, 300, 0));
  s.materials[0].activation_temperature = 5000;
  for (int i = 0; i < 2; ++i)
    add_sphere(s.particles, Vec3(0, 0, i * 1.999 * radius), radius, Vec3(1e-3, 2e-3 * i, 1e-4 + 1e-3 * i));
  Simulation sim(s);
  bond_all(sim, dem::NeckPhase::bonded, 0.3);
  const Vec3 before = momentum(sim.state().particles);
  const auto largest_energy = [&](int steps) {
    double largest = 0;
    for (int n = 0; n < steps; ++n) {
      sim.advance();
      largest = std::max(largest, kinetic_energy(sim.state().particles));
    }
    return largest;
  };
  const double first = largest_energy(100000);
  const std::size_t bytes = sim.bytes(), pages = resident();
  for (int n = 0; n < 9800000; ++n) sim.advance();
  const double last = largest_energy(100000);
  EXPECT_EQ(sim.state().steps, 10000000u);
  EXPECT_EQ(sim.bytes(), bytes);
  EXPECT_LE(resident(), pages + (std::size_t(1) << 20));
  double parts = 0;
  for (const auto& b : sim.state().particles.body) parts += b.velocity.norm() / b.inverse_mass;
  EXPECT_LT((momentum(sim.state().particles) - before).norm(), 1e-9 * parts);
  EXPECT_NEAR(last / first, 1, 1e-4);
}

}  // namespace
}  // namespace densify::test
