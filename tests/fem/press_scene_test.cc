// Scenes that press a specimen: what they mean, and one test a mistake.

#include "coupling/press_scene.h"

#include <gtest/gtest.h>

#include "base/check.h"

namespace densify::coupling {
namespace {

const char* const good = R"(
[press]
diameter = "13 mm"
height = "8 mm"
relative_density = 0.668
[press.die]
friction = 0.1
[press.material]
viscosity = "2.7e10 Pa s"
youngs_modulus = "188 GPa"
poissons_ratio = 0.31
[process]
start_temperature = "20 degC"
[[process.stage]]
name = "loading"
duration = "33 min"
pressure = "30 MPa"
)";

std::string mistake(const std::vector<std::string>& overrides, const std::string& text = good) {
  try {
    read_press_scene_text(text, overrides);
  } catch (const InputError& error) {
    return error.what();
  }
  return "none";
}

void expect_says(const std::string& message, std::initializer_list<const char*> parts) {
  for (const char* part : parts) EXPECT_NE(message.find(part), std::string::npos) << message << "\nlacks " << part;
}

TEST(PressScene, IsInSiUnits) {
  const PressScene s = read_press_scene_text(good, {});
  EXPECT_DOUBLE_EQ(s.size.radius, 6.5e-3);
  EXPECT_DOUBLE_EQ(s.press.die_radius, 6.5e-3);
  EXPECT_DOUBLE_EQ(s.size.height, 8e-3);
  EXPECT_DOUBLE_EQ(s.material.viscosity, 2.7e10);
  EXPECT_DOUBLE_EQ(s.schedule->end(), 1980);
  EXPECT_TRUE(s.warnings.empty());
}

// What is written back is the same scene.
TEST(PressScene, EffectiveTextReadsBack) {
  const PressScene s = read_press_scene_text(good, {});
  EXPECT_EQ(read_press_scene_text(s.effective_text, {}).effective_text, s.effective_text);
}

// The shipped one can be read.
TEST(PressScene, OfTheExample) {
  EXPECT_NEAR(read_press_scene(DENSIFY_EXAMPLES "/press_nial", {}).schedule->end(), 330 * 60, 1e-9);
}

TEST(PressScene, Mistakes) {
  expect_says(mistake({"press.die.friction=-0.1"}), {"press.die.friction", ">= 0"});
  expect_says(mistake({"press.material.poissons_ratio=0.5"}), {"press.material.poissons_ratio", "< 0.5"});
  expect_says(mistake({"press.relative_density=1"}), {"press.relative_density", "< 1"});
  expect_says(mistake({"press.height=8 MPa"}), {"press.height", "length"});
  expect_says(mistake({"press.diametre=13 mm"}), {"press.diametre", "diameter"});
  expect_says(mistake({"press.material.surface_energy=1 J/m^2"}), {"particle_radius", "3 gamma/r"});
  expect_says(mistake({"press.geometry=cube"}), {"press.geometry", "axisymmetric"});
  std::string text = good;
  text.replace(text.find("height ="), 8, "heigth =");
  expect_says(mistake({}, text), {"height", "heigth"});
}

// Stages are driven by the last that was given of pressure and punch_travel; action = "double" moves both punches.
TEST(PressScene, PunchesByTravel) {
  const std::string more = R"(
[[process.stage]]
name = "closing"
duration = "10 min"
punch_travel = "2 mm"
[[process.stage]]
name = "hold"
duration = "10 min"
[[process.stage]]
name = "unloading"
duration = "10 min"
pressure = "0 MPa"
)";
  const PressScene s = read_press_scene_text(good + more, {"press.action=double", "press.die.ejection_time=60 s"});
  EXPECT_EQ(s.settings.punches, fem::Punches::both);
  ASSERT_EQ(s.press.travel.size(), 4u);
  EXPECT_TRUE(std::isnan(s.press.travel[0]));
  EXPECT_DOUBLE_EQ(s.press.travel[1], 2e-3);
  EXPECT_DOUBLE_EQ(s.press.travel[2], 2e-3);
  EXPECT_TRUE(std::isnan(s.press.travel[3]));
  EXPECT_EQ(read_press_scene_text(s.effective_text, {}).effective_text, s.effective_text);
}

