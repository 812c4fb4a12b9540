// Curves of Roberts and Garboczi, and what is measured on specimens, against printed numbers.

#include "base/roberts_garboczi.h"

#include <gtest/gtest.h>

#include "base/specimen_tests.h"

using namespace densify;

// Ends of both curves: the solid at full density; nothing at rho_0; nu_1 at rho_1, whatever the solid (3.7, 3.8).
TEST(RobertsGarboczi, Ends) {
  for (const auto& curve : {overlapping_solid_spheres, overlapping_spherical_pores}) {
    EXPECT_EQ(curve.youngs_ratio(1), 1);
    EXPECT_EQ(curve.poissons_ratio(1, 0.31), 0.31);
    EXPECT_EQ(curve.youngs_ratio(curve.rho_0), 0);
    EXPECT_EQ(curve.youngs_ratio(0.1), 0);
    EXPECT_NEAR(curve.poissons_ratio(curve.rho_1, 0.31), curve.nu_1, 1e-15);
  }
}

// E/E_0 with Table 3.4, computed apart from this code at densities rounded to three digits, which is worth 0.0017;
// the others to half a unit of the last digit.
TEST(RobertsGarboczi, Values) {
  const double density[] = {0.714, 0.773, 0.813, 0.859, 0.918, 0.989};
  const double due[] = {0.276, 0.386, 0.470, 0.582, 0.742, 0.964};
  for (int k = 0; k < 6; ++k) EXPECT_NEAR(overlapping_solid_spheres.youngs_ratio(density[k]), due[k], 1.7e-3);
  EXPECT_NEAR(overlapping_spherical_pores.youngs_ratio(0.8), 0.6296, 5e-5);  // (0.618/0.818)^1.65
  EXPECT_NEAR(overlapping_solid_spheres.poissons_ratio(0.8, 0.3), 0.2322, 5e-5);
  EXPECT_NEAR(overlapping_spherical_pores.poissons_ratio(0.8, 0.3), 0.2812, 5e-5);
}

// Rows of thesis Table 3.2 for NiAl (theoretical density 5910 kg/m^3): the speeds that give E and nu by (3.3) and (3.4)
// as they are printed, E = rho (3 V_L^2 V_T^2 - 4 V_T^4)/(V_L^2 - V_T^2), nu = (V_L^2/2 - V_T^2)/(V_L^2 - V_T^2).
TEST(SpecimenTests, MeasuredRows) {
  const double rows[][3] = {{0.79, 70e9, 0.283}, {0.89, 127e9, 0.289}, {0.92, 153e9, 0.305}, {0.99, 183e9, 0.321}};
  for (const auto& [relative_density, e, nu] : rows) {
    const double rho = relative_density * 5910;
    const double l = std::sqrt(e * (1 - nu) / (rho * (1 + nu) * (1 - 2 * nu))), t = std::sqrt(e / (2 * rho * (1 + nu)));
    const double printed_e = rho * (3 * l * l * t * t - 4 * t * t * t * t) / (l * l - t * t);
    const IsotropicModuli m = moduli_of_waves(rho, l, t);
    EXPECT_NEAR(m.youngs() / printed_e, 1, 1e-13);
    EXPECT_NEAR(m.youngs() / e, 1, 1e-13);
    EXPECT_NEAR(m.poisson(), (l * l / 2 - t * t) / (l * l - t * t), 1e-13);
    EXPECT_NEAR(m.shear / (e / (2 * (1 + nu))), 1, 1e-13);
  }
}

// 2 L/dt; 2 P/(pi h d) of the thesis's disc of 12 mm by 6 mm at 10 kN: 88.4 MPa; exp(-11 x 0.1) = 0.3329.
TEST(SpecimenTests, SpeedAndStrength) {
  EXPECT_NEAR(pulse_echo_speed(8e-3, 2.5e-6), 6400, 1e-9);
  EXPECT_NEAR(brazilian_strength(10e3, 6e-3, 12e-3), 88.42e6, 5e3);
  EXPECT_NEAR(ryshkewitch_strength_ratio(0.9, thesis_strength_exponent), 0.3329, 5e-5);
  EXPECT_EQ(ryshkewitch_strength_ratio(1, 5), 1);
}
