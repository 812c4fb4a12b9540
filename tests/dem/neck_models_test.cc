// The stiffness of a neck as a bonded circle, as a beam, and as both in series, against closed forms.

#include "dem/network/neck_models.h"

#include <gtest/gtest.h>

#include <cmath>

namespace densify::dem {
namespace {

constexpr double youngs = 1e11, poisson = 0.3, shear = youngs / 2.6, radius = 5e-6, spacing = 9.5e-6;

// Half-spaces of one material bonded over a circle (Johnson, Contact Mechanics): 2 E* a with E* = E/(2 (1-nu^2)),
// 4 G a/(2-nu), bending (4/3) E* a^3, torsion (8/3) G a^3.
TEST(NeckModels, BondedCircle) {
  const NeckHalf h{youngs, poisson, radius, 0.5 * spacing};
  const double a = 2e-6, modulus = youngs / (2 * (1 - poisson * poisson));
  const EdgeLaw l = neck_stiffness(NeckModel::bonded_neck, h, h, a, true);
  EXPECT_NEAR(l.coefficient / (2 * modulus * a), 1, 1e-14);
  EXPECT_NEAR(l.lateral / (4 * shear * a / (2 - poisson)), 1, 1e-14);
  EXPECT_NEAR(l.bending / (4.0 / 3 * modulus * a * a * a), 1, 1e-14);
  EXPECT_NEAR(l.torsion / (8.0 / 3 * shear * a * a * a), 1, 1e-14);
  // Unlike bodies: half-spaces in series.
  const NeckHalf other{3e11, 0.2, radius, 0.5 * spacing};
  EXPECT_NEAR(neck_stiffness(NeckModel::bonded_neck, h, other, a, true).coefficient /
                  (2 * effective_modulus(youngs, poisson, 3e11, 0.2) * a),
              1, 1e-14);
  EXPECT_EQ(neck_stiffness(NeckModel::bonded_neck, h, h, a, false).bending, 0);
  EXPECT_EQ(neck_stiffness(NeckModel::bonded_neck, h, h, 0, true).coefficient, 0);
}

// A round beam of length d: E pi a^2/d, G pi a^2/d, E pi a^4/(4 d), G pi a^4/(2 d).  The series is that beam of the
// sphere's radius when the neck is as wide as the sphere, and the bonded circle when it is narrow.
TEST(NeckModels, BeamAndSeries) {
  const NeckHalf h{youngs, poisson, radius, 0.5 * spacing};
  auto beam = [&](double a) {
    return EdgeLaw{youngs * M_PI * a * a / spacing, shear * M_PI * a * a / spacing, 0,
                   youngs * M_PI * std::pow(a, 4) / (4 * spacing), shear * M_PI * std::pow(a, 4) / (2 * spacing)};
  };
  auto near = [](const EdgeLaw& a, const EdgeLaw& b, double tolerance) {
    EXPECT_NEAR(a.coefficient / b.coefficient, 1, tolerance);
    EXPECT_NEAR(a.lateral / b.lateral, 1, tolerance);
    EXPECT_NEAR(a.bending / b.bending, 1, tolerance);
    EXPECT_NEAR(a.torsion / b.torsion, 1, tolerance);
  };
  near(neck_stiffness(NeckModel::neck_beam, h, h, 2e-6, true), beam(2e-6), 1e-14);
  near(neck_stiffness(NeckModel::series, h, h, radius, true), beam(radius), 1e-14);
  // (1 - a/r)^(3/2) and the column's share are both of order a/r = 1e-5.
  const double narrow = 1e-5 * radius;
  near(neck_stiffness(NeckModel::series, h, h, narrow, true),
       neck_stiffness(NeckModel::bonded_neck, h, h, narrow, true), 5e-5);
}

}  // namespace
}  // namespace densify::dem
