// Mistakes in contact model, walls and interfaces.

#include <gtest/gtest.h>

#include "tests/input/scene_mistake.h"

using namespace densify::test;

namespace {

// Two materials that sinter, each alone and both together.
constexpr std::string_view kComposite = R"toml([materials.NiAl]
library = "NiAl"
[materials.Al2O3]
library = "Al2O3"
[[interface]]
between = ["NiAl", "Al2O3"]
atomic_volume = "9.01e-30 m^3"
diffusion_prefactor = "3e-2 m^2/s"
activation_enthalpy = "280 kJ/mol"
grain_boundary_width = "0.5 nm"
surface_energy = "0 J/m^2"
dihedral_angle = "147 deg"
[[powder]]
material = "NiAl"
number = 100
sizes = "list"
diameters = ["4 um"]
[[powder]]
material = "Al2O3"
volume_fraction = 0.2
sizes = "list"
diameters = ["2 um"]
[specimen]
shape = "periodic"
[contact.sintering]
[process]
[[process.stage]]
name = "heating"
rate = "15 K/min"
temperature = "1400 degC"
)toml";

std::string composite_mistake(std::string_view from, std::string_view to) {
  std::string text(kComposite);
  return message_of(text.replace(text.find(from), from.size(), to));
}

}  // namespace

TEST(SceneMistakes, NoMistakeInTheComposite) {
  EXPECT_EQ(message_of(kComposite), "accepted");
}

TEST(SceneMistakes, LinearElasticityWithoutStiffness) {
  EXPECT_EQ(mistake("elasticity = \"hertz\"", "elasticity = \"linear\""),
            "scene.toml:20: contact.normal_stiffness: missing, and required (k_n of linear elasticity (4.15)); write "
            "normal_stiffness = \"7e5 N/m\"");
}

TEST(SceneMistakes, NegativeStiffness) {
  EXPECT_EQ(mistake("elasticity = \"hertz\"", "elasticity = \"linear\"\nnormal_stiffness = \"-7e5 N/m\""),
            "scene.toml:22: contact.normal_stiffness: must be > 0 N/m, found \"-7e5 N/m\"");
}

TEST(SceneMistakes, KeyOfTheOtherElasticity) {
  EXPECT_EQ(mistake("elasticity = \"hertz\"", "normal_stiffness = \"7e5 N/m\""),
            "scene.toml:21: contact.normal_stiffness: belongs to elasticity = \"linear\"; remove it, or set "
            "elasticity");
  EXPECT_EQ(mistake("elasticity = \"hertz\"",
                    "elasticity = \"linear\"\nnormal_stiffness = \"7e5 N/m\"\nhertz_radius = \"reduced\""),
            "scene.toml:23: contact.hertz_radius: belongs to elasticity = \"hertz\"; remove it");
}

TEST(SceneMistakes, FrictionWithoutOrWithNegativeCoefficient) {
  EXPECT_EQ(mistake("coefficient = 0.2", ""),
            "scene.toml:22: contact.friction.coefficient: missing, and required (mu between particles (4.27)); write "
            "coefficient = 0.3");
  EXPECT_EQ(mistake("coefficient = 0.2", "coefficient = -0.2"),
            "scene.toml:23: contact.friction.coefficient: must be >= 0, found -0.2");
}

// Missing comes first and unknown later, so the message of the one names the other; a known neighbour is no
// misspelling.
TEST(SceneMistakes, MisspeltRequiredKey) {
  EXPECT_EQ(mistake("coefficient = 0.2", "coeficient = 0.2"),
            "scene.toml:22: contact.friction.coefficient: missing, and required (mu between particles (4.27)); write "
            "coefficient = 0.3; \"coeficient\" in line 23 is no key: did you mean \"coefficient\"?");
  EXPECT_EQ(
      mistake("duration = \"33 min\"", "durration = \"33 min\""),
      "scene.toml:28: process.stage.1: stage \"loading\" needs exactly one of duration, end and rate, found none; "
      "\"durration\" in line 30 is no key: did you mean \"duration\"?");
  EXPECT_EQ(mistake("maximum = \"18.61 um\"", "").find("is no key"), std::string::npos);
  EXPECT_EQ(mistake("maximum = \"18.61 um\"", "").find("scene.toml:3: powder.1.maximum: missing"), 0u);
}

TEST(SceneMistakes, UnknownModel) {
  EXPECT_EQ(mistake("\"viscoelastic\"", "\"viscelastic\""),
            "scene.toml:25: contact.sintering.model: \"viscelastic\" is not among \"viscoelastic\", \"viscous\"; did "
            "you mean \"viscoelastic\"?");
}

// sin(147 deg / 2) = 0.959 is the neck at equilibrium over the radius (4.32).
TEST(SceneMistakes, NeckThatStartsBeyondItsEquilibrium) {
  EXPECT_EQ(mistake("model = \"viscoelastic\"", "starting_neck = 0.96"),
            "scene.toml:24: contact.sintering: starting_neck is not below sin(Psi/2) of \"NiAl\", the neck at "
            "equilibrium over the radius (4.32); lower it");
  EXPECT_EQ(mistake("model = \"viscoelastic\"", "starting_neck = 0.95"), "accepted");
}

