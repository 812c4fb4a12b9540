// Deviations of routes from curves and from each other, and tables of measurements.

#include "app/comparison.h"

#include <gtest/gtest.h>

#include <cmath>

#include "app/measured_moduli.h"
#include "base/check.h"
#include "base/roberts_garboczi.h"
#include "tests/dem/scratch_folder.h"

namespace densify::app {
namespace {

ModuliPoint point(double density, double youngs, double poisson) {
  ModuliPoint p;
  p.relative_density = density, p.youngs = youngs, p.poisson = poisson;
  return p;
}

const DenseBody nial{{Phase{1, isotropic_moduli(188e9, 0.31)}}};

// A route on the curve of solid spheres times 1.1, and 0.01 above its nu: deviations of 10 % and 0.01, to rounding.
TEST(Comparison, DeviationsFromCurves) {
  Route route{"r", "series", {}};
  for (const double density : {0.7, 0.8, 0.95}) {
    const Curves c = curves_at(nial, density);
    EXPECT_NEAR(c.solid_spheres / (188e9 * overlapping_solid_spheres.youngs_ratio(density)), 1, 1e-12);
    EXPECT_LT(c.solid_spheres, c.spherical_pores);
    EXPECT_LT(c.spherical_pores, c.hashin_shtrikman);
    EXPECT_LT(c.hashin_shtrikman, c.voigt);
    route.points.push_back(point(density, 1.1 * c.solid_spheres, c.solid_spheres_poisson + 0.01));
  }
  const auto all = deviations_from_curves(route, nial);
  ASSERT_EQ(all.size(), 2u);
  EXPECT_EQ(all[0].reference, "solid_spheres");
  EXPECT_EQ(all[0].number, 3);
  for (const double d : {all[0].mean, all[0].rms, all[0].worst}) EXPECT_NEAR(d, 0.1, 1e-12);
  EXPECT_NEAR(all[0].poisson_mean, 0.01, 1e-12);
  EXPECT_NEAR(all[0].poisson_rms, 0.01, 1e-12);
  EXPECT_LT(all[1].mean, 0);
}

// A line of E = 100 GPa at 0.7 to 200 GPa at 0.9 against measurements, two of one density: linear between the points
// (150 GPa at 0.8), nothing said beyond the ends, and a modulus without nu counts for E alone.
TEST(Comparison, DeviationFromMeasurements) {
  const Route route{"r", "series", {point(0.7, 100e9, 0.2), point(0.9, 200e9, 0.3)}};
  const Route measured{"measured",
                       "measured",
                       {point(0.65, 1e9, 0.1), point(0.8, 120e9, 0.27), point(0.8, 200e9, std::nan("")),
                        point(0.9, 200e9, 0.3), point(0.95, 1e9, 0.3)}};
  const Deviation d = deviation_from(route, measured);
  EXPECT_EQ(d.number, 3);
  EXPECT_NEAR(d.mean, (0.25 - 0.25 + 0) / 3, 1e-12);
  EXPECT_NEAR(d.rms, std::sqrt(2 * 0.0625 / 3), 1e-12);
  EXPECT_NEAR(std::abs(d.worst), 0.25, 1e-12);
  EXPECT_NEAR(d.worst_density, 0.8, 1e-12);
  EXPECT_NEAR(d.poisson_mean, (0.25 - 0.27) / 2, 1e-12);
  EXPECT_EQ(deviation_from(route, Route{"m", "m", {point(0.5, 1e9, 0.3)}}).number, 0);
}

class MeasuredTable : public ::testing::Test {
 protected:
  Route read(const std::string& text) {
    dem::testing::write_plainly(folder_ / "measured.csv", text);
    return read_measured_moduli(folder_ / "measured.csv");
  }
  void refuses(const std::string& text, const std::string& due) {
    const std::string message = dem::testing::message_of<InputError>([&] { read(text); });
    EXPECT_NE(message.find(due), std::string::npos) << message;
  }
  dem::testing::ScratchFolder folder_;
};

// Moduli as such and from waves: 5850.9 kg/m^3 with V_L = 6701.3, V_T = 3440.7 m/s is NiAl at 0.99, 183 GPa and 0.321,
// by (3.3) and (3.4) to the printed digits; a disc of 12 mm by 6 mm that breaks at 10 kN carries 88.42 MPa (3.6).
TEST_F(MeasuredTable, ModuliWavesAndStrengths) {
  const Route m = read(
      "# a comment\nnote, relative_density,youngs_modulus_GPa,poissons_ratio,density_kg_per_m3,"
      "longitudinal_speed_m_per_s,transverse_speed_m_per_s,strength_MPa,peak_force_N,disc_height_mm,"
      "disc_diameter_mm\r\n"
      "b,0.99,,,5850.9,6701.3,3440.7,,10e3,6,12\r\n"
      "a,0.79,70,0.283,,,,55,,,\n");
  ASSERT_EQ(m.points.size(), 2u);
  EXPECT_EQ(m.points[0].relative_density, 0.79);
  EXPECT_NEAR(m.points[0].youngs, 70e9, 1);
  EXPECT_NEAR(m.points[0].strength, 55e6, 1);
  EXPECT_NEAR(m.points[1].youngs, 183e9, 0.05e9);
  EXPECT_NEAR(m.points[1].poisson, 0.321, 5e-4);
  EXPECT_NEAR(m.points[1].strength, 88.42e6, 5e3);
}

TEST_F(MeasuredTable, Mistakes) {
  refuses("density,youngs_modulus_GPa\n0.8,70\n", "line 1: no column relative_density");
  refuses("relative_density,youngs_modulus_GPa\n", "no measurement in it");
  refuses("relative_density,youngs_modulus_GPa\n0.8\n", "line 2: 1 fields");
  refuses("relative_density,youngs_modulus_GPa\n1.2,70\n", "line 2: relative_density must be above 0");
  refuses("relative_density,youngs_modulus_GPa\n,70\n", "line 2: no relative_density");
  refuses("relative_density,youngs_modulus_GPa\n0.8,much\n", "youngs_modulus_GPa \"much\" is not a number");
  refuses("relative_density,youngs_modulus_GPa\n0.8,-70\n", "youngs_modulus_GPa must be above 0");
  refuses("relative_density,poissons_ratio\n0.8,0.7\n", "poissons_ratio must be above -1");
  refuses("relative_density,E_GPa\n0.8,70\n", "no modulus and no strength");
  refuses(
      "relative_density,density_kg_per_m3,longitudinal_speed_m_per_s,transverse_speed_m_per_s\n0.8,5000,3000,2900\n",
      "slower than 0.866");
}

}  // namespace
}  // namespace densify::app
