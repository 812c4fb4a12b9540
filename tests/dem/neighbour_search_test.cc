#include "dem/contact/neighbour_search.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>
#include <set>

#include "base/check.h"

using namespace densify;
using namespace densify::dem;

namespace {

Cell periodic_cell(const Mat3& h, const Vec3& origin = Vec3(0.3, -0.7, 1.1)) {
  Cell c;
  c.periodic = true;
  c.h = h;
  c.origin = origin;
  return c;
}

Body body(const Vec3& x, double r) {
  return {x, r, Vec3::Zero(), 1};
}

/// Centres anywhere in the cell (overlaps do not matter), radii log-uniform between 1/ratio and 1 times `r_max`.
std::vector<Body> random_bodies(const Cell& cell, int count, double r_max, double ratio, unsigned seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> u(0, 1);
  std::vector<Body> bodies;
  for (int i = 0; i < count; ++i) {
    const Vec3 s(u(random), u(random), u(random));
    bodies.push_back(body(cell.from_fraction(s), r_max * std::pow(ratio, -u(random))));
  }
  return bodies;
}

/// The definition itself: every pair through every image.
std::vector<CandidatePair> brute_force(const std::vector<Body>& bodies, const Cell& cell, double skin) {
  std::vector<CandidatePair> out;
  for (std::uint32_t i = 0; i < bodies.size(); ++i) {
    for (std::uint32_t j = i; j < bodies.size(); ++j) {
      for (std::uint8_t code = 0; code < 27; ++code) {
        if (!cell.periodic && code != ImageCode::none) continue;
        if (i == j && code <= ImageCode::none) continue;
        const Vec3 shift = cell.periodic ? cell.shift(code) : Vec3(0, 0, 0);
        const Vec3 d = (bodies[j].position - bodies[i].position) + shift;
        if (d.norm() < bodies[i].radius + bodies[j].radius + skin) out.push_back({i, j, code});
      }
    }
  }
  return out;
}

std::vector<CandidatePair> found(const std::vector<Body>& bodies, const Cell& cell, double skin) {
  std::vector<CandidatePair> out, on_three_threads;
  find_pairs(bodies, cell, skin, 1, out);
  find_pairs(bodies, cell, skin, 3, on_three_threads);
  EXPECT_EQ(out, on_three_threads);
  return out;
}

Mat3 orthogonal() {
  return Vec3(9, 8, 10).asDiagonal();
}

Mat3 triclinic() {
  Mat3 h;
  h << 9, 3.5, -2, 0.5, 8, 3, 0.2, -0.4, 10;
  return h;
}

}  // namespace

// Random centres at size ratios 1, 12, 50, 100, free, orthogonal and triclinic, against the definition: identical
// lists, order included.  r_max = 1 in a cell about 9 wide wraps most searches of the largest.
TEST(NeighbourSearch, EqualsBruteForce) {
  unsigned seed = 1;
  for (double ratio : {1.0, 12.0, 50.0, 100.0}) {
    for (const Mat3& h : {orthogonal(), triclinic()}) {
      for (double skin : {0.0, 0.1}) {
        Cell cell = periodic_cell(h);
        const auto bodies = random_bodies(cell, 700, 1.0, ratio, seed++);
        const auto expected = brute_force(bodies, cell, skin);
        ASSERT_GT(expected.size(), 200u);
        EXPECT_EQ(found(bodies, cell, skin), expected) << "ratio " << ratio << " skin " << skin;
        cell.periodic = false;
        EXPECT_EQ(found(bodies, cell, skin), brute_force(bodies, cell, skin)) << "free, ratio " << ratio;
      }
    }
  }
}

// Small particles in a wide domain: most cells are empty, so cells share buckets.
TEST(NeighbourSearch, EqualsBruteForceWhenSparse) {
  for (double ratio : {1.0, 100.0}) {
    Cell cell = periodic_cell(triclinic());
    const auto bodies = random_bodies(cell, 1500, 0.3, ratio, 77);
    const auto expected = brute_force(bodies, cell, 0.01);
    ASSERT_GT(expected.size(), 30u);
    EXPECT_EQ(found(bodies, cell, 0.01), expected);
    cell.periodic = false;
    EXPECT_EQ(found(bodies, cell, 0.01), brute_force(bodies, cell, 0.01));
  }
}

