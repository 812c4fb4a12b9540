// Mistakes in materials, powder and specimen: each message names line, key, what is wrong and what is allowed.

#include <gtest/gtest.h>

#include "tests/input/scene_mistake.h"

using namespace densify::test;

namespace {

const std::string kLibrary = "library = \"NiAl\"";

/// kGood with one more key in line 3, below the library.
std::string material_mistake(const std::string& line) {
  return mistake(kLibrary, kLibrary + "\n" + line);
}

// 20 imported particles in a periodic cell.
constexpr std::string_view kImport = R"toml([materials.NiAl]
library = "NiAl"
[specimen]
shape = "periodic"
[specimen.import]
file = "particles.csv"
[specimen.cell]
a = ["9 um", "0 um", "0 um"]
b = ["0 um", "9 um", "0 um"]
c = ["0 um", "0 um", "9 um"]
[process]
[[process.stage]]
name = "rest"
duration = "1 s"
)toml";

std::string import_mistake(std::string_view from, std::string_view to) {
  std::string text(kImport);
  return message_of(text.replace(text.find(from), from.size(), to));
}

}  // namespace

// Without this every other test here could pass for a wrong reason.
TEST(SceneMistakes, NoMistake) {
  EXPECT_EQ(message_of(kGood), "accepted");
  EXPECT_EQ(message_of(kImport), "accepted");
}

TEST(SceneMistakes, UnknownKey) {
  EXPECT_EQ(material_mistake("youngs_modulos = \"3 GPa\""),
            "scene.toml:3: materials.NiAl.youngs_modulos: unknown key; did you mean \"youngs_modulus\"?");
  EXPECT_EQ(mistake("[[powder]]", "[[powdr]]"), "scene.toml:3: powdr: unknown key; did you mean \"powder\"?");
}

TEST(SceneMistakes, WrongUnit) {
  EXPECT_EQ(material_mistake("density = \"5910 kg\""),
            "scene.toml:3: materials.NiAl.density: \"5910 kg\": expected density such as \"5910 kg/m^3\", got mass");
}

TEST(SceneMistakes, MissingUnit) {
  EXPECT_EQ(material_mistake("density = \"5910\""),
            "scene.toml:3: materials.NiAl.density: \"5910\": unit missing; a density is due, such as \"5910 kg/m^3\"");
  EXPECT_EQ(material_mistake("density = 5910"),
            "scene.toml:3: materials.NiAl.density: a bare number where a density is due; write \"5910 kg/m^3\"");
}

TEST(SceneMistakes, PoissonsRatioOfTwo) {
  EXPECT_EQ(material_mistake("poissons_ratio = 2.0"),
            "scene.toml:3: materials.NiAl.poissons_ratio: must be > -1 and < 0.5, found 2");
}

TEST(SceneMistakes, NegativeModulus) {
  EXPECT_EQ(material_mistake("youngs_modulus = \"-3 GPa\""),
            "scene.toml:3: materials.NiAl.youngs_modulus: must be > 0 Pa, found \"-3 GPa\"");
}

TEST(SceneMistakes, MaterialThatIsNotShipped) {
  EXPECT_EQ(mistake(kLibrary, "library = \"NiA\""),
            "scene.toml:2: materials.NiAl.library: \"NiA\" is not among the shipped \"Al2O3\", \"Cu\", \"NiAl\"; did "
            "you mean \"NiAl\"?");
}

TEST(SceneMistakes, MaterialWithoutItsProperties) {
  EXPECT_EQ(mistake(kLibrary, "density = \"5910 kg/m^3\""),
            "scene.toml:1: materials.NiAl: lacks youngs_modulus, poissons_ratio, atomic_volume, diffusion_prefactor, "
            "activation_enthalpy, grain_boundary_width, surface_energy, dihedral_angle, activation_temperature, which "
            "this contact model needs; set it here, or start from a shipped material (Al2O3, Cu, NiAl) with the key "
            "library");
}

TEST(SceneMistakes, MaterialWithoutPowder) {
  EXPECT_EQ(mistake("[[powder]]\n", "[materials.Cu]\nlibrary = \"Cu\"\n[[powder]]\n"),
            "scene.toml:3: materials.Cu: no [[powder]] is of this material; remove it, or add one");
}

TEST(SceneMistakes, UnknownMaterial) {
  EXPECT_EQ(mistake("material = \"NiAl\"", "material = \"NiA\""),
            "scene.toml:4: powder.1.material: \"NiA\" is not among the materials \"NiAl\"; did you mean \"NiAl\"?");
}

