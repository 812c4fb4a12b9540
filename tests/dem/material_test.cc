#include "dem/material/material.h"

#include <gtest/gtest.h>

#include "base/check.h"
#include "dem/contact/force_pass.h"
#include "tests/support/setups.h"

namespace densify::dem {
namespace {

using test::copper;

double celsius(double t) {
  return t + 273.15;
}

// The SI of 2019 fixes both constants exactly; R = k_B N_A with N_A = 6.02214076e23.
TEST(Material, ConstantsOfNature) {
  EXPECT_EQ(boltzmann_constant, 1.380649e-23);
  EXPECT_NEAR(gas_constant, 1.380649e-23 * 6.02214076e23, 1e-14);
}

struct Diffusivity {
  const char* name;
  GrainBoundaryDiffusion diffusion;
  double at_1300, at_1350, at_1400;  // [m^5/(N s)]
};

// (4.81) with (4.83) and the parameters of Tables 5.4 and 5.7 at 1300, 1350 and 1400 degC; the expected values were
// computed apart from this code to the digits given, so the tolerance is half their last digit.
TEST(Material, EffectiveDiffusionOfTables5_4And5_7) {
  const Diffusivity rows[] = {{"NiAl", {1.20e-29, 2.55e-5, 185e3, 0.5e-9}, 5.073e-30, 7.601e-30, 1.1107e-29},
                              {"Al2O3", {8.47e-30, 9.751, 389e3, 0.5e-9}, 2.307e-31, 5.588e-31, 1.283e-30},
                              {"NiAl-Al2O3", {9.01e-30, 3e-2, 280e3, 0.5e-9}, 3.141e-30, 5.887e-30, 1.062e-29}};
  for (const auto& row : rows) {
    EXPECT_NEAR(row.diffusion.effective(celsius(1300)) / row.at_1300, 1, 2.5e-4) << row.name;
    EXPECT_NEAR(row.diffusion.effective(celsius(1350)) / row.at_1350, 1, 2.5e-4) << row.name;
    EXPECT_NEAR(row.diffusion.effective(celsius(1400)) / row.at_1400, 1, 5e-4) << row.name;
  }
}

// Copper at 1300 K, Table 5.1: D_eff = 3.832e-19 x 1.18e-29 / (1.380649e-23 x 1300) = 2.51930572e-28 m^5/(N s).
TEST(Material, EffectiveDiffusionOfCopper) {
  EXPECT_NEAR(copper().diffusion.effective(1300) / 2.51930572e-28, 1, 2e-9);
}

// Two copper spheres of 22.5 um (5.1): a_max (4.32), eta(a_max) (4.40), F_sint at a = 0 and a_max (4.36), all to the
// nine digits given.
TEST(Material, NeckOfCopper) {
  ContactModel model = test::elastic_model(Elasticity::linear, 7e5);
  model.sintering = SinteringSettings{};
  PairTable table({copper()}, {}, model);
  table.update(1300, 0);
  const auto law = make_sintering<LinearSpring>(model, table.row(0, 0));
  const double r = 22.5e-6;
  NormalInput in{};
  in.sintering_radius = r;
  const double a_max = law.largest_neck(in);
  EXPECT_NEAR(a_max / 2.1516857e-5, 1, 3e-8);
  EXPECT_NEAR(law.viscosity(a_max) / 3.341137e8, 1, 2e-7);
  EXPECT_NEAR(law.sintering_force(0.0, r) / 3.44132761e-4, 1, 2e-9);
  EXPECT_NEAR(law.sintering_force(a_max, r) / 4.55319622e-4, 1, 2e-9);
}

// Viscosity of a neck of 1 um at 1400 degC for the three kinds of contact: 3.536e4, 3.061e5, 3.699e4 N s/m.
TEST(Material, ViscosityAtOneMicrometre) {
  const GrainBoundaryDiffusion d[] = {
      {1.20e-29, 2.55e-5, 185e3, 0.5e-9}, {8.47e-30, 9.751, 389e3, 0.5e-9}, {9.01e-30, 3e-2, 280e3, 0.5e-9}};
  const double eta[] = {3.536e4, 3.061e5, 3.699e4};
  for (int m = 0; m < 3; ++m) EXPECT_NEAR(M_PI * 1e-24 / (8 * d[m].effective(celsius(1400))) / eta[m], 1, 2e-4);
}

// (4.20) of NiAl (183 GPa, 0.34) with Al2O3 (404 GPa, 0.232): 1/E* = 0.8844/183 + 0.946176/404 per GPa, E* = 139.4 GPa;
// Table 5.7 prints twice that.
TEST(Material, EffectiveModulusOfUnlikePair) {
  EXPECT_NEAR(effective_modulus(183e9, 0.34, 404e9, 0.232), 139.4e9, 0.05e9);
}

// A sphere of copper of 22.5 um weighs 8920 x 4/3 pi r^3 = 4.2559941e-10 kg, and a mass factor does not change that.
TEST(Material, MassOfASphere) {
  auto s = test::empty_setup(copper(), test::elastic_model(Elasticity::linear, 7e5), test::hold(1, 1300, 0));
  test::add_sphere(s.particles, Vec3::Zero(), 22.5e-6, Vec3::Zero());
  s.integration.mass_scaling = 1e14;
  const Simulation sim(s);
  EXPECT_NEAR(sim.real_mass(0) / 4.2559941e-10, 1, 2e-8);
  EXPECT_NEAR(1 / sim.state().particles.body[0].inverse_mass / 4.2559941e4, 1, 2e-8);
}

// Unlike pairs take nothing from the two materials but the modulus and the later activation: the rest must be given.
TEST(Material, InterfaceOfUnlikePair) {
  Material a = copper(), b = copper();
  a.activation_temperature = 700;
  b.activation_temperature = 900;
  const Interface derived = complete_interface({a, b}, 1, 0, {});
  EXPECT_EQ(derived.a, 0);
  EXPECT_EQ(derived.b, 1);
  EXPECT_EQ(derived.activation_temperature, 900);
  EXPECT_FALSE(derived.diffusion.complete());
  EXPECT_TRUE(std::isnan(derived.surface_energy));
  EXPECT_TRUE(complete_interface({a, b}, 1, 1, {}).diffusion.complete());
}

// Each property that sintering needs is asked for by name when it is missing.
TEST(Material, MissingPropertyIsNamed) {
  ContactModel model = test::elastic_model(Elasticity::linear, 7e5);
  model.sintering = SinteringSettings{};
  auto complaint = [&](auto&& spoil) {
    Material m = copper();
    spoil(m);
    try {
      PairTable({m}, {}, model);
    } catch (const InputError& e) {
      return std::string(e.what());
    }
    return std::string();
  };
  EXPECT_NE(complaint([](Material& m) { m.surface_energy = unset; }).find("surface_energy"), std::string::npos);
  EXPECT_NE(complaint([](Material& m) { m.dihedral_angle = unset; }).find("dihedral_angle"), std::string::npos);
  EXPECT_NE(complaint([](Material& m) { m.activation_temperature = unset; }).find("activation_temperature"),
            std::string::npos);
  EXPECT_NE(complaint([](Material& m) { m.diffusion.prefactor = unset; }).find("diffusion"), std::string::npos);
  EXPECT_EQ(complaint([](Material&) {}), "");
}

// Activation starts its clock when the temperature first reaches it, and anew after it was below.
TEST(PairTable, ActivationClock) {
  ContactModel model = test::elastic_model(Elasticity::linear, 7e5);
  model.sintering = SinteringSettings{};
  Material m = copper();
  m.activation_temperature = 700;
  PairTable table({m}, {}, model);
  table.update(699, 1);
  EXPECT_FALSE(table.any_active());
  table.update(700, 2);
  EXPECT_TRUE(table.row(0, 0).active && table.row(0, 0).activation_step);
  table.update(710, 3);
  EXPECT_TRUE(table.row(0, 0).active && !table.row(0, 0).activation_step);
  EXPECT_EQ(table.active_since()[0], 2);
  table.update(600, 4);
  EXPECT_FALSE(table.row(0, 0).active);
  table.update(800, 5);
  EXPECT_TRUE(table.row(0, 0).activation_step);
  EXPECT_EQ(table.active_since()[0], 5);
}

}  // namespace
}  // namespace densify::dem