// Cells narrower than two diameters: pairs touch through several images and particles touch themselves.
TEST(NeighbourSearch, EqualsBruteForceInNarrowCells) {
  int repeated = 0, own_image = 0;
  for (unsigned seed = 0; seed < 200; ++seed) {
    const Cell cell = periodic_cell((seed % 2 ? triclinic() : orthogonal()) * 0.22);
    const auto bodies = random_bodies(cell, 6, 1.1, 3.0, seed);
    std::vector<CandidatePair> pairs;
    try {
      find_pairs(bodies, cell, 0.05, 1 + int(seed % 3), pairs);
    } catch (const InputError&) {
      continue;  // a pair through two translations; the brute force does not look there
    }
    EXPECT_EQ(pairs, brute_force(bodies, cell, 0.05)) << seed;
    for (std::size_t k = 0; k < pairs.size(); ++k) {
      own_image += pairs[k].i == pairs[k].j;
      repeated += k > 0 && pairs[k].i == pairs[k - 1].i && pairs[k].j == pairs[k - 1].j;
    }
  }
  EXPECT_GT(repeated, 100);
  EXPECT_GT(own_image, 20);
}

// The same list in micrometres and kilometres: no length is built in.
TEST(NeighbourSearch, ScalesWithoutALengthOfItsOwn) {
  const Cell cell = periodic_cell(triclinic());
  const auto bodies = random_bodies(cell, 600, 1.0, 12.0, 5);
  const auto expected = found(bodies, cell, 0.1);
  for (double scale : {1e-6, 1e3}) {
    Cell scaled_cell = cell;
    scaled_cell.h *= scale;
    scaled_cell.origin *= scale;
    auto scaled = bodies;
    for (Body& b : scaled) {
      b.position *= scale;
      b.radius *= scale;
    }
    EXPECT_EQ(found(scaled, scaled_cell, 0.1 * scale), expected);
  }
}

// Renumbered particles give the renumbered list; a pair that changes its order sees the opposite image.
TEST(NeighbourSearch, FollowsRenumbering) {
  const Cell cell = periodic_cell(orthogonal());
  const auto bodies = random_bodies(cell, 500, 1.0, 12.0, 6);
  std::vector<std::uint32_t> place(bodies.size());
  std::iota(place.begin(), place.end(), 0);
  std::shuffle(place.begin(), place.end(), std::mt19937_64(7));
  std::vector<Body> renumbered(bodies.size());
  for (std::size_t i = 0; i < bodies.size(); ++i) renumbered[place[i]] = bodies[i];
  auto expected = found(bodies, cell, 0.1);
  for (CandidatePair& p : expected) {
    const std::uint32_t i = place[p.i], j = place[p.j];
    p = i <= j ? CandidatePair{i, j, p.image} : CandidatePair{j, i, std::uint8_t(2 * ImageCode::none - p.image)};
  }
  std::sort(expected.begin(), expected.end());
  EXPECT_EQ(found(renumbered, cell, 0.1), expected);
}

// Unit cell of a body-centred cubic crystal: two particles, edge 4 r / sqrt(3), each with 8 neighbours: 8 contacts.
TEST(NeighbourSearch, BodyCentredUnitCellHasEightContacts) {
  const double r = 1e-6, a = 4 * r / std::sqrt(3.0);
  const Cell cell = periodic_cell(Mat3::Identity() * a, Vec3::Zero());
  const std::vector<Body> bodies = {body(Vec3::Zero(), r), body(Vec3::Constant(a / 2), r)};
  const auto pairs = found(bodies, cell, 0.05 * r);
  ASSERT_EQ(pairs.size(), 8u);
  std::set<int> images;
  for (const CandidatePair& p : pairs) {
    EXPECT_EQ(p.i, 0u);
    EXPECT_EQ(p.j, 1u);
    images.insert(p.image);
    EXPECT_NEAR((bodies[1].position + cell.shift(p.image) - bodies[0].position).norm(), 2 * r, 1e-12 * r);
  }
  EXPECT_EQ(images.size(), 8u);
}

