// Punches: both of them, and driven by their travel instead of by pressure.

#include <gtest/gtest.h>

#include <cmath>

#include "fem/press/press_run.h"
#include "fem/press/viscous_solid.h"

namespace densify::fem {
namespace {

constexpr double radius = 6.5e-3, density = 0.65, hot = 1673.15;
constexpr double none = std::numeric_limits<double>::quiet_NaN();

SkorohodOlevsky::Parameters viscous() {
  SkorohodOlevsky::Parameters p;
  p.viscosity = 1e9;
  p.youngs_modulus = 1e13;  // elastic strains of 3e-6
  p.poissons_ratio = 0.3;
  return p;
}

SkorohodOlevsky::Parameters elastic() {
  auto p = viscous();
  p.viscosity = 1e30, p.youngs_modulus = 1e11;
  return p;
}

PressBody<2> body(const SkorohodOlevsky::Parameters& p, double height, int axial, Punches punches, double mu) {
  PressSettings s;
  s.punches = punches;
  s.friction = mu;
  s.wall_stiffness = 1e16;
  return PressBody<2>({radius, height, 4, axial}, std::make_shared<ViscousSolid>(std::make_shared<SkorohodOlevsky>(p)),
                      density, hot, s, MPI_COMM_WORLD);
}

// A body in a rigid die without friction is homogeneous: punches that come together by u at a steady rate leave the
// density rho_0 h_0/(h_0 - u), and take the pressure 4 eta (1 - theta)^2/(3 theta) v/h, one punch or both alike.
TEST(PressPunch, TravelInARigidDieAsInClosedForm) {
  constexpr double height = 8e-3, travel = 2e-3, duration = 100;
  const Schedule schedule(hot, 0, {{"closing", duration, hot, 0}, {"unloading", 10, hot, 0}});
  for (const Punches punches : {Punches::upper, Punches::both}) {
    PressBody<2> b = body(viscous(), height, 2, punches, 0);
    PressRun<2> run(b, schedule, {radius, 0, 0, {travel, none}}, {1e-4});
    while (run.row().time < duration) run.advance();
    const PressRow closed = run.row();
    EXPECT_EQ(closed.travel, travel);
    EXPECT_NEAR(closed.height, height - travel, 1e-12);
    EXPECT_NEAR(closed.density.mean, density * height / closed.height, 1e-5);  // elastic strains
    EXPECT_NEAR(closed.density.most, closed.density.least, 1e-8);
    // The law of a step is that of its middle.
    const double h = height - travel * (1 - 0.5 * closed.step / duration), rho = density * height / h;
    const double p = 4e9 * rho * rho / (3 * (1 - rho)) * (travel / duration) / h;
    EXPECT_NEAR(closed.pressure / p, 1, 0.01);
    EXPECT_NEAR(closed.forces.punch / closed.forces.bottom, 1, 1e-7);
    EXPECT_NEAR(b.lower_rise(), punches == Punches::both ? 0.5 * travel : 0, 1e-12);
    // Half of the strain of a step is what the dissipated work is off, by its volume at the end.
    EXPECT_NEAR((closed.dissipated + closed.stored) / closed.work, 1, 0.02);
    // The stage by pressure begins with the one that there is.
    run.advance();
    EXPECT_NEAR(run.row().pressure, closed.pressure * (1 - (run.row().time - duration) / 10), 1e-6 * p);
    while (!run.done()) run.advance();
    EXPECT_EQ(run.row().pressure, 0);
  }
}

// Pressed by pressure, both punches without friction do what one does: 0.112181 of porosity after 40 s of 30 MPa
// (press_point_test.cc).
TEST(PressPunch, DoubleActionWithoutFrictionIsSingleAction) {
  PressBody<2> b = body(viscous(), 8e-3, 2, Punches::both, 0);
  PressLoad load{0.8, hot, radius, 1, 30e6};
  load.moving = Punches::both;
  for (int k = 0; k < 50; ++k) {
    b.try_step(load);
    b.accept();
  }
  EXPECT_NEAR(b.densities().mean, 1 - 0.112181, 2e-5);
  EXPECT_NEAR(b.lower_rise() / (8e-3 - b.height()), 0.5, 1e-10);
}

/// Axial stresses of the points of elements from `first` on, in order of the elements.
std::vector<double> axial_stresses(const PressBody<2>& b, std::size_t first) {
  std::vector<double> all;
  const auto points = b.points();
  for (std::size_t k = first * b.points_of_element(); k < points.size(); ++k) all.push_back(points[k].stress(2, 2));
  return all;
}

// The middle plane of double action is a plane of symmetry, and a frictionless punch is one: the upper half of the body
// is a body of half the height under one punch, and Janssen's loss that of half the height, sigma_z = p exp(-2 mu K0
// H/D) in the middle, K0 = nu/(1 - nu) of an elastic body (his stress is the same over a section: 2 % as in
// PressBody.FrictionTakesTheLoadAsJanssenSays).
TEST(PressPunch, DoubleActionWithFrictionIsTwiceHalfTheHeight) {
  constexpr double height = 16e-3, mu = 0.05, pressure = 1e6;
  for (const bool travels : {false, true}) {
    PressBody<2> whole = body(elastic(), height, 12, Punches::both, mu),
                 half = body(elastic(), 0.5 * height, 6, Punches::upper, mu);
    PressLoad load{1, hot, radius, 1, pressure};
    if (travels) load.pressure.reset(), load.punch_travel = 1e-7;
    const PressOutcome one = half.try_step(load);
    half.accept();
    load.moving = Punches::both;
    if (travels) load.punch_travel *= 2;
    const PressOutcome two = whole.try_step(load);
    whole.accept();
    EXPECT_NEAR(two.forces.punch / two.forces.bottom, 1, 1e-6);
    EXPECT_NEAR(two.forces.punch / one.forces.punch, 1, 1e-6);
    const auto upper = axial_stresses(whole, 6 * 4), alone = axial_stresses(half, 0);
    ASSERT_EQ(upper.size(), alone.size());
    for (std::size_t k = 0; k < upper.size(); ++k) EXPECT_NEAR(upper[k], alone[k], 1e-4 * pressure) << k;
    const double lost = 1 - one.forces.bottom / one.forces.punch;
    EXPECT_NEAR(lost / (1 - std::exp(-2 * mu * (0.3 / 0.7) * height / (2 * radius))), 1, 0.02);
  }
}

// Punches that are driven away let the body go, without pulling, and press it again where they meet it.
TEST(PressPunch, ADrivenPunchDoesNotPull) {
  constexpr double height = 8e-3;
  const Schedule schedule(hot, 0, {{"closing", 50, hot, 0}, {"opening", 50, hot, 0}, {"closing again", 100, hot, 0}});
  for (const Punches punches : {Punches::upper, Punches::both}) {
    PressBody<2> b = body(viscous(), height, 2, punches, 0.1);
    PressRun<2> run(b, schedule, {radius, 0, 0, {1e-3, 0, 2e-3}}, {});
    while (!run.done()) {
      const PressRow& r = run.advance();
      EXPECT_GT(r.forces.punch, -1e-2);  // of kilonewtons
      if (r.time == 100) {
        EXPECT_EQ(r.travel, 0);
        EXPECT_NEAR(r.height, height - 1e-3, 1e-3 * height);
        EXPECT_LT(r.forces.punch, 1e-2);
      }
    }
    EXPECT_NEAR(run.row().height, height - 2e-3, 1e-12);
    EXPECT_GT(run.row().forces.punch, 1000);
  }
}

}  // namespace
}  // namespace densify::fem
