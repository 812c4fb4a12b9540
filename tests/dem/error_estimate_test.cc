// The estimated error of the density and the limits that the step control takes from the schedule, against formulas.

#include "dem/measure/error_estimate.h"

#include <gtest/gtest.h>

#include "dem/integrate/step_control.h"

namespace densify::dem {
namespace {

// dE = (c I - E/lambda) |d rho| with a constant share: E = lambda c I (1 - exp(-(rho - rho_0)/lambda)), however the way
// is cut into rows; going back counts like going on.
TEST(ErrorEstimate, BiasFollowsItsEquation) {
  constexpr double share = 0.02, gained = 0.3;
  const double due = ErrorEstimate::memory * share * (1 - std::exp(-gained / ErrorEstimate::memory));
  for (int rows : {1, 7, 400}) {
    ErrorEstimate up, down;
    for (int k = 0; k < rows; ++k) {
      up.advance(0.6 + gained * k / rows, 0.6 + gained * (k + 1) / rows, share);
      down.advance(0.9 - gained * k / rows, 0.9 - gained * (k + 1) / rows, share);
    }
    EXPECT_NEAR(up.bias / due, 1, 1e-12) << rows;
    EXPECT_NEAR(down.bias / due, 1, 1e-12) << rows;
  }
}

// A collapse counts no more than largest_share; a loose powder counts 160 I, a sintering one 6 I.
TEST(ErrorEstimate, ShareOfAnInertialNumber) {
  EXPECT_EQ(ErrorEstimate::share(1e3, false), ErrorEstimate::largest_share);
  EXPECT_DOUBLE_EQ(ErrorEstimate::share(1e-5, false), 1.6e-3);
  EXPECT_DOUBLE_EQ(ErrorEstimate::share(1e-3, true), 6e-3);
}

// Without inertia the bias settles at 20 step_tolerance + 0.6 f: 0.002 + 0.0018 as shipped, 0.1 and no more from f
// alone.
TEST(ErrorEstimate, WithoutInertia) {
  for (const auto& [f, due] : {std::pair{3e-3, 3.8e-3}, {0.03, 0.02}, {1.0, 0.102}}) {
    ErrorEstimate e;
    e.advance(0, 10, ErrorEstimate::share_without_inertia(1e-4, f));
    EXPECT_NEAR(e.bias, due, 1e-12) << f;
  }
}

// Noise of 1751 particles from 0.655 to 0.967: 0.24 x 0.312/sqrt(1751) = 0.00179; relieved of all load
// 0.15 x 0.967/sqrt(1751) = 0.00347 on top; none for two spheres, which follow one path.
TEST(ErrorEstimate, NoiseOfOneTrajectory) {
  ErrorEstimate e;
  e.initial = 0.655;
  EXPECT_NEAR(e.noise(0.967, 0, 1751), 0.0017894, 1e-7);
  EXPECT_NEAR(e.noise(0.967, 1, 1751), std::hypot(0.0017894, 0.0034664), 1e-7);
  EXPECT_EQ(e.noise(0.967, 1, 2), 0);
  EXPECT_NEAR(e.error(0.967, 0, 1751), 4 * 0.0017894, 4e-7);
  e.bias = 4e-3;
  EXPECT_NEAR(e.error(0.967, 0, 1751), std::hypot(4e-3, 4 * 0.0017894), 4e-7);
}

/// To 30 MPa in 2000 s, heated to 1000 K in 1000 s, held, unloaded in 1000 s.
Schedule pressing() {
  return Schedule(
      300, 0,
      {{"load", 2000, 300, 30e6}, {"heat", 1000, 1000, 30e6}, {"hold", 500, 1000, 30e6}, {"unload", 1000, 1000, 0}});
}

StepControl control() {
  StepControl c;
  c.largest_step = 16;
  c.smallest_step = 0.1;
  c.peak_pressure = 30e6;
  c.load_steps = 2500;
  c.transition = 60;
  c.activation_temperatures = {650};
  return c;
}

double limit_of(const StepControl& c, const Schedule& s, double time, double step, bool loose) {
  return schedule_limit(c, s, {s.pressure(time), std::abs(s.pressure_rate(time))}, time, step, loose);
}

// A loose powder takes 2500 steps for the peak pressure: 2000 s/2500 = 0.8 s; near p = 0, where 0.002 of the peak stand
// for the pressure, a twentieth of 60 kPa at 15 kPa/s: 0.2 s.
TEST(ScheduleLimit, Loading) {
  const Schedule s = pressing();
  EXPECT_NEAR(limit_of(control(), s, 1000, 1, true), 0.8, 1e-12);
  EXPECT_NEAR(limit_of(control(), s, 0, 1, false), 0.2, 1e-12);
  EXPECT_NEAR(limit_of(control(), s, 100, 1, false), 5, 1e-12);  // a twentieth of 1.5 MPa
  EXPECT_NEAR(limit_of(control(), s, 1000, 1, false), 16, 1e-12);
}

// Unloading at 30 kPa/s: a twentieth of what is left, down to 0.1 s.
TEST(ScheduleLimit, Unloading) {
  const Schedule s = pressing();
  EXPECT_NEAR(limit_of(control(), s, 4460, 1, false), 2, 1e-9);  // 1.2 MPa left
  EXPECT_NEAR(limit_of(control(), s, 4499, 1, false), 0.1, 1e-9);
}

// Activation at 650 K is passed at 2500 s.  Steps of 60 s/60 from two steps before it to 60 s after.
TEST(ScheduleLimit, Activation) {
  const Schedule s = pressing();
  EXPECT_EQ(limit_of(control(), s, 2460, 16, true), 16);
  EXPECT_EQ(limit_of(control(), s, 2470, 16, true), 1);
  EXPECT_EQ(limit_of(control(), s, 2559, 1, false), 1);
  EXPECT_EQ(limit_of(control(), s, 2561, 1, false), 16);
  StepControl sudden = control();
  sudden.transition = 0;
  EXPECT_EQ(limit_of(sudden, s, 2499, 16, false), 16);
}

// A pressure that jumps takes the smallest step, not none.
TEST(ScheduleLimit, SuddenPressure) {
  const Schedule s(300, 0, {{"load", 1e-6, 300, 30e6}, {"hold", 100, 300, 30e6}});
  EXPECT_EQ(limit_of(control(), s, 0, 1, true), 0.1);
}

/// Eight spheres on the corners of a cube, moving as v = rate x.
Particles expanding(double rate) {
  Particles p;
  for (int k = 0; k < 8; ++k) {
    const Vec3 x(k & 1, (k >> 1) & 1, k >> 2);
    p.body.push_back({1e-5 * x, 1e-6, Vec3(rate * 1e-5 * x), 1e3});
  }
  return p;
}

// A body that grows by heat deforms like nothing; without that growth I = |D| d sqrt(rho'/p) with D = rate x 1.
TEST(InertialNumber, ThermalGrowthIsNoDeformation) {
  constexpr double rate = 1e-3, pressure = 1e6;
  ControlState grown, pressed;
  for (int k = 0; k < 200; ++k) {  // the running mean settles
    measure_inertia(grown, expanding(rate), Cell{}, pressure, rate);
    measure_inertia(pressed, expanding(rate), Cell{}, pressure, 0);
  }
  const double density = 1e-3 / (4.0 / 3 * M_PI * 1e-18);
  const double due = std::sqrt(3.0) * rate * 2e-6 * std::sqrt(density / pressure);
  EXPECT_NEAR(pressed.inertial_number / due, 1, 1e-5);  // the fit's floor of 1e-6
  EXPECT_LT(grown.inertial_number, 1e-5 * due);
}

}  // namespace
}  // namespace densify::dem