TEST(PressScene, MistakesOfPunches) {
  const std::string travels =
      std::string(good).substr(0, std::string(good).find("pressure =")) + "punch_travel = \"2 mm\"\n";
  expect_says(mistake({"press.action=both"}), {"press.action", "single", "double"});
  expect_says(mistake({}, good + std::string("punch_travel = \"2 mm\"\n")),
              {"scene.toml:18", "punch_travel", "and pressure both drive", "remove one"});
  std::string deep = travels;
  deep.replace(deep.find("2 mm"), 4, "3 mm");
  expect_says(mistake({}, deep), {"scene.toml:17", "punch_travel", "5.344 mm", "8 mm"});
  expect_says(mistake({"process.start_pressure=1 MPa"}, travels), {"process.start_pressure", "punch_travel", "remove"});
  expect_says(mistake({"press.die.ejection_time=60 s"}, travels), {"press.die.ejection_time", "0 MPa"});
  expect_says(mistake({"press.die.ejection_time=60 s"}), {"press.die.ejection_time", "no punch pressure"});
}

// A volume element stands in the same scene, in its own table, and follows the process of the specimen.
const char* const element = R"(
[rve.materials.NiAl]
library = "NiAl"
[[rve.powder]]
material = "NiAl"
number = 100
sizes = "lognormal"
mean = "3.97 um"
standard_deviation = "2.50 um"
minimum = "1.50 um"
maximum = "18.61 um"
[rve.specimen]
shape = "periodic"
[rve.contact]
elasticity = "hertz"
)";

TEST(PressScene, HoldsAVolumeElement) {
  const PressScene s = read_press_scene_text(good + std::string(element), {});
  ASSERT_TRUE(s.element);
  EXPECT_EQ(s.element->powder->components.size(), 1u);
  EXPECT_DOUBLE_EQ(s.element->schedule.end(), 1980);
  EXPECT_EQ(read_press_scene_text(s.effective_text, {}).effective_text, s.effective_text);
}

TEST(PressScene, MistakesOfACoupling) {
  expect_says(mistake({"press.coupling=live"}), {"press.relative_density", "remove"});
  expect_says(mistake({"press.coupling=live", "press.relative_density="}), {"rve", "missing"});
  expect_says(mistake({"press.coupling=table"}), {"press.table", "missing"});
  expect_says(mistake({"press.coupling=table", "press.relative_density="}),
              {"press", "relative_density is missing", "start_pressure"});
  const std::string both = good + std::string(element);
  expect_says(mistake({"rve.specimen.shape=free"}, both), {"rve.specimen"});
  expect_says(mistake({"press.coupling=live", "press.relative_density="}, both), {"start_pressure", "above 0"});
  expect_says(mistake({"rve.contact.elastisity=hertz"}, both), {"rve.contact.elastisity", "elasticity"});
}

TEST(PressScene, LiveElementsHaveTheirDensity) {
  const PressScene s = read_press_scene(DENSIFY_EXAMPLES "/press_nial_live", {});
  EXPECT_EQ(s.coupling, Coupling::live);
  EXPECT_TRUE(std::isnan(s.density));
  EXPECT_EQ(s.control.error_share, 2.0 / 9);  // BDF2
  EXPECT_EQ(read_press_scene_text(s.effective_text, {}).effective_text, s.effective_text);
}

TEST(PressScene, AFrictionAboveOneIsWarnedOf) {
  const PressScene s = read_press_scene_text(good, {"press.die.friction=1.2"});
  ASSERT_EQ(s.warnings.size(), 1u);
  EXPECT_NE(s.warnings[0].find("press.die.friction"), std::string::npos);
}

}  // namespace
}  // namespace densify::coupling
