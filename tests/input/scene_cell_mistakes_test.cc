// Mistakes in what drives a periodic cell.

#include <gtest/gtest.h>

#include "tests/input/scene_mistake.h"
#include "tests/support/periodic_scene.h"

using namespace densify::test;

namespace {

/// kGood in a periodic cell whose first stage, from line 26 on has `keys`.
std::string periodic(std::string_view keys, std::string_view after = "") {
  std::string text(kPeriodicPowder);
  text += R"toml([contact.sintering]
model = "viscoelastic"
[process]
start_temperature = "1400 degC"
[[process.stage]]
name = "pressing"
duration = "1 h"
)toml";
  return text.append(keys).append("\n[integration]\nmass_scaling = 1e17\n").append(after);
}

}  // namespace

TEST(CellMistakes, NoneInWhatACellIsDrivenBy) {
  EXPECT_EQ(message_of(periodic("pressure = \"30 MPa\"")), "accepted");
  EXPECT_EQ(message_of(periodic("stress = { zz = \"-30 MPa\" }")), "accepted");
  EXPECT_EQ(message_of(periodic("stress = { zz = \"-30 MPa\", xy = \"1 MPa\" }\nstrain_rate = { xx = \"1e-5 1/s\" }")),
            "accepted");
}

TEST(CellMistakes, EnergiesOfACellThatNothingDrives) {
  EXPECT_EQ(message_of(periodic("pressure = \"30 MPa\"", "[output]\nenergies = true")), "accepted");
  EXPECT_EQ(message_of(periodic("", "[output]\nenergies = true")),
            "scene.toml:21: output.energies: adds up the work on a periodic cell that the stages drive, and none is; "
            "remove it, or give a stage pressure, stress or strain_rate");
  EXPECT_EQ(message_of(periodic("pressure = \"30 MPa\"", "[output]\nenergies = 1")),
            "scene.toml:21: output.energies: expected true or false (without quotes), found 1");
}

TEST(CellMistakes, ComponentDrivenTwice) {
  EXPECT_EQ(message_of(periodic("stress = { zz = \"-30 MPa\" }\nstrain_rate = { zz = \"0 1/s\" }")),
            "scene.toml:18: process.stage.1.strain_rate: and stress both drive zz; remove it from one of them");
  EXPECT_EQ(message_of(periodic("pressure = \"30 MPa\"\nstress = { zz = \"-30 MPa\" }")),
            "scene.toml:17: process.stage.1.pressure: drives all six components, and stress drives zz too; remove one "
            "of them, or give stress.xx, yy and zz instead");
}

TEST(CellMistakes, NoComponent) {
  EXPECT_EQ(
      message_of(periodic("stress = {}")),
      "scene.toml:17: process.stage.1.stress: gives no component; give at least one of xx, yy, zz, xy, xz, yz, or "
      "remove stress");
}

TEST(CellMistakes, StressWithoutACell) {
  EXPECT_EQ(mistake("pressure = \"30 MPa\"", "stress = { zz = \"-30 MPa\" }"),
            "scene.toml:31: process.stage.1.stress: drives a periodic cell, which this specimen is not; use shape = "
            "\"periodic\", or remove it");
}

TEST(CellMistakes, RateWithTheUnitOfAStress) {
  const std::string message = message_of(periodic("strain_rate = { xx = \"1 MPa\" }"));
  EXPECT_NE(message.find("scene.toml:17: process.stage.1.strain_rate.xx:"), message.npos) << message;
}

TEST(CellMistakes, UnknownComponent) {
  const std::string message = message_of(periodic("stress = { zx = \"1 MPa\", xx = \"0 Pa\" }"));
  EXPECT_NE(message.find("process.stage.1.stress.zx"), message.npos) << message;
}

TEST(CellMistakes, VelocityGradientBesideStages) {
  EXPECT_EQ(
      message_of(periodic("pressure = \"30 MPa\"",
                          "[specimen.cell.velocity_gradient]\nx = [\"1 1/s\", \"0 1/s\", \"0 1/s\"]\n")),
      "scene.toml:20: specimen.cell.velocity_gradient: moves the cell through the whole process, which the stages "
      "drive by pressure, stress or strain_rate; remove one of them");
}

TEST(CellMistakes, LoadInADrivenCell) {
  EXPECT_EQ(
      message_of(periodic("pressure = \"30 MPa\"", "[[load]]\nparticle = 0\nforce = [\"1 N\", \"0 N\", \"0 N\"]\n")),
      "scene.toml:14: process.stage: the stages drive the cell, and no stress of a periodic cell balances the "
      "forces of a [[load]]; remove them");
}

TEST(CellMistakes, WithoutInertia) {
  EXPECT_EQ(message_of(periodic("pressure = \"30 MPa\"", "method = \"inertia_free\"\n")), "accepted");
  EXPECT_EQ(
      message_of(
          periodic("pressure = \"30 MPa\"", "method = \"inertia_free\"\n[contact.friction]\ncoefficient = 0.2\n")),
      "scene.toml:20: integration.method: \"inertia_free\" has no rotations, which [contact.friction] needs; remove "
      "it, or use method = \"explicit\"");
}

TEST(CellMistakes, ThesisRuleUnderStress) {
  EXPECT_EQ(message_of(periodic("pressure = \"30 MPa\"", "rule = \"thesis\"\n")),
            "scene.toml:20: integration.rule: \"thesis\" looks at one contact at a time and leaves no room for a cell "
            "that a stress drives; use rule = \"particle_sum\"");
}