TEST(SceneMistakes, EmptyPowder) {
  EXPECT_EQ(mistake("number = 100", "number = 0"),
            "scene.toml:5: powder.1.number: must be >= 1 and <= 1000000000, found 0");
  EXPECT_EQ(message_of(kGood, {"powder.1.number=0"}),
            "--set powder.1.number=0: must be >= 1 and <= 1000000000, found 0");
}

TEST(SceneMistakes, AmountNotGivenOrGivenTwice) {
  const std::string problem =
      "scene.toml:3: powder.1: needs exactly one of number, solid_volume, volume_fraction, found ";
  EXPECT_EQ(mistake("number = 100", ""), problem + "none");
  EXPECT_EQ(mistake("number = 100", "number = 100\nsolid_volume = \"1 mm^3\""), problem + "number and solid_volume");
}

TEST(SceneMistakes, FractionsThatDoNotFit) {
  EXPECT_EQ(mistake("number = 100", "volume_fraction = 0.5"),
            "scene.toml:3: powder: volume fractions alone do not say how much powder there is; add [powder_total] with "
            "a number or a solid_volume, or give one component a number");
  EXPECT_EQ(mistake_added("[powder_total]\nnumber = 500\n"),
            "scene.toml:3: powder.1: gives an amount of its own besides [powder_total]; give its volume_fraction "
            "instead");
  EXPECT_EQ(message_of(changed("number = 100", "volume_fraction = 0.5").append("[powder_total]\nnumber = 500\n")),
            "scene.toml:38: powder_total: the volume fractions of the powder sum to 0.5 and must sum to 1");
}

TEST(SceneMistakes, NegativeDiameter) {
  EXPECT_EQ(mistake("mean = \"3.97 um\"", "mean = \"-3.97 um\""),
            "scene.toml:7: powder.1.mean: must be > 0 m, found \"-3.97 um\"");
}

TEST(SceneMistakes, SizesThatContradictThemselves) {
  EXPECT_EQ(mistake("mean = \"3.97 um\"", "mean = \"1.0 um\""),
            "scene.toml:6: powder.1.sizes: a truncated lognormal needs 0 < minimum < mean < maximum; they are 1.5e-06, "
            "1e-06 and 1.861e-05 m");
}

TEST(SceneMistakes, KeyOfOtherSizes) {
  EXPECT_EQ(mistake("number = 100", "number = 100\ndiameters = [\"3 um\"]"),
            "scene.toml:6: powder.1.diameters: belongs to sizes = \"list\"; remove it");
}

TEST(SceneMistakes, UnknownShape) {
  EXPECT_EQ(mistake("\"cylinder\"", "\"cylindre\""),
            "scene.toml:12: specimen.shape: \"cylindre\" is not among \"cylinder\", \"box\", \"periodic\", \"free\"; "
            "did you mean \"cylinder\"?");
}

TEST(SceneMistakes, PowderInNoContainer) {
  EXPECT_EQ(mistake("shape = \"cylinder\"\ndiameter = \"58 um\"", "shape = \"free\"\n").substr(0, 47),
            "scene.toml:16: walls: a free or periodic specim");
  EXPECT_EQ(message_of(R"toml([materials.NiAl]
library = "NiAl"
[[powder]]
material = "NiAl"
number = 5
sizes = "list"
diameters = ["3 um"]
[specimen]
shape = "free"
[process]
[[process.stage]]
name = "rest"
duration = "1 s"
)toml"),
            "scene.toml:9: specimen.shape: a powder needs a cylinder, a box or a periodic cell to be packed in; a free "
            "specimen is imported");
}

TEST(SceneMistakes, SizeOfAnotherShape) {
  EXPECT_EQ(mistake("diameter = \"58 um\"", "diameter = \"58 um\"\nsize = [\"9 um\", \"9 um\"]"),
            "scene.toml:14: specimen.size: belongs to shape = \"box\"; remove it");
  EXPECT_EQ(
      mistake("shape = \"cylinder\"\ndiameter = \"58 um\"", "shape = \"box\"\nsize = [\"9 um\", \"9 um\", \"9 um\"]"),
      "scene.toml:13: specimen.size: expected the two edges of the base (the height follows from "
      "packing.green_density), found 3");
}

