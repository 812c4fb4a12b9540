// The same world seen from elsewhere: moved, turned, renumbered, in other units, on other threads.

#include <gtest/gtest.h>

#include "tests/invariance/worlds.h"

namespace densify::test {
namespace {

constexpr int steps = 400;

// Rounding of 1e-16 grows along a few collisions; 1e-9 of a radius over 400 steps is far below any mistake of physics,
// and the particles move by more than 1e-4 meanwhile.
constexpr double tolerance = 1e-9;

TEST(Invariance, SomethingHappens) {
  for (World w : all_worlds) EXPECT_GT(moved(make_world(w), run_world(w, make_world(w), steps)), 1e-4) << int(w);
}

// Galilei: a common velocity changes nothing but the place.
TEST(Invariance, CommonVelocity) {
  for (World w : all_worlds) {
    const auto still = run_world(w, make_world(w), steps);
    auto s = make_world(w);
    const Vec3 v = Vec3(3, -2, 1) * 1e-5 / still.state().time;
    for (auto& b : s.particles.body) b.velocity += v;
    const auto moving = run_world(w, s, steps);
    EXPECT_LT(difference(still, moving, [&](const Vec3& x) { return Vec3(x + v * still.state().time); }), tolerance)
        << int(w);
  }
}

// A world turned by an arbitrary rotation gives the turned answer.
TEST(Invariance, Rotation) {
  const Mat3 q = Eigen::AngleAxisd(1.1, Vec3(1, -2, 0.5).normalized()).toRotationMatrix();
  for (World w : all_worlds) {
    auto s = make_world(w);
    for (auto& b : s.particles.body) {
      b.position = q * b.position;
      b.velocity = q * b.velocity;
    }
    for (auto& omega : s.particles.angular_velocity) omega = q * omega;
    EXPECT_LT(difference(run_world(w, make_world(w), steps), run_world(w, s, steps),
                         [&](const Vec3& x) { return Vec3(q * x); }),
              tolerance)
        << int(w);
  }
}

// The order in which particles are listed is a name, not physics.
TEST(Invariance, Renumbering) {
  for (World w : all_worlds) {
    auto s = make_world(w);
    const std::size_t n = s.particles.size();
    auto turn = [&](auto& values) {
      if (values.empty()) return;
      auto old = values;
      for (std::size_t p = 0; p < n; ++p) values[(7 * p + 3) % n] = old[p];
    };
    turn(s.particles.body);
    turn(s.particles.reference_radius);
    turn(s.particles.id);
    turn(s.particles.angular_velocity);
    EXPECT_LT(difference(run_world(w, make_world(w), steps), run_world(w, s, steps), [](const Vec3& x) { return x; }),
              tolerance)
        << int(w);
  }
}

// Other units: lengths x 1000, times x 50, masses x 7 (with every property of the materials in them) give the same
// numbers in those units.
TEST(Invariance, Units) {
  const double l = 1000, t = 50, m = 7, pascal = m / (l * t * t);
  for (World w : all_worlds) {
    auto s = make_world(w);
    auto& material = s.materials[0];
    material.density *= m / (l * l * l);
    material.youngs_modulus = PiecewiseLinear(pascal * material.youngs_modulus(300));
    material.surface_energy *= m / (t * t);
    material.diffusion.prefactor *= std::pow(l, 5) / (m * l / (t * t) * t);  // D_eff [m^5/(N s)]
    s.contact.sintering ? void(s.contact.sintering->relaxation_time *= t) : void();
    if (s.contact.sintering) s.contact.sintering->viscosity_before *= m / t;  // [N s/m]
    const auto& stage = s.schedule.stages()[0];
    s.schedule = Schedule(s.schedule.temperature(0), 0, {{"heat", t * stage.duration, stage.end_temperature, 0}});
    for (std::size_t p = 0; p < s.particles.size(); ++p) {
      s.particles.body[p].position *= l;
      s.particles.body[p].velocity *= l / t;
      s.particles.reference_radius[p] *= l;
    }
    for (auto& omega : s.particles.angular_velocity) omega /= t;
    EXPECT_LT(difference(run_world(w, make_world(w), steps), run_world(w, s, steps),
                         [&](const Vec3& x) { return Vec3(l * x); }),
              tolerance)
        << int(w);
  }
}

// One thread or two: the same bits.  Few steps: threads that share a busy core wait for each other.
TEST(Invariance, Threads) {
  for (World w : all_worlds) {
    auto s = make_world(w);
    s.integration.threads = 2;
    const auto one = run_world(w, make_world(w), 60), two = run_world(w, s, 60);
    for (std::size_t p = 0; p < one.state().particles.size(); ++p) {
      EXPECT_EQ(one.state().particles.body[p].position, two.state().particles.body[p].position);
      EXPECT_EQ(one.state().particles.body[p].velocity, two.state().particles.body[p].velocity);
    }
  }
}

/// A dense random periodic world under shear and compression, with friction.
Setup periodic_world() {
  auto contact = elastic_model(dem::Elasticity::hertz, dem::unset);
  contact.damping_ratio = 0.2;
  contact.friction = dem::FrictionModel{0.3, 0.3, 2.0 / 7, 0};
  Setup s = empty_setup(nickel_aluminide(), contact, hold(1, 300, 0));
  fill_periodic(s, Lattice::face_centred, 3, 9.9e-6, 5e-6);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> u(-1, 1);
  for (std::size_t p = 0; p < s.particles.size(); ++p) {
    s.particles.reference_radius[p] *= 1 + 0.1 * u(random);
    s.particles.body[p].position += 2e-7 * Vec3(u(random), u(random), u(random));
  }
  s.cell.velocity_gradient << -2e3, 5e3, 0, 0, -1e3, 0, 0, 1e3, -1e3;
  return s;
}

/// Contact stress after the run, from a recorded pass at its end.
Mat3 stress_after(Setup s, int count) {
  Simulation sim(std::move(s));
  dem::Recording record;
  for (int n = 0; n < count; ++n) sim.advance(nullptr);
  sim.advance(&record);
  return contact_stress(sim, record, sim.state().cell.volume());
}

// A periodic packing moved by an arbitrary vector, so that other particles lie across the faces, is the same packing;
// so is one described by another set of edges of the same lattice.  Forces act on images alone.
TEST(Invariance, PeriodicTranslation) {
  const auto base = periodic_world();
  const Mat3 reference = stress_after(base, 300);
  EXPECT_GT(reference.norm(), 1e6);
  auto moved_world = base;
  for (auto& b : moved_world.particles.body) b.position += Vec3(1.3e-5, -0.7e-5, 2.9e-5);
  moved_world.cell.origin += Vec3(0.2e-5, 0.1e-5, -0.4e-5);
  EXPECT_LT((stress_after(moved_world, 300) - reference).norm(), 1e-7 * reference.norm());
  auto other_edges = base;
  other_edges.cell.h.col(1) += other_edges.cell.h.col(0);
  EXPECT_LT((stress_after(other_edges, 300) - reference).norm(), 1e-7 * reference.norm());
}

}  // namespace
}  // namespace densify::test
