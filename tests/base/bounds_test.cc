// Bounds of mixtures against the thesis's composite, closed forms and each other.

#include "base/bounds.h"

#include <gtest/gtest.h>

#include <array>

using namespace densify;

namespace {

// Ultrasonic moduli of NiAl hot-pressed to 0.99 (thesis Table 3.3) and those of alumina that the printed means of Voigt
// and Reuss ask for, 404 GPa, with nu = 0.23 of Table 3.1.
const std::array<Phase, 2> thesis_composite{Phase{0.8, isotropic_moduli(183e9, 0.321)},
                                            {0.2, isotropic_moduli(404e9, 0.23)}};

}  // namespace

TEST(Isotropic, ThereAndBack) {
  const IsotropicModuli m = isotropic_moduli(188e9, 0.31);
  EXPECT_NEAR(m.bulk, 188e9 / 1.14, 1);
  EXPECT_NEAR(m.youngs() / 188e9, 1, 1e-14);
  EXPECT_NEAR(m.poisson(), 0.31, 1e-14);
}

// Thesis 3.3.3: 205.5 to 227.2 GPa (Voigt and Reuss, printed digits) and 213.6 to 217.8 GPa (Hashin and Shtrikman; to
// 0.2 GPa, what the Poisson's ratio of its alumina, which is not printed here, can change).
TEST(Bounds, CompositeOfTheThesis) {
  const YoungsBounds means = reuss_voigt(thesis_composite);
  EXPECT_NEAR(means.lower, 205.5e9, 0.05e9);
  EXPECT_NEAR(means.upper, 227.2e9, 0.05e9);
  const YoungsBounds hs = hashin_shtrikman(thesis_composite).youngs();
  EXPECT_NEAR(hs.lower, 213.6e9, 0.2e9);
  EXPECT_NEAR(hs.upper, 217.8e9, 0.2e9);
  const double dense = dense_solid(thesis_composite).youngs();
  EXPECT_GT(dense, hs.lower);
  EXPECT_LT(dense, hs.upper);
}

// A porous body: K <= K_s + (1-c)/(-1/K_s + 3c/(3 K_s + 4 G_s)), G <= G_s + (1-c)/(-1/G_s + 6c (K_s + 2 G_s)/(5 G_s
// (3 K_s + 4 G_s))) (Hashin and Shtrikman, 1963), to rounding; nothing from below.
TEST(Bounds, Porous) {
  const IsotropicModuli s = isotropic_moduli(1, 0.3);
  const double c = 0.8;
  const auto body = with_pores(std::array{Phase{1, s}}, c);
  const ModuliBounds b = hashin_shtrikman(body);
  EXPECT_NEAR(b.upper.bulk, s.bulk + (1 - c) / (-1 / s.bulk + 3 * c / (3 * s.bulk + 4 * s.shear)), 1e-14);
  EXPECT_NEAR(
      b.upper.shear,
      s.shear + (1 - c) / (-1 / s.shear + 6 * c * (s.bulk + 2 * s.shear) / (5 * s.shear * (3 * s.bulk + 4 * s.shear))),
      1e-14);
  EXPECT_EQ(b.youngs().lower, 0);
  EXPECT_EQ(reuss_voigt(body).lower, 0);
  EXPECT_NEAR(reuss_voigt(body).upper, c, 1e-14);
}

// One phase in pieces is that phase; three phases lie between the least and the largest, and a phase of no volume does
// not count.
TEST(Bounds, NumberOfPhases) {
  const IsotropicModuli a = isotropic_moduli(1, 0.2), b = isotropic_moduli(2, 0.3), c = isotropic_moduli(5, 0.25);
  const auto same = hashin_shtrikman(std::array{Phase{0.3, b}, Phase{0.5, b}, Phase{0.2, b}});
  EXPECT_NEAR(same.lower.bulk, b.bulk, 1e-14);
  EXPECT_NEAR(same.upper.shear, b.shear, 1e-14);
  const auto three = hashin_shtrikman(std::array{Phase{0.3, a}, Phase{0.3, b}, Phase{0.4, c}});
  EXPECT_LT(1, three.youngs().lower);
  EXPECT_LT(three.youngs().lower, three.youngs().upper);
  EXPECT_LT(three.youngs().upper, reuss_voigt(std::array{Phase{0.3, a}, Phase{0.3, b}, Phase{0.4, c}}).upper);
  const auto two = hashin_shtrikman(std::array{Phase{0.4, a}, Phase{0.6, b}}),
             with_none = hashin_shtrikman(std::array{Phase{0.4, a}, Phase{0, c}, Phase{0.6, b}});
  EXPECT_EQ(two.upper.bulk, with_none.upper.bulk);
}
