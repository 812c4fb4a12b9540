// Equalised inertia: masses from a step (m = k dt^2/(2 s^2)), against closed forms, stability limits and the process.

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>

#include "tests/dem/small_packings.h"
#include "tests/support/law_driver.h"
#include "tests/support/neck_quadrature.h"
#include "tests/support/setups.h"

namespace densify::test {
namespace {

using dem::testing::StateBits;

constexpr double radius = 5e-6, k_n = 1e5;

void equalise(Setup& s, double step, double safety) {
  s.integration.inertia = dem::Inertia::equalised;
  s.integration.fixed_step = step;
  s.integration.step_safety = safety;
}

/// A face-centred crystal of springs, 12 contacts a sphere: the matrix sum is 4 k 1 and the stiffest mode 2 x 4 k.
Setup crystal(double damping) {
  auto s = empty_setup(copper(), elastic_model(dem::Elasticity::linear, k_n), hold(1e9, 300, 0));
  s.contact.damping_ratio = damping;
  fill_periodic(s, Lattice::face_centred, 2, 2 * radius * 0.999, radius);
  return s;
}

// The bound of the largest eigenvalue of a symmetric 3 x 3 matrix: never below, exact for one contact and for an
// isotropic sum, the same along any axes.
TEST(EqualisedInertia, BoundOfTheLargestEigenvalue) {
  std::mt19937 random(2);
  std::normal_distribution<double> any;
  for (int contacts = 1; contacts < 9; ++contacts) {
    dem::StiffnessSum sum, turned;
    Mat3 whole = Mat3::Zero();
    const Eigen::AngleAxisd turn(1.1, Vec3(1, 2, 3).normalized());
    for (int c = 0; c < contacts; ++c) {
      const Vec3 n = Vec3(any(random), any(random), any(random)).normalized();
      const double k = std::abs(any(random)) + 0.1, across = 0.3 * k;
      sum.add(k, across, n);
      turned.add(k, across, turn * n);
      whole += k * n * n.transpose() + across * (Mat3::Identity() - n * n.transpose());
    }
    const double exact = Eigen::SelfAdjointEigenSolver<Mat3>(whole).eigenvalues()[2];
    EXPECT_GE(sum.largest_eigenvalue(), exact * (1 - 1e-12));
    EXPECT_LE(sum.largest_eigenvalue(), whole.trace());
    EXPECT_NEAR(turned.largest_eigenvalue() / sum.largest_eigenvalue(), 1, 1e-12);
    if (contacts == 1) {
      EXPECT_NEAR(sum.largest_eigenvalue() / exact, 1, 1e-12);
    }
  }
  dem::StiffnessSum cube;
  for (const Vec3& n : {Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)}) cube.add(3.0, 0, n);
  EXPECT_NEAR(cube.largest_eigenvalue(), 3, 1e-12);
}

// m = 4 k dt^2/(2 s^2) for every sphere of the crystal, whatever its material's density.
TEST(EqualisedInertia, MassOfACrystal) {
  for (double step : {1e-3, 5.0}) {
    auto s = crystal(0);
    equalise(s, step, 0.8);
    Simulation sim(s);
    sim.advance();
    for (const auto& b : sim.state().particles.body)
      EXPECT_NEAR(1 / b.inverse_mass / (4 * k_n * step * step / (2 * 0.64)), 1, 1e-9);
  }
}

/// Largest over first kinetic energy of a small random motion.
double growth(double damping, double safety) {
  auto s = crystal(damping);
  equalise(s, 2.0, safety);
  s.integration.guards.guarding = dem::Guarding::off;
  shake(s.particles, 1e-7 * radius, 5);
  Simulation sim(s);
  sim.advance();
  const double early = kinetic_energy(sim.state().particles);
  double late = 0;
  for (int n = 0; n < 2000; ++n) {
    sim.advance();
    late = std::max(late, kinetic_energy(sim.state().particles));
  }
  return late / early;
}

// At the safety of 1 every step is at the limit of the crystal, whose bound is exact.  Below it the kinetic energy of
// the stiffest mode swings by 1/(1 - s^2), the leap-frog's own, and does not grow; above it motion grows until contacts
// open.  With dampers, whose share 2 c/dt in the masses follows the masses themselves.
TEST(EqualisedInertia, CrystalAtTheLimit) {
  for (double damping : {0.0, 0.3}) {
    EXPECT_LT(growth(damping, 0.98), 1 / (1 - 0.98 * 0.98)) << damping;
    EXPECT_GT(growth(damping, 1.03), 1e3) << damping;
  }
}

/// Late over early velocity of two free masses under a sintering contact with fixed neck, both with the mass that
/// `share` of its step stiffness asks for.
double growth_of_neck(double damping, double relaxation, dem::MaxwellUpdate update, double share) {
  constexpr double step = 3;
  dem::SinteringContact<dem::LinearSpring> law{{{k_n}, 0}, {}, 0, 0, 1, 1, true, false};
  law.settings.damping_ratio = damping;
  law.settings.update = update;
  constexpr double a = 1e-6;
  law.mobility_factor = a * a * a * a / (k_n * relaxation * step);  // eta/k = relaxation x step
  const dem::NeckHistory start{a, 0, -1e9, dem::NeckPhase::sintering};
  double mass = 1;
  for (int n = 0; n < 100; ++n)  // the damper follows the mass
    mass = 0.5 * share * step * step *
           law.step_stiffness(driver_input({radius, 0.5 * mass}, -1e-7, 0, step, 0), start, step);
  dem::NeckHistory neck = start;
  double v = 1e-16, early = 0, late = 0;
  for (int n = 0; n < 3000; ++n) {
    neck.radius = a;
    const double f = law.update(driver_input({radius, 0.5 * mass}, -1e-7, step * v, step, 0), neck).total;
    v -= step * f / (0.5 * mass);
    if (n < 20) early = std::max(early, std::abs(v));
    if (n >= 2000) late = std::max(late, std::abs(v));
    if (!(std::abs(v) < 1e-9)) return 1e9;
  }
  return late / early;
}

// The stiffness that stands for a contact in the masses, (k + 2 c/dt)/(1 + (theta - 1/2) k dt/eta), is its limit:
// stable with the mass that it asks for, unstable with a tenth less, for relaxation times from a hundredth of a step to
// far above.
TEST(EqualisedInertia, StepStiffnessOfANeckIsItsLimit) {
  for (auto update : {dem::MaxwellUpdate::backward_euler, dem::MaxwellUpdate::trapezoidal})
    for (double damping : {0.0, 0.3})
      for (double relaxation : {1e-2, 0.1, 1.0, 1e6}) {
        EXPECT_LT(growth_of_neck(damping, relaxation, update, 1.001), 1.1) << relaxation << " xi " << damping;
        EXPECT_GT(growth_of_neck(damping, relaxation, update, 0.9), 10) << relaxation << " xi " << damping;
      }
}

/// Two copper spheres of 22.5 um at 1300 K (thesis Table 5.1), free or under a force.
Setup copper_pair(dem::SinteringModel model, double force, double end) {
  auto contact = elastic_model(dem::Elasticity::linear, 7e5);
  contact.sintering = dem::SinteringSettings{};
  contact.sintering->model = model;
  contact.sintering->relaxation_time = 0;
  contact.sintering->damping_ratio = 0;
  contact.sintering->starting_neck = 1e-3;
  auto s = empty_setup(copper(), contact, hold(end, 1300, 0));
  for (int i = 0; i < 2; ++i) add_sphere(s.particles, Vec3(0, 0, i * 45e-6 * (1 - 1e-9)), 22.5e-6, Vec3::Zero());
  if (force > 0) s.loads = {{0, Vec3(0, 0, force), 0}, {1, Vec3(0, 0, -force), 0}};
  return s;
}

// The strains of two spheres by quadrature without inertia (5.1): free 0.0341209017 and 0.0746232217 at 1e4 and 1e5 s,
// under 0.01 N 0.1027738489 and 0.2216315606, in a thousand steps each.  Both models: the viscous one, whose explicit
// limit m/eta asks for 1e6 steps at mass factor 1e16, needs no more.
TEST(EqualisedInertia, CopperSpheres) {
  struct Case {
    double force, end, strain;
  };
  for (auto model : {dem::SinteringModel::viscoelastic, dem::SinteringModel::viscous})
    for (const Case& c : {Case{0, 1e4, 0.0341209017}, Case{0, 1e5, 0.0746232217}, Case{0.01, 1e4, 0.1027738489},
                          Case{0.01, 1e5, 0.2216315606}}) {
      auto s = copper_pair(model, c.force, c.end);
      equalise(s, c.end / 1000, 0.8);
      Simulation sim(s);
      while (!sim.finished()) sim.advance();
      const double strain = 1 - (body(sim, 1).position - body(sim, 0).position).norm() / 45e-6;
      EXPECT_NEAR(strain / c.strain, 1, 2e-3) << c.end << " s, " << c.force << " N, model " << int(model);
      EXPECT_LE(sim.state().steps, 1001u);
    }
}

// Masses change, velocities stay: uniform motion goes on, and in every step the impulses of a free body cancel.
TEST(EqualisedInertia, MomentumWhenMassesChange) {
  auto contact = elastic_model(dem::Elasticity::hertz, dem::unset);
  contact.damping_ratio = 0.1;
  auto s = empty_setup(copper(), contact, hold(1e9, 300, 0));
  fill_cluster(s, 2, 1.9 * radius, radius, 3);
  equalise(s, 1.0, 0.8);
  const Vec3 drift(1e-8, 2e-8, -1e-8);
  for (auto& b : s.particles.body) b.velocity = drift;
  Simulation still(s), sim(s);
  for (auto& b : still.mutable_state().particles.body) b.velocity.setZero();
  double least = 1, most = 0;
  for (int n = 0; n < 200; ++n) {
    const auto before = sim.state().particles.body;
    sim.advance();
    still.advance();
    Vec3 sum = Vec3::Zero();
    double size = 0;
    for (std::size_t p = 0; p < before.size(); ++p) {
      const auto& b = sim.state().particles.body[p];
      const Vec3 impulse = (b.velocity - before[p].velocity) / b.inverse_mass;
      sum += impulse;
      size += impulse.norm();
      least = std::min(least, before[p].inverse_mass / b.inverse_mass);
      most = std::max(most, before[p].inverse_mass / b.inverse_mass);
    }
    EXPECT_LT(sum.norm(), 1e-9 * size + 1e-30) << n;
  }
  EXPECT_LT(least, 0.95);  // masses did change
  EXPECT_GT(most, 1.05);
  // The drift is Galilean: all that differs between both is rounding that the collisions amplify.
  for (std::size_t p = 0; p < sim.state().particles.size(); ++p)
    EXPECT_LT((sim.state().particles.body[p].velocity - still.state().particles.body[p].velocity - drift).norm(),
              1e-3 * drift.norm());
}

/// A packing with walls, punch, friction, activation and two materials, under equalised inertia.
Setup pressed(int threads, double measure) {
  Setup s = dem::testing::cylinder_packing(threads);
  s.integration.inertia = dem::Inertia::equalised;
  s.integration.mass_scaling = 1;
  s.integration.inertia_measure = measure;
  s.integration.smallest_step = 1e-3;
  s.integration.largest_step = 5e-3;
  return s;
}

// Bit for bit the same for every number of threads, recorded or not, and after a restart between any two steps.
TEST(EqualisedInertia, SameStateForThreadsRecordingAndRestart) {
  Simulation one(pressed(1, 3e-3)), two(pressed(2, 3e-3)), recorded(pressed(1, 3e-3)), restarted(pressed(1, 3e-3));
  dem::Recording recording;
  for (int n = 0; n < 150; ++n) {
    one.advance();
    two.advance();
    recorded.advance(&recording);
    if (n % 37 == 0) {
      dem::State copy = restarted.state();
      restarted = Simulation(pressed(1, 3e-3));
      restarted.restore(std::move(copy));
    }
    restarted.advance();
  }
  ASSERT_FALSE(one.state().contacts.neck.empty());
  EXPECT_TRUE(StateBits(one.state()) == StateBits(two.state()));
  EXPECT_TRUE(StateBits(one.state()) == StateBits(recorded.state()));
  EXPECT_TRUE(StateBits(one.state()) == StateBits(restarted.state()));
}

// Breakpoints of the schedule (0.05, 0.15 and 10.15 s) are met exactly, and no step before one is much shorter than the
// one before it.
TEST(EqualisedInertia, BreakpointsAreMetExactly) {
  auto s = pressed(1, 3e-3);
  s.integration.inertia_measure = dem::unset;
  s.integration.fixed_step = 0.0037;
  Simulation sim(s);
  std::vector<double> met;
  double before = 0.0037;
  while (sim.state().time < 0.2) {
    sim.advance();
    const double t = sim.state().time;
    if (t == s.schedule.stage_end(0) || t == s.schedule.stage_end(1)) met.push_back(t);
    EXPECT_LE(sim.state().last_step, 0.0037);
    if (met.empty()) {
      EXPECT_GT(sim.state().last_step, 0.85 * before);
    }
    before = sim.state().last_step;
  }
  EXPECT_EQ(met.size(), 2u);
}

/// A random packing in a periodic cell that shrinks at a constant rate.
Setup shrinking(double measure) {
  Setup s = dem::testing::periodic_packing(1);
  s.schedule = Schedule(300, 0, {{"press", 4, 300, 0}});
  s.cell.velocity_gradient = -0.01 * Mat3::Identity();
  s.contact.damping_ratio = 0.1;
  s.integration.inertia = dem::Inertia::equalised;
  s.integration.mass_scaling = 1;
  s.integration.inertia_measure = measure;
  s.integration.largest_step = 0.1;
  s.integration.smallest_step = 1e-4;
  return s;
}

// The inertial number stays where it is wanted, within what pressure and contact stiffness rise by until the control
// sees it; twice the number, about half the steps.
TEST(EqualisedInertia, ControlHoldsItsMeasure) {
  std::uint64_t steps[2];
  int k = 0;
  for (double measure : {1e-3, 2e-3}) {
    Simulation sim(shrinking(measure));
    while (sim.state().time < 1) sim.advance();
    while (!sim.finished()) {
      sim.advance();
      EXPECT_NEAR(sim.state().control.inertial_number / measure, 1, 0.15) << sim.state().time;
    }
    steps[k++] = sim.state().steps;
  }
  EXPECT_NEAR(double(steps[0]) / double(steps[1]), 2, 0.4);
}

// sum_i m_i r_i^2/(e h^2) of two spheres of 1 kg and 5 um in a column of 50 um, e = 0.1: 2 x 0.1 = 0.2 kg.
TEST(EqualisedInertia, MassOfAColumn) {
  dem::Particles two;
  for (double z : {5e-6, 25e-6}) two.body.push_back({Vec3(0, 0, z), 5e-6, Vec3::Zero(), 1});
  EXPECT_NEAR(dem::column_mass(two, {0, 50e-6}), 2 * 0.01 / dem::carriage_share, 1e-12);
}

// The punch has a mass of its own beside that of the column, so that the force on it is p A while the powder yields: in
// the mean over ten steps within 2 % at steps that grow from milliseconds to seconds.
TEST(EqualisedInertia, PunchStandsInBalance) {
  auto s = pressed(1, 6e-3);
  s.schedule = Schedule(1500, 2e7, {{"hold", 40, 1500, 2e7}});
  s.contact.friction.reset();
  s.contact.sintering->damping_ratio = 0.3;
  s.integration.smallest_step = 1e-3;
  s.integration.largest_step = 1;
  Simulation sim(s);
  while (sim.state().time < 4) sim.advance();
  const auto punch = *sim.wall("punch");
  double worst = 0;
  while (!sim.finished()) {
    double impulse = 0, due = 0;
    for (int n = 0; n < 10 && !sim.finished(); ++n) {
      sim.advance();
      impulse += sim.state().walls.normal_force()[punch] * sim.state().last_step;
      due += sim.pressure() * sim.state().punch.area * sim.state().last_step;
    }
    worst = std::max(worst, std::abs(impulse / due - 1));
  }
  EXPECT_LT(worst, 0.02) << sim.state().steps << " " << sim.state().last_step;
}

}  // namespace
}  // namespace densify::test
