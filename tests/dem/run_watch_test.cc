// What the summary warns of, in numbers that outlive an interruption, and what an ensemble makes of the estimated
// error.

#include "dem/run_watch.h"

#include <gtest/gtest.h>

#include "dem/ensemble_history.h"

namespace densify::dem {
namespace {

TEST(RunWatch, WarnsTheSameAfterAResumption) {
  RunWatch watch;
  EXPECT_TRUE(watch.warnings({}, 100).empty());
  watch.moving = 10;
  watch.largest_ratio = 3;
  watch.largest_time = 42;
  watch.note_damping(0.009, 5);  // below a per cent
  EXPECT_EQ(watch.damping_share, 0);
  watch.note_damping(0.145, 7);
  watch.note_damping(0.3, 8);  // the first stays
  const auto said = watch.warnings({}, 100);
  ASSERT_EQ(said.size(), 2u);
  EXPECT_NE(said[0].find("14.5 % of the contact forces at process time 7 s"), std::string::npos) << said[0];
  EXPECT_NE(said[1].find("not quasi-static for 10 % of the process"), std::string::npos) << said[1];
  EXPECT_NE(said[1].find("at most 3 at process time 42 s"), std::string::npos) << said[1];
  EXPECT_EQ(RunWatch::from(watch.numbers()).warnings({}, 100), said);
  EXPECT_EQ(watch.warnings({}, 300).size(), 1u);  // 10 of 300 s are short
}

// One run: error 0.05 = sqrt(0.03^2 + 0.04^2), bias 0.03.  Of four the noise is 0.04/2: sqrt(0.03^2 + 0.02^2).
TEST(Ensemble, NoiseOfTheMeanFallsWithTheRootOfTheirNumber) {
  History one;
  one.columns = {"time_s", "relative_density_error", "relative_density_bias"};
  one.values = {{0, 1}, {0.05, 0.05}, {0.03, 0.03}};
  one.stage = {"a", "a"};
  const std::vector<History> four(4, one);
  const EnsembleHistory e = average(four, {0, 1});
  EXPECT_NEAR(e.mean.values[1][1], std::hypot(0.03, 0.02), 1e-15);
  EXPECT_NEAR(e.mean.values[2][1], 0.03, 1e-15);
}

}  // namespace
}  // namespace densify::dem
