#include "base/piecewise_linear.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

#include "base/check.h"

using namespace densify;

namespace {

std::string message_of(std::vector<PiecewiseLinear::Knot> knots) {
  try {
    PiecewiseLinear{std::move(knots)};
  } catch (const InputError& e) {
    return e.what();
  }
  return "accepted";
}

}  // namespace

// Young's modulus falling from 188 GPa at 298 K to 150 GPa at 1673 K: knots exact, the middle 169 GPa by hand.
TEST(PiecewiseLinear, InterpolatesAndHoldsTheEnds) {
  const PiecewiseLinear y({{298.0, 188e9}, {1673.0, 150e9}});
  EXPECT_EQ(y(298.0), 188e9);
  EXPECT_EQ(y(1673.0), 150e9);
  EXPECT_DOUBLE_EQ(y(985.5), 169e9);
  EXPECT_EQ(y(0.0), 188e9);
  EXPECT_EQ(y(3000.0), 150e9);
  EXPECT_FALSE(y.is_constant());
}

// The slope belongs to the piece on the right; none outside.
TEST(PiecewiseLinear, SlopeIsTakenToTheRight) {
  const PiecewiseLinear y({{0.0, 0.0}, {1.0, 2.0}, {3.0, -2.0}});
  EXPECT_EQ(y.slope(-1.0), 0.0);
  EXPECT_EQ(y.slope(0.0), 2.0);
  EXPECT_EQ(y.slope(1.0), -2.0);
  EXPECT_EQ(y.slope(3.0), 0.0);
}

TEST(PiecewiseLinear, ConstantEverywhereAndUnsetIsNaN) {
  const PiecewiseLinear y(0.34);
  EXPECT_EQ(y(-1e9), 0.34);
  EXPECT_EQ(y(1e9), 0.34);
  EXPECT_EQ(y.slope(0.0), 0.0);
  EXPECT_TRUE(y.is_constant());
  EXPECT_TRUE(std::isnan(PiecewiseLinear()(300.0)));
}

TEST(PiecewiseLinear, RefusesBadTables) {
  EXPECT_NE(message_of({}).find("empty"), std::string::npos);
  EXPECT_NE(message_of({{1.0, 0.0}, {2.0, 0.0}, {2.0, 1.0}}).find("pair 3 does not; sort"), std::string::npos);
  EXPECT_NE(message_of({{2.0, 0.0}, {1.0, 0.0}}).find("pair 2 does not"), std::string::npos);
  EXPECT_NE(message_of({{1.0, std::nan("")}}).find("pair 1 of the table is not finite"), std::string::npos);
}