TEST(SceneMistakes, PoreClosure) {
  const auto with = [](const char* key) {
    return mistake("model = \"viscoelastic\"",
                   std::string("model = \"viscoelastic\"\n[contact.sintering.pore_closure]\n") + key);
  };
  EXPECT_EQ(with("porosity = 0.05"), "accepted");
  EXPECT_EQ(with(""), "accepted");
  EXPECT_EQ(with("porosity = 0"),
            "scene.toml:27: contact.sintering.pore_closure.porosity: must be > 0 and < 1, found 0");
  EXPECT_EQ(with("porosity = 1"),
            "scene.toml:27: contact.sintering.pore_closure.porosity: must be > 0 and < 1, found 1");
  EXPECT_EQ(with("porosity = \"5 um\""),
            "scene.toml:27: contact.sintering.pore_closure.porosity: \"5 um\": expected plain number such as 0.3, got "
            "length");
  EXPECT_EQ(with("density = 0.9"),
            "scene.toml:27: contact.sintering.pore_closure.density: unknown key; known here: porosity");
}

TEST(SceneMistakes, CalibrationOfNoKnownKind) {
  EXPECT_EQ(
      mistake("library = \"NiAl\"", "library = \"NiAl\"\ncalibrated_on = \"die\""),
      "scene.toml:3: materials.NiAl.calibrated_on: \"die\" is not among \"cylinder\", \"box\", \"periodic\", \"free\"");
  EXPECT_EQ(mistake("library = \"NiAl\"", "library = \"Cu\"\ncalibrated_size = \"58 um\""),
            "scene.toml:3: materials.NiAl.calibrated_size: is the size of a specimen of no shape; give calibrated_on");
  EXPECT_EQ(mistake("library = \"NiAl\"", "library = \"NiAl\"\ncalibrated_size = \"0 um\""),
            "scene.toml:3: materials.NiAl.calibrated_size: must be > 0 m, found \"0 um\"");
}

TEST(SceneMistakes, WallsHalfGiven) {
  EXPECT_EQ(mistake("thermal_expansion = \"11.5e-6 1/K\"", "youngs_modulus = \"400 GPa\""),
            "scene.toml:16: walls.poissons_ratio: missing; give both youngs_modulus and poissons_ratio of the walls, "
            "or neither");
}

TEST(SceneMistakes, WallModulusWithLinearElasticity) {
  const std::string walls = "thermal_expansion = \"11.5e-6 1/K\"";
  const std::string linear =
      changed("elasticity = \"hertz\"", "elasticity = \"linear\"\nnormal_stiffness = \"7e5 N/m\"");
  const std::string text = std::string(linear).replace(linear.find(walls), walls.size(),
                                                       "youngs_modulus = \"400 GPa\"\npoissons_ratio = 0.2");
  EXPECT_EQ(message_of(text),
            "scene.toml:17: walls.youngs_modulus: has no meaning with linear elasticity, whose stiffness is "
            "normal_stiffness; remove it with poissons_ratio");
}

TEST(SceneMistakes, UnlikeMaterialsWithoutAnInterface) {
  const std::size_t begin = kComposite.find("[[interface]]"), end = kComposite.find("[[powder]]");
  EXPECT_EQ(composite_mistake(kComposite.substr(begin, end - begin), ""),
            "scene.toml:3: materials.Al2O3: the contacts of \"Al2O3\" and \"NiAl\" lack atomic_volume, "
            "diffusion_prefactor, activation_enthalpy, grain_boundary_width, surface_energy, dihedral_angle; set it in "
            "an [[interface]] between them");
}

TEST(SceneMistakes, InterfaceWithoutAProperty) {
  EXPECT_EQ(composite_mistake("surface_energy = \"0 J/m^2\"\n", ""),
            "scene.toml:5: interface.1: the contacts of \"Al2O3\" and \"NiAl\" lack surface_energy; set it in this "
            "[[interface]] between them");
}

TEST(SceneMistakes, InterfaceOfUnknownMaterials) {
  EXPECT_EQ(composite_mistake("[\"NiAl\", \"Al2O3\"]", "[\"NiAl\", \"Al203\"]"),
            "scene.toml:6: interface.1.between: \"Al203\" is not among the materials \"Al2O3\", \"NiAl\"; did you mean "
            "\"Al2O3\"?");
  EXPECT_EQ(composite_mistake("[\"NiAl\", \"Al2O3\"]", "[\"NiAl\"]"),
            "scene.toml:6: interface.1.between: expected two materials, found 1");
}

TEST(SceneMistakes, InterfaceGivenTwice) {
  EXPECT_EQ(composite_mistake("[[powder]]\n", "[[interface]]\nbetween = [\"Al2O3\", \"NiAl\"]\n[[powder]]\n"),
            "scene.toml:14: interface.2.between: these two already have an interface at scene.toml:6: "
            "interface.1.between; merge the two sections");
}
