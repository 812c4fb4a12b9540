#include "dem/state/cell.h"

#include <gtest/gtest.h>

using namespace densify;
using namespace densify::dem;

// A sheared cell h = [[2,1,0],[0,2,0],[0,0,2]]: the face pairs of x are 2*2*2/|(1,2,0)x(0,0,2)| = 8/sqrt(20) apart.
TEST(Cell, WidthsOfShearedCell) {
  Cell c;
  c.periodic = true;
  c.h << 2, 1, 0, 0, 2, 0, 0, 0, 2;
  EXPECT_NEAR(c.widths()[0], 8 / std::sqrt(20.0), 1e-14);
  EXPECT_NEAR(c.widths()[1], 2, 1e-14);
}

// Wrapping moves by lattice vectors only and lands in [0, 1) of the fractional coordinates.
TEST(Cell, WrapMovesByLatticeVectors) {
  Cell c;
  c.periodic = true;
  c.h << 2, 1, 0, 0, 2, 0, 0, 0, 2;
  const Vec3 x(5.3, -3.1, 2.5), w = c.wrap(x);
  const Vec3 s = c.to_fraction(w), n = c.h.inverse() * (x - w);
  for (int k = 0; k < 3; ++k) {
    EXPECT_GE(s[k], 0);
    EXPECT_LT(s[k], 1);
    EXPECT_NEAR(n[k], std::round(n[k]), 1e-13);
  }
}

TEST(Cell, ImageCodesRoundTrip) {
  for (int a = -1; a <= 1; ++a)
    for (int b = -1; b <= 1; ++b)
      for (int c = -1; c <= 1; ++c) EXPECT_EQ(ImageCode::unpack(ImageCode::of(a, b, c)), Eigen::Vector3i(a, b, c));
  EXPECT_EQ(ImageCode::of(0, 0, 0), +ImageCode::none);
}
