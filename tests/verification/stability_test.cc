// Critical steps by bisection against the formulas of thesis 4.8 as stability analysis corrects them.

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>

#include "tests/support/law_driver.h"
#include "tests/support/setups.h"

namespace densify::test {
namespace {

constexpr double mass = 2e-3, stiffness = 1e5;

/// Largest step without growth of `run(step)` = largest late amplitude over the largest early one.
double bisect(double stable, double unstable, const std::function<double(double)>& growth) {
  for (int k = 0; k < 40; ++k) {
    const double mid = 0.5 * (stable + unstable);
    (growth(mid) < 10 ? stable : unstable) = mid;
  }
  return stable;
}

/// Two free masses (or one against a fixed end) joined by a bond, leap-frog as the program does it.
template <class Law>
double growth_of_pair(const Law& law, dem::NeckHistory neck, double step, bool fixed_end) {
  const double m_red = fixed_end ? mass : 0.5 * mass;  // the inertia that the bond feels
  const DriverPair pair{5e-6, 0.5 * mass};             // the damper is told the pair's reduced mass
  double u = 0, v = 1e-9, early = 0, late = 0;
  for (int n = 0; n < 4000; ++n) {
    const double change = step * v;
    u += change;
    const double f = law.update(driver_input(pair, -1e-7 + u, change, step, 0), neck).total;
    v -= step * f / m_red;
    if (n < 50) early = std::max(early, std::abs(v));
    if (n >= 3000) late = std::max(late, std::abs(v));
    if (!(std::abs(v) < 1e-5)) return 1e9;  // before the neck feels the motion
  }
  return late / early;
}

using Law = dem::SinteringContact<dem::LinearSpring>;

/// A linear law without sintering force whose neck of half a radius has the viscosity eta.
Law law_with(double eta) {
  dem::SinteringSettings settings;
  settings.damping_ratio = 0;
  const double a = 0.5 * 5e-6;
  return {{{stiffness}, 0}, settings, a * a * a * a / eta, 0, 0, 0.95, true, false};
}

dem::NeckHistory neck_in(dem::NeckPhase phase) {
  return {0.5 * 5e-6, 0, -1e9, phase};
}

// (4.69), (4.70): two free masses and a spring, 2/omega = sqrt(2 m/k); with a damper (4.71), the half-step lag of its
// velocity included.  4000 steps resolve the limit to about 1e-6.
TEST(CriticalStep, SpringWithAndWithoutDamper) {
  for (double xi : {0.0, 0.1, 0.7, 2.0}) {
    Law law = law_with(1);
    law.settings.damping_ratio = xi;
    const double limit = 2 / std::sqrt(2 * stiffness / mass) * (std::sqrt(1 + xi * xi) - xi);
    const double measured = bisect(0.2 * limit, 2 * limit, [&](double dt) {
      return growth_of_pair(law, neck_in(dem::NeckPhase::bonded), dt, false);
    });
    EXPECT_NEAR(measured / limit, 1, 1e-3) << xi;
    EXPECT_NEAR(dem::node_limit(mass, stiffness, 2 * xi * std::sqrt(0.5 * mass * stiffness)) / limit, 1, 1e-12);
  }
}

// Viscous contact: m/eta for two free masses, 2 m/eta with one end fixed, which is what (4.72) prints for both.
TEST(CriticalStep, DashpotAndTheFactorTwoOf4_72) {
  const double eta = 300;
  Law law = law_with(eta);
  law.settings.model = dem::SinteringModel::viscous;
  auto measured = [&](bool fixed_end) {
    return bisect(0.1 * mass / eta, 8 * mass / eta,
                  [&](double dt) { return growth_of_pair(law, neck_in(dem::NeckPhase::sintering), dt, fixed_end); });
  };
  EXPECT_NEAR(measured(false) / (mass / eta), 1, 1e-3);
  EXPECT_NEAR(measured(true) / (2 * mass / eta), 1, 1e-3);
  EXPECT_NEAR(dem::node_limit(mass, 0, eta) / (mass / eta), 1, 1e-12);
  EXPECT_NEAR(dem::thesis_limit({std::numeric_limits<double>::infinity(), 0, eta, 0, 0}, 0.5 * mass) / (2 * mass / eta),
              1, 1e-12);
}

// The Maxwell element: 2/omega for every ratio of relaxation time to step, with either update; (4.75) eta/k is no
// limit. While eta/k is far above the step the contact rings down slowly or not at all; far below it the spring hardly
// counts and the limit can only be larger.
TEST(CriticalStep, MaxwellLimitIsNotTheRelaxationTime) {
  const double limit = 2 / std::sqrt(2 * stiffness / mass);
  for (auto update : {dem::MaxwellUpdate::trapezoidal, dem::MaxwellUpdate::backward_euler})
    for (double ratio : {1e-4, 1e-2, 0.3, 1.0, 10.0, 1e4}) {
      Law law = law_with(ratio * stiffness * limit);  // eta/k = ratio x limit
      law.settings.update = update;
      EXPECT_LT(growth_of_pair(law, neck_in(dem::NeckPhase::sintering), 0.999 * limit, false), 1.5) << ratio;
      if (ratio < 1e4) continue;
      EXPECT_GT(growth_of_pair(law, neck_in(dem::NeckPhase::sintering), 1.01 * limit, false), 10) << ratio;
    }
}

/// Spectral radius of one leap-frog step of two free masses under F^{n+1} = 2 eta v - F^n (4.61), state (v, F).
double spectral_radius_4_61(double x) {  // x = eta dt / m_red
  Eigen::Matrix2d a;
  // v' = v - (dt/m) F, then F' = 2 eta v' - F; F in units of eta.
  a << 1, -x, 2, -1 - 2 * x;
  return a.eigenvalues().cwiseAbs().maxCoeff();
}

// (4.61), the trapezoidal viscous force: the amplification matrix has trace -2x and determinant -1, so that one
// eigenvalue is -x - sqrt(1 + x^2), below -1 for every step; (4.59) taken directly has 1 - x.
TEST(CriticalStep, TrapezoidalViscousForceIsUnstableAtAnyStep) {
  for (double x : {1e-6, 1e-3, 0.1, 1.0, 10.0}) {
    EXPECT_NEAR(spectral_radius_4_61(x), x + std::sqrt(1 + x * x), 1e-9);
    EXPECT_GT(spectral_radius_4_61(x), 1);
  }
}

/// Two free spheres of copper, Kelvin-Voigt, that run into each other at a chosen step.
double critical_of_simulation(const dem::ContactModel& contact, dem::StepRule rule) {
  auto s = empty_setup(copper(), contact, hold(1, 1300, 0));
  s.integration.rule = rule;
  for (int i = 0; i < 2; ++i) add_sphere(s.particles, Vec3(0, 0, i * 44e-6), 22.5e-6, Vec3::Zero());
  Simulation sim(s);
  sim.advance(nullptr);
  return sim.state().critical_step;
}

// The program's own limit of two free spheres in contact: (4.71) with both rules.
TEST(CriticalStep, OfASimulation) {
  const double m = 4.2559941e-10, k = 7e5, xi = 0.3;
  auto contact = elastic_model(dem::Elasticity::linear, k);
  contact.damping_ratio = xi;
  const double limit = 2 / std::sqrt(2 * k / m) * (std::sqrt(1 + xi * xi) - xi);
  EXPECT_NEAR(critical_of_simulation(contact, dem::StepRule::particle_sum) / limit, 1, 1e-7);
  EXPECT_NEAR(critical_of_simulation(contact, dem::StepRule::thesis) / limit, 1, 1e-7);
}

// A viscous neck: m/eta by the particle's sum, 2 m/eta by the thesis's rule (4.72), which is why it needs its small
// safety factor.  The neck is the one of the first step, a_0 = sqrt(r u/2) of u = 1 um.
TEST(CriticalStep, OfAViscousNeck) {
  auto contact = elastic_model(dem::Elasticity::linear, 7e5);
  contact.sintering = dem::SinteringSettings{};
  contact.sintering->model = dem::SinteringModel::viscous;
  const double a2 = 0.5 * 22.5e-6 * 1e-6, eta = M_PI * a2 * a2 / (8 * 2.51930572e-28), m = 4.2559941e-10;
  EXPECT_NEAR(critical_of_simulation(contact, dem::StepRule::particle_sum) / (m / eta), 1, 1e-6);
  EXPECT_NEAR(critical_of_simulation(contact, dem::StepRule::thesis) / (2 * m / eta), 1, 1e-6);
}

}  // namespace
}  // namespace densify::test
