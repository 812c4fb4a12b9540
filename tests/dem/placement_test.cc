#include "dem/powder/placement.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "base/check.h"
#include "dem/powder/size_distribution.h"

using namespace densify;
using namespace densify::dem;

namespace {

constexpr double um = 1e-6;
const TruncatedLognormal nial{3.97 * um, 2.50 * um, 1.50 * um, 18.61 * um};

/// Smallest distance of two surfaces over the smaller radius; with `edges` also through periodic images.
double smallest_gap(const std::vector<Vec3>& x, const std::vector<double>& d, const Vec3* edges) {
  double smallest = HUGE_VAL;
  for (std::size_t i = 0; i < x.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      Vec3 t = x[i] - x[j];
      if (edges)
        for (int k = 0; k < 3; ++k) t[k] -= (*edges)[k] * std::round(t[k] / (*edges)[k]);
      smallest = std::min(smallest, (t.norm() - (d[i] + d[j]) / 2) / std::min(d[i] / 2, d[j] / 2));
    }
  }
  return smallest;
}

void expect_inside_box(const Placement& p, const std::vector<double>& d) {
  for (std::size_t i = 0; i < d.size(); ++i) {
    EXPECT_GT(p.position[i].minCoeff(), d[i] / 2);
    EXPECT_GT((p.extent - p.position[i]).minCoeff(), d[i] / 2);
  }
}

double solid_fraction(const std::vector<double>& d, double volume) {
  return solid_volume(d) / volume;
}

}  // namespace

// The NiAl powder (1751 particles) in its die of 58 um: inside, apart, and dense from the start (a solid fraction
// of 0.30 needs no growth of the container; simple random sequential placement of equal spheres jams at 0.38).
TEST(Placement, NickelAluminideInItsDie) {
  const auto d = draw(nial, 1751, 1);
  const Placement p = place_loosely(d, CylinderContainer{58 * um}, 2);
  ASSERT_EQ(p.position.size(), d.size());
  EXPECT_GT(smallest_gap(p.position, d, nullptr), 0);
  for (std::size_t i = 0; i < d.size(); ++i) {
    EXPECT_LT(std::hypot(p.position[i][0], p.position[i][1]) + d[i] / 2, 29 * um);
    EXPECT_GT(p.position[i][2], d[i] / 2);
    EXPECT_LT(p.position[i][2], p.extent[2] - d[i] / 2);
  }
  EXPECT_EQ(p.extent[0], 58 * um);
  const double fraction = solid_fraction(d, std::numbers::pi / 4 * std::pow(58 * um, 2) * p.extent[2]);
  EXPECT_NEAR(p.solid_fraction, fraction, 1e-12);
  EXPECT_GT(fraction, 0.25);
}

TEST(Placement, BoxWithWalls) {
  const auto d = draw(nial, 600, 1);
  const Placement p = place_loosely(d, BoxContainer{50 * um, 40 * um}, 2);
  expect_inside_box(p, d);
  EXPECT_GT(smallest_gap(p.position, d, nullptr), 0);
  EXPECT_EQ(p.extent.head<2>(), Eigen::Vector2d(50 * um, 40 * um));
  EXPECT_GT(p.solid_fraction, 0.15);
}

// Periodic: apart through the faces as well, with the proportions asked for.
TEST(Placement, PeriodicBox) {
  const auto d = draw(nial, 800, 1);
  const Placement p = place_loosely(d, PeriodicContainer{Vec3(1, 2, 1.5)}, 2);
  expect_inside_box(p, d);
  EXPECT_GT(smallest_gap(p.position, d, &p.extent), 0);
  EXPECT_NEAR(p.extent[1] / p.extent[0], 2, 1e-12);
  EXPECT_NEAR(p.extent[2] / p.extent[0], 1.5, 1e-12);
  EXPECT_NEAR(p.solid_fraction, solid_fraction(d, p.extent.prod()), 1e-12);
  EXPECT_GT(p.solid_fraction, 0.15);
}

// Ratio of sizes 100: one large particle a thousandth of the number.
TEST(Placement, WideSizes) {
  std::vector<double> d(1500, 0.01);
  d[700] = 1;
  const Placement p = place_loosely(d, PeriodicContainer{Vec3(1, 1, 1)}, 2);
  EXPECT_GT(smallest_gap(p.position, d, &p.extent), 0);
}

// Equal particles share one set; a random part of the cells stays empty.
TEST(Placement, EqualParticles) {
  const std::vector<double> d(1000, 2.0);
  const Placement p = place_loosely(d, BoxContainer{21, 21}, 5);
  EXPECT_GT(smallest_gap(p.position, d, nullptr), 0);
  EXPECT_GT(p.solid_fraction, 0.2);
}

// Well mixed: with 1751 particles the mean height by number lies at half the height; the deviation of a uniform
// height is 0.29 / sqrt(1751) = 0.007, of which four are allowed.
TEST(Placement, IsUniformOverTheHeight) {
  const auto d = draw(nial, 1751, 1);
  const Placement p = place_loosely(d, CylinderContainer{58 * um}, 3);
  double mean = 0;
  for (const Vec3& x : p.position) mean += x[2] / p.extent[2] / 1751;
  EXPECT_NEAR(mean, 0.5, 0.028);
}

TEST(Placement, SeedDecides) {
  const auto d = draw(nial, 200, 1);
  const PlacementContainer box = PeriodicContainer{Vec3(1, 1, 1)};
  EXPECT_EQ(place_loosely(d, box, 1).position, place_loosely(d, box, 1).position);
  EXPECT_NE(place_loosely(d, box, 1).position, place_loosely(d, box, 2).position);
}

// The same arrangement at a size 2^20 times larger, exactly: scaling by a power of two rounds nothing.
TEST(Placement, ScalesWithTheUnit) {
  const auto d = draw(nial, 300, 1);
  auto large = d;
  for (double& x : large) x *= 0x1p20;
  const Placement p = place_loosely(d, CylinderContainer{58 * um}, 1);
  const Placement q = place_loosely(large, CylinderContainer{58 * um * 0x1p20}, 1);
  for (std::size_t i = 0; i < d.size(); ++i) EXPECT_EQ(p.position[i] * 0x1p20, q.position[i]);
}

// One particle barely narrower than its die stands alone in every layer.
TEST(Placement, ParticlesAsWideAsTheContainer) {
  const std::vector<double> d(5, 1.0);
  const Placement p = place_loosely(d, CylinderContainer{1.001}, 1);
  EXPECT_GT(smallest_gap(p.position, d, nullptr), 0);
  EXPECT_GE(p.extent[2], 5);
}

TEST(Placement, RefusesWhatCannotFit) {
  const std::vector<double> d = {1, 2};
  EXPECT_THROW(place_loosely(d, CylinderContainer{2}, 1), InputError);
  EXPECT_THROW(place_loosely(d, CylinderContainer{std::nan("")}, 1), InputError);
  EXPECT_THROW(place_loosely(d, BoxContainer{5, 1.5}, 1), InputError);
  EXPECT_THROW(place_loosely(d, PeriodicContainer{Vec3(1, 0, 1)}, 1), InputError);
  EXPECT_THROW(place_loosely(d, PeriodicContainer{Vec3(1, std::nan(""), 1)}, 1), InputError);
  EXPECT_THROW(place_loosely(std::vector<double>{}, CylinderContainer{2}, 1), InputError);
  EXPECT_THROW(place_loosely(std::vector<double>{1, -1}, CylinderContainer{2}, 1), InputError);
}
