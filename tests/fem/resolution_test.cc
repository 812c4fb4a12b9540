// Extrapolation to infinitely fine voxels, of polynomials in 1/n whose value there is known.

#include "fem/resolution.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace densify::fem {
namespace {

TEST(Resolution, ExactForPolynomials) {
  const std::vector<int> n{32, 48, 64};
  std::vector<double> line, parabola;
  for (const int k : n) {
    line.push_back(3 + 2.0 / k);
    parabola.push_back(3 + 2.0 / k - 40.0 / (k * k));
  }
  EXPECT_NEAR(extrapolate(n, line).value, 3, 1e-12);
  EXPECT_NEAR(extrapolate(n, line).error, 0, 1e-12);
  EXPECT_NEAR(extrapolate(n, parabola).value, 3, 1e-12);
  // The line through the last two misses -40/n^2 by 40/(48 x 64).
  EXPECT_NEAR(extrapolate(n, parabola).error, 40.0 / (48 * 64), 1e-12);
}

TEST(Resolution, FewerThanThree) {
  const std::vector<int> two{32, 64}, one{32};
  const auto line = extrapolate(two, std::vector<double>{3 + 2.0 / 32, 3 + 2.0 / 64});
  EXPECT_NEAR(line.value, 3, 1e-12);
  EXPECT_NEAR(line.error, 0.5 * 2.0 / 64, 1e-12);
  EXPECT_EQ(extrapolate(one, std::vector<double>{7.0}).value, 7);
  EXPECT_TRUE(std::isnan(extrapolate(one, std::vector<double>{7.0}).error));
  EXPECT_TRUE(std::isnan(extrapolate({}, {}).value));
}

}  // namespace
}  // namespace densify::fem
