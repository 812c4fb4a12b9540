#include "base/schedule.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "base/check.h"

using namespace densify;

namespace {

// Loading at 293.15 K to 30 MPa in 60 s, heating to 1673.15 K at 15 K/min (5520 s), 30 min dwell.
Schedule press() {
  return Schedule(293.15, 0.0,
                  {{"load", 60.0, 293.15, 30e6}, {"heat", 5520.0, 1673.15, 30e6}, {"dwell", 1800.0, 1673.15, 0.0}});
}

std::string message_of(double temperature, double pressure, std::vector<Stage> stages) {
  try {
    Schedule(temperature, pressure, std::move(stages));
  } catch (const InputError& e) {
    return e.what();
  }
  return "accepted";
}

}  // namespace

// Linear in each stage: half the load at 30 s, 15 K/min = 0.25 K/s, hand sums of the times.
TEST(Schedule, RunsLinearlyThroughStages) {
  const Schedule s = press();
  EXPECT_EQ(s.end(), 7380.0);
  EXPECT_EQ(s.pressure(30.0), 15e6);
  EXPECT_EQ(s.pressure_rate(30.0), 5e5);
  EXPECT_DOUBLE_EQ(s.temperature(60.0 + 400.0), 393.15);
  EXPECT_DOUBLE_EQ(s.temperature_rate(100.0), 0.25);
  EXPECT_EQ(s.peak_temperature(), 1673.15);
  EXPECT_EQ(s.temperature(-5.0), 293.15);
  EXPECT_EQ(s.temperature(1e9), 1673.15);
  EXPECT_EQ(s.pressure(1e9), 0.0);
  EXPECT_EQ(s.pressure_rate(1e9), 0.0);
}

// At a breakpoint the value is the given one bit for bit and the rate is that of the stage which begins.
TEST(Schedule, BreakpointsAreExact) {
  const Schedule s(293.15, 1.0 / 3.0,
                   {{"a", 0.1, 1234.5678, 7.0 / 3.0}, {"b", 0.2, 77.7, 1e-3}, {"c", 1e3 / 3.0, 900.1, 3e7}});
  for (std::size_t k = 0; k < s.stages().size(); ++k) {
    EXPECT_EQ(s.temperature(s.stage_end(k)), s.stages()[k].end_temperature);
    EXPECT_EQ(s.pressure(s.stage_end(k)), s.stages()[k].end_pressure);
  }
  EXPECT_EQ(s.stage_at(s.stage_end(0)), 1u);
  EXPECT_EQ(s.stage_at(std::nextafter(s.stage_end(0), 0.0)), 0u);
  EXPECT_EQ(s.stage_at(s.end()), 2u);
  EXPECT_DOUBLE_EQ(s.temperature_rate(s.stage_end(0)), (77.7 - 1234.5678) / (s.stage_end(1) - s.stage_end(0)));
  EXPECT_EQ(s.temperature_rate(s.end()), 0.0);
}

// A time loop that steps to each breakpoint in turn meets every one and then none.
TEST(Schedule, NextBreakpointIsLater) {
  const Schedule s = press();
  EXPECT_EQ(s.next_breakpoint(0.0), 60.0);
  EXPECT_EQ(s.next_breakpoint(60.0), 5580.0);
  EXPECT_EQ(s.next_breakpoint(5580.0), 7380.0);
  EXPECT_EQ(s.next_breakpoint(7380.0), std::numeric_limits<double>::infinity());
}

TEST(Schedule, RefusesBadStages) {
  EXPECT_EQ(message_of(300.0, 0.0, {}), "process: there is no stage; give at least one");
  EXPECT_EQ(message_of(300.0, 0.0, {{"hold", 0.0, 300.0, 0.0}}),
            "stage hold: the duration must be positive, and finite");
  EXPECT_EQ(message_of(300.0, 0.0, {{"hold", std::nan(""), 300.0, 0.0}}),
            "stage hold: the duration must be positive, and finite");
  EXPECT_EQ(message_of(300.0, 0.0, {{"cool", 1.0, -1.0, 0.0}}),
            "stage cool: the temperature must be at least 0 K, and finite");
  EXPECT_EQ(message_of(300.0, -1.0, {{"hold", 1.0, 300.0, 0.0}}),
            "process start: the pressure must not be negative, and finite");
}