// One particle in a cubic cell of its diameter: simple cubic, 6 neighbours = 3 contacts with its own images.
TEST(NeighbourSearch, OneParticleTouchesItsOwnImages) {
  const Cell cell = periodic_cell(Mat3::Identity() * 2.0, Vec3::Zero());
  const auto pairs = found({body(Vec3(0.4, 1.9, 0), 1)}, cell, 0.1);
  const std::vector<CandidatePair> expected = {
      {0, 0, ImageCode::of(0, 0, 1)}, {0, 0, ImageCode::of(0, 1, 0)}, {0, 0, ImageCode::of(1, 0, 0)}};
  EXPECT_EQ(pairs, expected);
}

// Two particles at faces of the cell, to the last bit inside, and just outside by rounding.
TEST(NeighbourSearch, PositionsOnTheFaces) {
  const Cell cell = periodic_cell(Mat3::Identity() * 20.0, Vec3::Zero());
  for (double x : {0.0, std::nextafter(20.0, 0.0), 20.0, -1e-17}) {
    const double y = x > 10 ? 1.5 : 18.5;
    const auto pairs = found({body(Vec3(x, 5, 5), 1), body(Vec3(y, 5, 5), 1)}, cell, 0);
    ASSERT_EQ(pairs.size(), 1u) << x;
    EXPECT_EQ(pairs[0].image, ImageCode::of(x > 10 ? 1 : -1, 0, 0));
  }
}

// Ten nanometres beside a millimetre, and pairs a metre apart: memory follows the particles, not the volume.
TEST(NeighbourSearch, FarApartAndFarFromEqual) {
  const double s = 1e-8, l = 1e-3;
  const std::vector<Body> bodies = {body(Vec3::Zero(), s), body(Vec3(1.9 * s, 0, 0), s),
                                    body(Vec3(-l - 0.5 * s, 0, 0), l), body(Vec3(1, 1, 1), s),
                                    body(Vec3(1, 1, 1 - 1.9 * s), s)};
  const std::vector<CandidatePair> expected = {{0, 1, 13}, {0, 2, 13}, {3, 4, 13}};
  EXPECT_EQ(found(bodies, Cell{}, 1e-9), expected);
}

// All centres in one point, and a single free particle: domains without extent.
TEST(NeighbourSearch, DomainsWithoutExtent) {
  const std::vector<Body> three(3, body(Vec3(1, 2, 3), 0.5));
  EXPECT_EQ(found(three, Cell{}, 0).size(), 3u);
  EXPECT_TRUE(found({three[0]}, Cell{}, 0).empty());
  EXPECT_TRUE(found({}, Cell{}, 0).empty());
}

// Width 1.5 under a reach of 2: the copies two cells away touch (0.1 and 1.4 are 1.7 = 1.3 - 2 * 1.5 apart).
TEST(NeighbourSearch, RefusesCellWherePairTouchesThroughTwoTranslations) {
  const Cell cell = periodic_cell(Vec3(1.5, 20, 20).asDiagonal(), Vec3::Zero());
  try {
    found({body(Vec3(0.1, 5, 5), 1), body(Vec3(1.4, 5, 5), 1)}, cell, 0);
    FAIL() << "accepted";
  } catch (const InputError& e) {
    EXPECT_NE(std::string(e.what()).find("at least 2 m wide"), std::string::npos) << e.what();
    EXPECT_NE(std::string(e.what()).find("1.5 m wide along a"), std::string::npos) << e.what();
  }
}

// A cell of a millionth of a diameter is refused at once, not walked image by image.
TEST(NeighbourSearch, RefusesCellFarNarrowerThanAParticle) {
  const Cell cell = periodic_cell(Vec3(20, 20, 1e-6).asDiagonal(), Vec3::Zero());
  EXPECT_THROW(found({body(Vec3(5, 5, 0), 1)}, cell, 0), InputError);
}

TEST(NeighbourSearch, RefusesPositionsThatAreNotFinite) {
  for (double bad : {std::nan(""), HUGE_VAL})
    EXPECT_THROW(found({body(Vec3(0, 0, 0), 1), body(Vec3(bad, 0, 0), 1)}, Cell{}, 0), RunError);
}
