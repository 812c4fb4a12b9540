#pragma once
// Runs that must end by themselves, and for the right reason.

#include <gtest/gtest.h>

#include "base/check.h"
#include "tests/support/setups.h"

namespace densify::test {

/// Up to `steps` steps, or to the end of the schedule.
inline void run_at_most(Simulation& sim, std::uint64_t steps) {
  for (std::uint64_t n = 0; n < steps && !sim.finished(); ++n) sim.advance();
}

/// What a guard says when it stops `work`; empty when nothing does.
template <class Work>
std::string cause_of_stop(Work&& work) {
  try {
    work();
  } catch (const RunError& error) {
    return error.what();
  }
  return "";
}

/// From a time on the punch carries the pressure in the mean to 1 %, or, beyond 100 MPa, a guard has named a particle.
inline void expect_pressure_is_carried(Simulation& sim, double pressure, double from) {
  double impulse = 0, time = 0;
  const std::string cause = cause_of_stop([&] {
    while (!sim.finished()) {
      sim.advance();
      if (sim.state().time < from) continue;
      impulse += sim.state().walls.normal_force()[*sim.wall("punch")] * sim.state().last_step;
      time += sim.state().last_step;
    }
  });
  if (cause.empty()) {
    EXPECT_NEAR(impulse / time / (pressure * sim.punch_area()), 1, 0.01) << pressure;
  } else {
    EXPECT_GT(pressure, 1e8) << cause;
    EXPECT_NE(cause.find("particle"), std::string::npos) << cause;
  }
}

}  // namespace densify::test

/// A guard stops the statement and says both texts.
#define EXPECT_STOPS(statement, first, second)                                         \
  do {                                                                                 \
    const std::string cause = ::densify::test::cause_of_stop([&] { statement; });      \
    EXPECT_NE(cause.find(first), std::string::npos) << "it said: \"" << cause << '"';  \
    EXPECT_NE(cause.find(second), std::string::npos) << "it said: \"" << cause << '"'; \
  } while (false)