TEST(SceneMistakes, HeightBesidesGreenDensity) {
  EXPECT_EQ(mistake("diameter = \"58 um\"", "diameter = \"58 um\"\nheight = \"95 um\""),
            "scene.toml:14: specimen.height: the height of a powder specimen follows from packing.green_density; "
            "remove it");
}

TEST(SceneMistakes, ImportIntoACylinderWithoutHeight) {
  EXPECT_EQ(import_mistake("shape = \"periodic\"", "shape = \"cylinder\"\ndiameter = \"9 um\""),
            "scene.toml:3: specimen.height: missing, and required (cylinder with an import: from the bottom to the "
            "punch at the start); write height = \"4.86 um\"");
}

TEST(SceneMistakes, GreenDensityBeyondSolid) {
  EXPECT_EQ(mistake("green_density = 0.6", "green_density = 1.2"),
            "scene.toml:15: specimen.packing.green_density: must be > 0 and < 1, found 1.2");
}

TEST(SceneMistakes, PackingOfAnotherShape) {
  EXPECT_EQ(mistake("green_density = 0.6", "method = \"isotropic_compression\""),
            "scene.toml:15: specimen.packing.method: a cylinder or box is packed by \"gravity_compaction\"");
}

TEST(SceneMistakes, PowderAndImport) {
  EXPECT_EQ(mistake("[specimen.packing]\ngreen_density = 0.6", "[specimen.import]\nfile = \"a.csv\""),
            "scene.toml:14: specimen.import: there is a [[powder]] already; give either a powder or an import");
}

TEST(SceneMistakes, NeitherPowderNorImport) {
  EXPECT_EQ(import_mistake("[specimen.import]\nfile = \"particles.csv\"\n", ""),
            "scene.toml:3: specimen: there are no particles; give a [[powder]] or [specimen.import]");
}

TEST(SceneMistakes, TypesOfALammpsFile) {
  EXPECT_EQ(import_mistake("file", "format = \"lammps\"\ntypes = [\"NiAl\", \"Al2O3\"]\nfile"),
            "scene.toml:7: specimen.import.types: \"Al2O3\" is not among the materials \"NiAl\"");
  EXPECT_EQ(import_mistake("file", "types = [\"NiAl\"]\nfile"),
            "scene.toml:6: specimen.import.types: belongs to format = \"lammps\"; a table names its materials in each "
            "line");
}

TEST(SceneMistakes, PeriodicTableWithoutACell) {
  const std::size_t begin = kImport.find("[specimen.cell]"), end = kImport.find("[process]");
  EXPECT_EQ(import_mistake(kImport.substr(begin, end - begin), ""),
            "scene.toml:4: specimen.shape: a table has no periodic cell; give its edge vectors a, b, c in "
            "[specimen.cell]");
}

TEST(SceneMistakes, CellWithoutVolume) {
  EXPECT_EQ(import_mistake("c = [\"0 um\", \"0 um\", \"9 um\"]", "c = [\"1 um\", \"2 um\", \"0 um\"]"),
            "scene.toml:10: specimen.cell.c: the three edge vectors lie in one plane; the cell has no volume");
  EXPECT_EQ(import_mistake("c = [\"0 um\", \"0 um\", \"9 um\"]", ""),
            "scene.toml:7: specimen.cell.c: missing; give all three edge vectors a, b, c or none");
}

TEST(SceneMistakes, CellThatIsNotPeriodic) {
  EXPECT_EQ(import_mistake("\"periodic\"", "\"free\""),
            "scene.toml:7: specimen.cell: belongs to shape = \"periodic\"; remove it");
}

TEST(SceneMistakes, GravityInAPeriodicCell) {
  EXPECT_EQ(message_of(kImport, {R"(integration.gravity=["0 m/s^2", "0 m/s^2", "-9.81 m/s^2"])"}),
            "--set integration.gravity=[\"0 m/s^2\", \"0 m/s^2\", \"-9.81 m/s^2\"]: a periodic cell has no bottom on "
            "which particles could rest; remove it");
}

TEST(SceneMistakes, RealisationsOfAnImport) {
  const std::string due =
      "scene.toml: specimen.perturbation.size: imported particles are the same in every realisation; give a size "
      "such "
      "as 1e-3 here, or leave realisations out";
  EXPECT_EQ(message_of(kImport, {"realisations=4"}), due);
  EXPECT_EQ(message_of(kImport, {"realisations=4", "specimen.perturbation.size=1e-3"}), "accepted");
  EXPECT_EQ(message_of(kGood, {"realisations=4"}), "accepted");
}
