// The arithmetic of `densify trade` on histories made by formula, and the mistakes of a ladder.

#include <gtest/gtest.h>

#include "app/trade_table.h"
#include "base/check.h"

using namespace densify;
using namespace densify::app;

namespace {

/// A run that ends at t = 1 s with this density.
TradeRun run_with(double density, double cpu) {
  TradeRun run;
  run.cpu = cpu;
  run.history.columns = {"time_s", "relative_density", "stress_zz_Pa", "coordination_number"};
  run.history.values = {{0, 1}, {0.5, density}, {0, -2e6}, {4, 6}};
  run.history.stage = {"press", "press"};
  return run;
}

Ladder ladder_of(std::size_t rungs) {
  Ladder ladder;
  ladder.realisations = 2;
  for (std::size_t r = 0; r < rungs; ++r)
    ladder.rungs.push_back({std::string(1, char('a' + r)), {}, "step", std::pow(2.0, double(r)), r == 0});
  return ladder;
}

/// density = 0.9 + 0.01 size^2 + the packing's own 0 or 0.02; twice the size takes half the time.
std::vector<std::vector<TradeRun>> second_order(std::size_t rungs) {
  std::vector<std::vector<TradeRun>> runs;
  for (std::size_t r = 0; r < rungs; ++r) {
    const double size = std::pow(2.0, double(r)), density = 0.9 + 0.01 * size * size;
    runs.push_back({run_with(density, 8 / size), run_with(density + 0.02, 8 / size)});
  }
  return runs;
}

std::string mistake(const std::string& ladder) {
  try {
    read_ladder_text(ladder);
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

constexpr double rounding = 1e-12;

}  // namespace

// s^2 = ((1-3)^2 + (2-3)^2 + (6-3)^2)/2 = 7, standard error sqrt(7/3).
TEST(Trade, MeanAndStandardError) {
  const Estimate e = estimate({1, 2, 6});
  EXPECT_NEAR(e.mean, 3, rounding);
  EXPECT_NEAR(e.standard_error, std::sqrt(7.0 / 3), rounding);
  EXPECT_TRUE(std::isnan(estimate({1}).standard_error));
}

// What the packings differ in drops out of the error, and stays in the spread: 0.02/sqrt(2).
TEST(Trade, ErrorsAreDifferencesOfTheSamePackings) {
  const auto rows = trade_rows(ladder_of(2), second_order(2), {1.0}, 1.0);
  EXPECT_NEAR(rows[1].density_error[0].mean, 0.03, rounding);
  EXPECT_NEAR(rows[1].standard_error(), 0, rounding);
  EXPECT_NEAR(rows[1].spread, 0.02 / std::sqrt(2.0), rounding);
  EXPECT_NEAR(error_of_mean(rows[1], 2), std::hypot(0.03, 0.01), rounding);
}

// 0.91, 0.94, 1.06: (1.06 - 0.94)/(0.94 - 0.91) = 4 = 2^p, p = 2; at size 0: 0.91 - 0.03/3 = 0.90, which is with the
// mean 0.01 of the packings 0.91.  Their standard error of 0.01 must be smaller than half of the smallest difference,
// so the packings here differ by a tenth.
TEST(Trade, RichardsonWhereTheOrderIsSeen) {
  auto runs = second_order(3);
  for (auto& rung : runs) rung[1] = run_with(rung[0].history.values[1].back() + 0.002, 1);
  const auto rows = trade_rows(ladder_of(3), runs, {1.0}, 1.0);
  const auto seen = orders(ladder_of(3), rows, {"end"});
  ASSERT_EQ(seen.size(), 1u);
  EXPECT_TRUE(seen[0].seen);
  EXPECT_NEAR(seen[0].order, 2, 1e-9);
  EXPECT_NEAR(seen[0].limit, 0.901, 1e-9);
  // Noise of 0.1 hides it.
  for (auto& rung : runs) rung[1] = run_with(rung[0].history.values[1].back() + 0.2, 1);
  EXPECT_FALSE(orders(ladder_of(3), trade_rows(ladder_of(3), runs, {1.0}, 1.0), {"end"})[0].seen);
}

TEST(Trade, ParetoFrontAndCheapest) {
  auto runs = second_order(3);
  for (auto& run : runs[1]) run.cpu = 0.5;  // faster and better than the third
  const auto rows = trade_rows(ladder_of(3), runs, {1.0}, 1.0);
  EXPECT_EQ(pareto_front(rows), (std::vector<std::size_t>{1, 0}));
  EXPECT_EQ(cheapest_for(rows, 0.1), 1u);
  // The converged rung is only as sure as its own mean, 0.01: 0 + 2 x 0.01 is above 0.019 and below 0.021.
  EXPECT_EQ(cheapest_for(rows, 0.019), std::nullopt);
  EXPECT_EQ(cheapest_for(rows, 0.021), 0u);
}

TEST(Trade, AFailedRunHasNoError) {
  auto runs = second_order(2);
  runs[1][0].failure = "stopped";
  const auto rows = trade_rows(ladder_of(2), runs, {1.0}, 1.0);
  EXPECT_EQ(rows[1].failure, "stopped");
  EXPECT_EQ(pareto_front(rows), std::vector<std::size_t>{0});
  EXPECT_NE(trade_csv(ladder_of(2), rows, {"end"}).find("\"stopped\""), std::string::npos);
}

TEST(Trade, MistakesInALadder) {
  const std::string good = "[[rung]]\nname = \"a\"\nconverged = true\n[[rung]]\nname = \"b\"\n";
  EXPECT_EQ(mistake(good), "accepted");
  EXPECT_NE(mistake(good + "converged = true\n").find("2 of the rungs are converged"), std::string::npos);
  EXPECT_NE(mistake("[[rung]]\nname = \"a\"\n").find("0 of the rungs are converged"), std::string::npos);
  EXPECT_NE(mistake(good + "[[rung]]\nname = \"a\"\n").find("another rung has this name"), std::string::npos);
  EXPECT_NE(mistake(good + "size = 2\n").find("give family and size together"), std::string::npos);
  EXPECT_NE(mistake(good + "sett = []\n").find("did you mean \"set\""), std::string::npos);
}
