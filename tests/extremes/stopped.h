#pragma once
// Runs that must end by themselves, and for the right reason.

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

}  // namespace densify::test

/// A guard stops the statement and says both texts.
#define EXPECT_STOPS(statement, first, second)                                         \
  do {                                                                                 \
    const std::string cause = ::densify::test::cause_of_stop([&] { statement; });      \
    EXPECT_NE(cause.find(first), std::string::npos) << "it said: \"" << cause << '"';  \
    EXPECT_NE(cause.find(second), std::string::npos) << "it said: \"" << cause << '"'; \
  } while (false)
