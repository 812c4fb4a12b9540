#include "dem/integrate/time_step.h"

#include <gtest/gtest.h>

namespace densify::dem {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

// Two free masses m with a spring k: 2/omega with omega = sqrt(2 k/m) (4.69, 4.70).
TEST(NodeLimit, SpringAlone) {
  EXPECT_NEAR(node_limit(2, 50, 0), 2 / std::sqrt(2 * 50 / 2.0), 1e-15);
}

// Two free masses with a dashpot eta: m/eta, half of (4.72).
TEST(NodeLimit, DashpotAlone) {
  EXPECT_NEAR(node_limit(2, 0, 50), 2 / 50.0, 1e-16);
}

// Spring and damper of one pair: (4.71), 2/omega (sqrt(1 + xi^2) - xi) with xi = c/(2 sqrt(m_red k)), m_red = m/2.
TEST(NodeLimit, SpringAndDamper) {
  for (double xi : {0.01, 0.3, 1.0, 5.0}) {
    const double m = 2, k = 50, c = 2 * xi * std::sqrt(0.5 * m * k);
    EXPECT_NEAR(node_limit(m, k, c) / (2 / std::sqrt(2 * k / m) * (std::sqrt(1 + xi * xi) - xi)), 1, 1e-12) << xi;
  }
}

// A dashpot that outweighs the spring by many orders leaves m/eta, not the zero of a cancelled difference.
TEST(NodeLimit, HeavyDamping) {
  EXPECT_NEAR(node_limit(4.256e-10, 7e5, 3.34e8) / (4.256e-10 / 3.34e8), 1, 1e-12);
}

TEST(NodeLimit, NothingAttached) {
  EXPECT_EQ(node_limit(1, 0, 0), infinity);
}

// The thesis's own limits of a contact, reduced mass m/2: (4.71), (4.72) 2 m/eta, (4.73)-(4.75).
TEST(ThesisLimit, AsPrinted) {
  const double m = 2, k = 50;
  EXPECT_NEAR(thesis_limit({k, 0, infinity, 0, 0}, m / 2), 2 / std::sqrt(2 * k / m), 1e-14);
  const double xi = 0.4, c = 2 * xi * std::sqrt(m / 2 * k);
  EXPECT_NEAR(thesis_limit({k, c, infinity, 0, 0}, m / 2), 2 / std::sqrt(2 * k / m) * (std::sqrt(1 + xi * xi) - xi),
              1e-14);
  EXPECT_NEAR(thesis_limit({infinity, 0, 300, 0, 0}, m / 2), 2 * m / 300, 1e-16);
  EXPECT_NEAR(thesis_limit({k, 0, 3, 0, 0}, m / 2), 3 / k, 1e-16);  // relaxation time rules
  EXPECT_NEAR(thesis_limit({k, 0, 3e5, 0, 0}, m / 2), 2 / std::sqrt(2 * k / m), 1e-14);
  EXPECT_EQ(thesis_limit({0, 0, infinity, 0, 0}, m / 2), infinity);
}

}  // namespace
}  // namespace densify::dem
