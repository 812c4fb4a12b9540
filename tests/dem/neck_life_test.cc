// One neck through activation, growth, equilibrium, cooling and reheating, driven without particles (4.29-4.58).

#include <gtest/gtest.h>

#include "tests/support/law_driver.h"

namespace densify::dem {
namespace {

using test::drive;
using test::DriverPair;
using Law = SinteringContact<LinearSpring>;

constexpr DriverPair pair{5e-6, 1e-3};
constexpr double r = pair.radius, stiffness = 1e5, gamma = 1.5, cap = 2.8, sine = 0.95;

/// A law whose neck of radius a has the viscosity eta [N s/m].
Law law_with(double eta, double a) {
  SinteringSettings settings;
  settings.damping_ratio = 0;
  return {{{stiffness}, 0}, settings, a * a * a * a / eta, gamma, cap, sine, true, false};
}

void unchanged(Law&, double) {}

double f_sint(double a) {
  return M_PI * gamma * (cap * r + a * sine);
}  // (4.36)

// (4.31) with its exact integral a^2 + 2 r u = constant (4.58), whatever the steps.
TEST(Neck, GrowthConservesItsIntegral) {
  const NeckHistory start{0.2 * r, 0, -1e9, NeckPhase::sintering};
  for (int steps : {3, 100}) {
    const auto rows = drive<Law>(
        law_with(1e3, r), pair, start, 0, 10, steps, [](double t) { return -1e-7 - 1e-8 * t - 5e-9 * std::sin(t); },
        unchanged);
    for (const auto& row : rows)
      EXPECT_NEAR(row.neck.radius * row.neck.radius + 2 * r * row.overlap, 0.04 * r * r - 2 * r * 1e-7, 1e-12 * r * r);
  }
}

// The other reading: a = 1.43 sqrt(r^2 - (r - |u|/2)^2) of the overlap at each moment.
TEST(Neck, FollowsTheOverlap) {
  Law law = law_with(1e3, r);
  law.settings.neck = NeckGrowth::overlap;
  const auto rows = drive<Law>(
      law, pair, {0.2 * r, 0, -1e9, NeckPhase::sintering}, 0, 1, 10, [](double t) { return -0.01 * r * (1 + t); },
      unchanged);
  EXPECT_NEAR(rows.back().neck.radius / (1.43 * r * std::sqrt(1 - 0.99 * 0.99)), 1, 1e-12);
}

// a = a_max = r sin(Psi/2) stops growth (4.32); after t_rel the sintering force is gone and the neck is a bond.
TEST(Neck, StopsAtEquilibrium) {
  const auto rows = drive<Law>(
      law_with(1e3, r), pair, {0.94 * r, 0, -1e9, NeckPhase::sintering}, 0, 200, 2000,
      [](double t) { return -0.5 * r - 1e-9 * t; }, unchanged);
  EXPECT_EQ(rows.back().neck.radius, r * sine);
  EXPECT_EQ(rows.back().neck.phase, NeckPhase::bonded);
  EXPECT_EQ(rows.back().force.sintering, 0);
  bool arrived = false;
  for (const auto& row : rows) {
    arrived = arrived || row.neck.phase == NeckPhase::arriving;
    EXPECT_LE(row.neck.radius, r * sine);
  }
  EXPECT_TRUE(arrived);
}

// A neck pulled apart: a^2 reaches its floor and the pair is loose again, without force.
TEST(Neck, VanishesWhenPulledApart) {
  const auto rows = drive<Law>(
      law_with(1e3, r), pair, {0.1 * r, 0, -1e9, NeckPhase::sintering}, 0, 1, 100,
      [](double t) { return 0.02 * r * t; }, unchanged);
  EXPECT_EQ(rows.back().neck.phase, NeckPhase::loose);
  EXPECT_EQ(rows.front().neck.phase, NeckPhase::sintering);
}

// At the first activation pressed contacts fade in with a_0 = sqrt(r u/2) (4.30) and their elastic state; a contact
// born later sinters at once from the smallest neck.
TEST(Neck, PressedAndBorn) {
  for (bool pressed : {true, false}) {
    Law law = law_with(1e3, r);
    law.activation_step = pressed;
    NeckHistory h;
    const double u = pressed ? -0.02 * r : -1e-6 * r;
    const auto f = law.update(test::driver_input(pair, u, 0, 1e-3, 5), h);
    EXPECT_EQ(h.phase, pressed ? NeckPhase::activating : NeckPhase::sintering);
    EXPECT_NEAR(h.radius / r, pressed ? 0.1 : law.settings.starting_neck, 1e-12);
    EXPECT_EQ(h.elastic, u);
    EXPECT_NEAR(f.sintering, pressed ? 0 : f_sint(h.radius), 1e-18);
    EXPECT_NEAR(f.total - f.sintering, stiffness * u, 1e-15);
  }
}

// Largest change of force from one step to the next in a history of activation (100 s), cooling before its end (150 s),
// reheating before that has faded (170 s), sintering, cooling (320 s), reheating (420 s).
double largest_jump(Law law, int steps, double& largest_force) {
  const auto rows = drive<Law>(
      law, pair, {}, 0, 600, steps, [](double) { return -1e-7; },
      [](Law& l, double t) {
        l.active = (t >= 100 && t < 150) || (t >= 170 && t < 320) || t >= 420;
        l.activation_step = t == 100 || t == 170 || t == 420;
      });
  double jump = 0;
  largest_force = 0;
  for (std::size_t n = 1; n < rows.size(); ++n) {
    jump = std::max(jump, std::abs(rows[n].force.total - rows[n - 1].force.total));
    largest_force = std::max(largest_force, std::abs(rows[n].force.total));
  }
  return jump;
}

// (4.47)-(4.54): the force is continuous through every turn: a step's change halves with the step.  A relaxation time
// of 50 s and t_rel = 60 s change at most about 3 % in a second, 0.3 % in the coarser step of 0.1 s.
TEST(Neck, TransitionsAreContinuous) {
  const Law law = law_with(50 * stiffness, 0.1 * r);
  double force;
  const double coarse = largest_jump(law, 6000, force), fine = largest_jump(law, 12000, force);
  EXPECT_LT(coarse, 0.01 * force);
  EXPECT_LT(fine, 0.55 * coarse);
}

// A viscous neck that cools hands the whole of its force to the bond.
TEST(Neck, ViscousNeckCoolsWithoutAJump) {
  Law law = law_with(1e3, 0.5 * r);
  law.settings.model = SinteringModel::viscous;
  NeckHistory h{0.5 * r, 0, -1e9, NeckPhase::sintering};
  const double hot = law.update(test::driver_input(pair, -1e-7, -1e-15, 1e-6, 1), h).total;
  law.active = false;
  const double cold = law.update(test::driver_input(pair, -1e-7, -1e-15, 1e-6, 1 + 1e-6), h).total;
  EXPECT_EQ(h.phase, NeckPhase::dormant);
  EXPECT_GT(hot, 0);
  EXPECT_NEAR(cold / hot, 1, 1e-4);
}

// Half-way through activation the series viscosity is the mean of eta_inf and theory (4.47), half-way through arrival
// again (4.51), and F_sint is half of (4.36) (4.50, 4.52).
TEST(Neck, HalfOfATransition) {
  const Law law = law_with(1e3, 0.5 * r);
  for (auto phase : {NeckPhase::activating, NeckPhase::arriving}) {
    const NeckHistory h{0.5 * r, 0, -30, phase};
    const Linearisation l = law.linearise(test::driver_input(pair, -1e-7, 0, 1e-3, 0), h);
    EXPECT_NEAR(l.viscosity, 0.5 * (1e12 + 1e3), 1);
    EXPECT_NEAR(l.active, 0.5 * f_sint(0.5 * r), 1e-12);
  }
}

// Relaxation at fixed length, F = F_0 exp(-t k/eta): second order for the trapezoidal update (4.67), first for backward
// Euler.  Leading errors at k dt/eta = x over t = eta/k: x^2/12 and x/2.
TEST(Maxwell, RelaxationAndItsOrder) {
  for (auto update : {MaxwellUpdate::trapezoidal, MaxwellUpdate::backward_euler})
    for (int steps : {20, 40}) {
      Law law = law_with(stiffness, 0.5 * r);  // eta/k = 1 s
      law.settings.update = update;
      const auto rows = drive<Law>(
          law, pair, {0.5 * r, -1e-8, -1e9, NeckPhase::sintering}, 0, 1, steps, [](double) { return -1e-7; },
          unchanged);
      const double f = rows.back().force.total - rows.back().force.sintering, x = 1.0 / steps;
      const double error = f / (stiffness * -1e-8 * std::exp(-1)) - 1;
      if (update == MaxwellUpdate::trapezoidal)
        EXPECT_NEAR(error / (-x * x / 12), 1, 0.01);
      else
        EXPECT_NEAR(error / (x / 2), 1, 0.05);
    }
}

// dt = 100 eta/k: the trapezoidal update multiplies the force by (1 - 50)/(1 + 50) each step and rings; backward Euler
// by 1/101, and is done.
TEST(Maxwell, StiffStepRingsOnlyWithTheTrapezoidalUpdate) {
  Law law = law_with(stiffness, 0.5 * r);
  for (auto [update, factor] :
       {std::pair{MaxwellUpdate::trapezoidal, -49.0 / 51.0}, std::pair{MaxwellUpdate::backward_euler, 1.0 / 101.0}}) {
    law.settings.update = update;
    const auto rows = drive<Law>(
        law, pair, {0.5 * r, -1e-8, -1e9, NeckPhase::sintering}, 0, 300, 3, [](double) { return -1e-7; }, unchanged);
    for (int n = 1; n <= 3; ++n) {
      const auto stored = [&](int k) {
        return rows[std::size_t(k)].force.total - rows[std::size_t(k)].force.sintering;
      };
      EXPECT_NEAR(stored(n) / stored(n - 1), factor, 1e-9);
    }
  }
}

// The damper sees the elastic part of the rate only: in steady flow F - F_sint = eta v with any damping ratio.
TEST(Maxwell, DamperAddsNoViscosity) {
  for (double xi : {0.0, 0.7}) {
    Law law = law_with(1e3, 0.5 * r);
    law.settings.damping_ratio = xi;
    const double v = -1e-12;  // eta grows with the neck by 4 r v t/a^2 = 3.2e-6
    const auto rows = drive<Law>(
        law, pair, {0.5 * r, 0, -1e9, NeckPhase::sintering}, 0, 1, 1000, [v](double t) { return -1e-7 + v * t; },
        unchanged);
    EXPECT_NEAR((rows.back().force.total - rows.back().force.sintering) / (1e3 * v), 1, 5e-6) << xi;
  }
}

// A bond keeps its force for ever; the thesis-compatible option relaxes with eta_inf, never below the theory's.
TEST(Bond, ElasticDoesNotCreep) {
  const NeckHistory start{r * sine, -1e-8, 0, NeckPhase::bonded};
  Law law = law_with(1e3, 0.5 * r);
  const auto still = drive<Law>(
      law, pair, start, 0, 1e9, 100, [](double) { return -0.5 * r; }, unchanged);
  EXPECT_EQ(still.back().force.total, stiffness * -1e-8);
  law.settings.at_equilibrium = AtEquilibrium::viscous;
  law.settings.update = MaxwellUpdate::trapezoidal;
  law.settings.viscosity_before = 1e7;
  const auto rows = drive<Law>(
      law, pair, start, 0, 100, 1000, [](double) { return -0.5 * r; }, unchanged);
  EXPECT_NEAR(rows.back().force.total / (stiffness * -1e-8 * std::exp(-1)), 1, 1e-5);
}

// An elastic bond whose stiffness falls by half on heating and comes back: F = k(T) u_e at every moment, the force
// returns, and the work over a cycle of stretching hot and releasing cold is what k(T) says, none by itself.
TEST(Bond, ForceFollowsStiffnessThroughAThermalCycle) {
  const NeckHistory start{r * sine, -1e-8, 0, NeckPhase::dormant};
  Law law = law_with(1e3, 0.5 * r);
  law.active = false;
  const auto rows = drive<Law>(
      law, pair, start, 0, 1, 100, [](double) { return -1e-7; },
      [](Law& l, double t) { l.loose.spring.stiffness = stiffness * (1 - 0.5 * std::sin(M_PI * t)); });
  EXPECT_NEAR(rows[50].force.total / (0.5 * stiffness * -1e-8), 1, 1e-12);
  EXPECT_NEAR(rows.back().force.total / (stiffness * -1e-8), 1, 1e-12);
  EXPECT_EQ(rows.back().neck.elastic, -1e-8);
}

// Hertz bond driven round a cycle: compressed hot, cooled at that length, released cold, heated.  With F = K(T) f(u_e)
// the work taken in is that of the two springs, 2/5 (K_hot - K_cold) sqrt(R) (u_1^(5/2) - u_0^(5/2)), and nothing is
// left in the bond; a force as history would end as another force than it began.
// Trapezoidal sum over 1000 steps a side: 1e-7.
TEST(Bond, HertzWorkOverAThermalCycle) {
  const double hot = 1e11, cold = 1.6e11, radius = 0.5 * r, u0 = 1e-8, u1 = 5e-8;
  SinteringSettings settings;
  settings.damping_ratio = 0;
  const SinteringContact<HertzSpring> bond{{{hot, 3e-4}, 0}, settings, 1, gamma, cap, sine, false, false};
  auto pressed = [&](double t) { return std::clamp(t < 1.5 ? t : 3 - t, 0.0, 1.0); };     // up in 0-1, down in 2-3
  auto cooled = [&](double t) { return std::clamp(t < 2.5 ? t - 1 : 4 - t, 0.0, 1.0); };  // down in 1-2, up in 3-4
  const auto rows = drive<SinteringContact<HertzSpring>>(
      bond, pair, {r * sine, -u0, 0, NeckPhase::dormant}, 0, 4, 4000,
      [&](double t) { return -1e-7 - (u1 - u0) * pressed(t); },
      [&](SinteringContact<HertzSpring>& l, double t) {
        l.loose.spring.four_thirds_modulus = hot + (cold - hot) * cooled(t);
      });
  double work = 0;
  for (std::size_t n = 1; n < rows.size(); ++n)
    work += 0.5 * (rows[n].force.total + rows[n - 1].force.total) * (rows[n].overlap - rows[n - 1].overlap);
  const double due = 0.4 * (hot - cold) * std::sqrt(radius) * (std::pow(u1, 2.5) - std::pow(u0, 2.5));
  EXPECT_NEAR(work / due, 1, 1e-6);
  EXPECT_NEAR(rows[1000].force.total / (-hot * std::sqrt(radius) * std::pow(u1, 1.5)), 1, 1e-9);
  EXPECT_NEAR(rows[2000].force.total / (-cold * std::sqrt(radius) * std::pow(u1, 1.5)), 1, 1e-9);
  EXPECT_NEAR(rows.back().force.total / rows.front().force.total, 1, 1e-9);
  EXPECT_NEAR(rows.back().neck.elastic / -u0, 1, 1e-9);
}

// Friction fades with activation and does not come back while there is a neck.
TEST(Neck, FrictionFades) {
  const Law law = law_with(1e3, 0.5 * r);
  EXPECT_EQ(law.friction_share({}, 0), 1);
  EXPECT_NEAR(law.friction_share({0.5 * r, 0, -30, NeckPhase::activating}, 0), 0.5, 1e-15);
  for (auto phase : {NeckPhase::sintering, NeckPhase::arriving, NeckPhase::bonded, NeckPhase::dormant})
    EXPECT_EQ(law.friction_share({0.5 * r, 0, 0, phase}, 10), 0);
}

}  // namespace
}  // namespace densify::dem
