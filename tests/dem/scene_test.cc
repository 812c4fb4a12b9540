#include "dem/io/scene.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <sstream>

#include "base/check.h"
#include "base/scene_document.h"
#include "dem/io/material_library.h"
#include "dem/io/particle_import.h"
#include "tests/support/periodic_scene.h"

using namespace densify;
using namespace densify::dem;

namespace {

const std::filesystem::path kExamples = DENSIFY_EXAMPLES;
constexpr double kCelsius = 273.15;

/// Those of particles: one that presses a specimen has another reader (press_scene_test.cc).
std::vector<std::filesystem::path> example_scenes() {
  std::vector<std::filesystem::path> scenes;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(kExamples)) {
    if (entry.path().extension() != ".toml") continue;
    if (!SceneDocument::from_file(entry.path(), {}).root().has("press")) scenes.push_back(entry.path());
  }
  return scenes;
}

// NiAl with 20 % of alumina, with the interface of thesis Table 5.7.
constexpr std::string_view kComposite = R"toml(
[materials.NiAl]
library = "NiAl"
[materials.Al2O3]
library = "Al2O3"
[[interface]]
between = ["NiAl", "Al2O3"]
effective_modulus = "139.4 GPa"
atomic_volume = "9.01e-30 m^3"
diffusion_prefactor = "3e-2 m^2/s"
activation_enthalpy = "280 kJ/mol"
grain_boundary_width = "0.5 nm"
surface_energy = "0 J/m^2"
dihedral_angle = "147 deg"
[[powder]]
material = "NiAl"
volume_fraction = 0.8
sizes = "histogram"
edges = ["1 um", "2 um", "4 um"]
weights = [3, 1]
weighted_by = "volume"
[[powder]]
material = "Al2O3"
volume_fraction = 0.2
sizes = "list"
diameters = ["1.5 um", "2.5 um"]
[powder_total]
number = 4952
[specimen]
shape = "periodic"
proportions = [1, 1, 2]
seed = 7
[specimen.packing]
green_density = 0.62
seed = 8
[specimen.cell.velocity_gradient]
z = ["1e-5 1/s", "0 1/s", "-2e-5 1/s"]
[contact.friction]
coefficient = 0.3
[contact.sintering]
radius = "smaller"
[process]
[[process.stage]]
name = "heating"
rate = "15 K/min"
temperature = "1400 degC"
)toml";

constexpr std::string_view kImport = R"toml(
[materials.iron]
density = "7.87 g/cm^3"
[specimen]
shape = "box"
size = ["10 um", "20 um", "30 um"]
[specimen.import]
file = "packs/a.data"
format = "lammps"
length_unit = "1 mm"
types = ["iron"]
[walls]
youngs_modulus = "400 GPa"
poissons_ratio = 0.2
[walls.punch]
control = "fixed"
[contact]
elasticity = "hertz"
[process]
[[process.stage]]
name = "rest"
duration = "1 s"
[[load]]
particle = 3
force = ["1 mN", "0 N", "-2 mN"]
ramp = "10 s"
[integration]
fixed_step = "1 us"
)toml";

const std::string kIron = "\n[materials.iron]\nyoungs_modulus = \"211 GPa\"\npoissons_ratio = 0.29\n";

std::string import_scene() {
  std::string text(kImport);
  return text.replace(text.find("\n[materials.iron]\n"), 18, kIron);
}

// Ratio to the values of the thesis's parameters, which are printed with four figures.
void expect_effective(const GrainBoundaryDiffusion& d, double at_1300, double at_1350, double at_1400) {
  EXPECT_NEAR(d.effective(1300 + kCelsius) / at_1300, 1, 2e-4);
  EXPECT_NEAR(d.effective(1350 + kCelsius) / at_1350, 1, 2e-4);
  EXPECT_NEAR(d.effective(1400 + kCelsius) / at_1400, 1, 5e-4);
}

}  // namespace

// D_eff (4.81, 4.83) [m^5/(N s)] with the parameters of thesis Tables 5.4 and 5.7, computed apart from this code.
TEST(Scene, EffectiveDiffusionOfThesisTables) {
  const Scene s = read_scene_text(kComposite, {});
  ASSERT_EQ(s.materials.size(), 2u);
  EXPECT_EQ(s.materials[0].name, "Al2O3");
  EXPECT_EQ(s.materials[1].name, "NiAl");
  expect_effective(s.materials[1].diffusion, 5.073e-30, 7.601e-30, 1.1107e-29);
  expect_effective(s.materials[0].diffusion, 2.307e-31, 5.588e-31, 1.283e-30);
  expect_effective(s.interfaces.at(0).diffusion, 3.141e-30, 5.887e-30, 1.062e-29);
}

// Two copper spheres (thesis Table 5.1): D_eff(1300 K) = 2.51930572e-28, a_max = r sin(146 deg / 2) = 2.1516857e-5 m,
// mass 4.2559941e-10 kg with r = 22.5 um, all printed with the figures shown.
TEST(Scene, CopperOfThesisTable) {
  const Scene s = read_scene(kExamples / "two_copper_spheres", {});
  const Material& cu = s.materials.at(0);
  EXPECT_NEAR(cu.diffusion.effective(1300) / 2.51930572e-28, 1, 1e-8);
  const double r = 22.5e-6;
  EXPECT_NEAR(r * std::sin(cu.dihedral_angle / 2) / 2.1516857e-5, 1, 1e-7);
  EXPECT_NEAR(cu.density * 4 / 3 * std::numbers::pi * r * r * r / 4.2559941e-10, 1, 1e-7);
  EXPECT_EQ(s.contact.normal_stiffness, 7e5);
}

// The specimen, process and settings of the main job, in SI.
TEST(Scene, HotPressOfNiAl) {
  const Scene s = read_scene(kExamples / "hot_press_nial", {});
  EXPECT_EQ(s.file, kExamples / "hot_press_nial" / "scene.toml");
  const auto& component = s.powder.value().components.at(0);
  EXPECT_EQ(std::get<ParticleCount>(component.amount).value, 1751u);
  const auto& sizes = std::get<TruncatedLognormal>(component.sizes);
  EXPECT_EQ(sizes.mean, 3.97e-6);
  EXPECT_EQ(sizes.standard_deviation, 2.5e-6);
  EXPECT_EQ(sizes.minimum, 1.5e-6);
  EXPECT_EQ(sizes.maximum, 18.61e-6);
  EXPECT_EQ(s.container.shape, ContainerShape::cylinder);
  EXPECT_EQ(s.container.size, Vec3(58e-6, 58e-6, 0));
  EXPECT_EQ(s.packing.value().green_density, 0.655);
  EXPECT_TRUE(s.container.punch);

  const Material& nial = s.materials.at(0);
  EXPECT_EQ(nial.youngs_modulus(298), 188e9);
  EXPECT_EQ(nial.youngs_modulus(1673), 150e9);
  EXPECT_NEAR(nial.poissons_ratio(1000), 0.307 + 2.15e-5 * 1000, 1e-12);
  EXPECT_NEAR(nial.activation_temperature - kCelsius, 682.35, 1e-9);
  EXPECT_FALSE(s.contact.friction);
  EXPECT_EQ(s.contact.hertz_radius, HertzRadius::equivalent);
  EXPECT_EQ(s.contact.sintering.value().radius, SinteringRadius::equivalent);

  // 33 min loading, 92 min at 15 K/min, 30 min hold, 138 min cooling, 330 min in all.
  const Schedule& p = s.schedule;
  ASSERT_EQ(p.stages().size(), 8u);
  EXPECT_NEAR(p.stage_end(3), 125 * 60, 1e-9);
  EXPECT_NEAR(p.stage_end(6), 293 * 60, 1e-9);
  EXPECT_NEAR(p.end(), 330 * 60, 1e-9);
  EXPECT_NEAR(p.temperature(p.stage_end(1)), 1300 + kCelsius, 1e-9);
  EXPECT_NEAR(p.temperature(p.stage_end(2)), 1350 + kCelsius, 1e-9);
  EXPECT_NEAR(p.peak_temperature(), 1400 + kCelsius, 1e-9);
  EXPECT_EQ(p.pressure(p.stage_end(6)), 30e6);
  EXPECT_EQ(p.pressure(p.end()), 0);
}

// Process II and the second reading change what they name and nothing else.
TEST(Scene, VariantsOfTheHotPress) {
  const auto text = [](const char* file, std::vector<std::string> overrides) {
    overrides.emplace_back("title=one");
    return read_scene(kExamples / "hot_press_nial" / file, overrides).effective_text;
  };
  EXPECT_EQ(text("scene_process_2.toml", {}), text("scene.toml", {"process.stage.1.pressure=5 MPa"}));
  EXPECT_EQ(text("scene_second_reading.toml", {}),
            text("scene.toml", {"contact.hertz_radius=reduced", "contact.sintering.radius=smaller",
                                "contact.sintering.neck=overlap"}));
}

TEST(Scene, PowderOfSeveralComponents) {
  const Scene s = read_scene_text(kComposite, {});
  const Powder& p = s.powder.value();
  EXPECT_EQ(p.components.at(0).material, 1);
  EXPECT_EQ(p.components.at(1).material, 0);
  EXPECT_EQ(std::get<VolumeFraction>(p.components[1].amount).value, 0.2);
  const auto& histogram = std::get<SizeHistogram>(p.components[0].sizes);
  EXPECT_EQ(histogram.edges, (std::vector<double>{1e-6, 2e-6, 4e-6}));
  EXPECT_EQ(histogram.weighted_by, HistogramWeight::volume);
  EXPECT_EQ(std::get<SizeList>(p.components[1].sizes).diameters.size(), 2u);
  EXPECT_EQ(std::get<ParticleCount>(p.total.value()).value, 4952u);
  EXPECT_EQ(p.seed, 7u);
  EXPECT_EQ(s.packing.value().seed, 8u);
  EXPECT_EQ(s.packing->method, PackingMethod::isotropic_compression);
  EXPECT_EQ(s.container.size, Vec3(1, 1, 2));
  EXPECT_EQ(s.velocity_gradient.row(2), Eigen::RowVector3d(1e-5, 0, -2e-5));
  EXPECT_EQ(s.contact.friction.value().wall_coefficient, 0.3);
}

// No sintering force between the two materials, and the pair starts with the later of them (thesis 5.4).
TEST(Scene, InterfaceOfUnlikeMaterials) {
  const Scene s = read_scene_text(kComposite, {});
  const Interface face = complete_interface(s.materials, 0, 1, s.interfaces);
  EXPECT_EQ(face.surface_energy, 0);
  EXPECT_EQ(face.activation_temperature, 0.5 * 2345);
  EXPECT_EQ(interface_modulus(face, s.materials, 300), 139.4e9);
}

TEST(Scene, ImportedSpecimen) {
  const Scene s = read_scene_text(import_scene(), {});
  ASSERT_TRUE(s.import && !s.powder && !s.packing);
  EXPECT_EQ(s.import->file, "packs/a.data");
  EXPECT_EQ(s.import->format, ImportSettings::Format::lammps);
  EXPECT_EQ(s.import->length_unit, 1e-3);
  EXPECT_EQ(s.import->types, std::vector<std::string>{"iron"});
  EXPECT_EQ(s.container.size, Vec3(10e-6, 20e-6, 30e-6));
  EXPECT_FALSE(s.container.punch);
  EXPECT_EQ(s.container.material.youngs_modulus, 400e9);
  EXPECT_EQ(s.loads.at(0).particle, 3u);
  EXPECT_EQ(s.loads[0].force, Vec3(1e-3, 0, -2e-3));
  EXPECT_EQ(s.loads[0].ramp, 10);
  EXPECT_EQ(s.integration.fixed_step, 1e-6);
}

// A scene's melting temperature moves the default of the activation; an activation of its own stands.
TEST(Scene, ActivationFollowsTheMeltingTemperature) {
  const auto activation = [](const std::vector<std::string>& overrides) {
    return read_scene(kExamples / "hot_press_nial", overrides).materials.at(0).activation_temperature;
  };
  EXPECT_EQ(activation({"materials.NiAl.melting_temperature=2000 K"}), 1000);
  EXPECT_EQ(activation({"materials.NiAl.activation_temperature=700 K"}), 700);
  EXPECT_EQ(activation({"materials.NiAl.melting_temperature=2000 K", "materials.NiAl.activation_temperature=700 K"}),
            700);
}

// Stages drive a cell; a component keeps its goal until a stage names it, and a pressure of nothing at the start drives
// nothing.
TEST(Scene, StagesDriveACell) {
  const std::string text = std::string(test::kPeriodicPowder) + R"toml([process]
start_pressure = "0 Pa"
[[process.stage]]
name = "rest"
duration = "1 s"
[[process.stage]]
name = "die"
duration = "1 s"
stress = { zz = "-30 MPa" }
strain_rate = { xy = "1e-3 1/s" }
[[process.stage]]
name = "all sides"
duration = "1 s"
pressure = "20 MPa"
[[process.stage]]
name = "hold"
duration = "1 s"
)toml";
  const Scene s = read_scene_text(text, {});
  ASSERT_TRUE(s.cell_path);
  const auto& stages = s.cell_path->stages;
  ASSERT_EQ(stages.size(), 4u);
  for (const CellGoal& g : stages[0]) EXPECT_TRUE(g.control == CellControl::rate && g.value == 0);
  EXPECT_TRUE(stages[1][2].control == CellControl::stress && stages[1][2].value == -30e6);
  EXPECT_TRUE(stages[1][3].control == CellControl::rate && stages[1][3].value == 1e-3);
  EXPECT_TRUE(stages[1][0].control == CellControl::rate && stages[1][0].value == 0);
  for (const std::size_t stage : {2, 3})
    for (std::size_t c = 0; c < 6; ++c) {
      EXPECT_TRUE(stages[stage][c].control == CellControl::stress);
      EXPECT_EQ(stages[stage][c].value, c < 3 ? -20e6 : 0.0);
    }
  const Scene again = read_scene_text(s.effective_text, {});
  EXPECT_EQ(again.effective_text, s.effective_text);
  EXPECT_EQ(again.cell_path->stages[1][2].value, -30e6);
  EXPECT_FALSE(
      read_scene_text(text, {"process.stage.2.stress=", "process.stage.2.strain_rate=", "process.stage.3.pressure="})
          .cell_path);
}

// The effective text names every value, the library's too, and reads back to itself.
TEST(Scene, EffectiveTextReadsBack) {
  std::vector<Scene> scenes{read_scene_text(kComposite, {}), read_scene_text(import_scene(), {})};
  for (const auto& file : example_scenes()) scenes.push_back(read_scene(file, {}));
  EXPECT_GE(scenes.size(), 9u);
  for (const Scene& s : scenes) EXPECT_EQ(read_scene_text(s.effective_text, {}).effective_text, s.effective_text);
  EXPECT_NE(scenes[0].effective_text.find("activation_enthalpy = \"389000 J/mol\""), std::string::npos);
}

// Every import of the examples can be read, has the scene's materials and overlaps less than the scene accepts; the
// arrangements have the contacts they are made for: one of two spheres, 8 of each of 125 centres and 6^3 corners.
TEST(Scene, ImportsOfExamples) {
  std::size_t imports = 0;
  for (const auto& file : example_scenes()) {
    const Scene s = read_scene(file, {});
    if (!s.import) continue;
    const ImportedParticles p = read_particle_table(s.import->file, s.import->length_unit);
    EXPECT_NO_THROW(reject_overlaps(p, Cell{}, s.import->largest_overlap));
    std::size_t contacts = 0;
    for (std::size_t i = 0; i < p.size(); ++i) {
      EXPECT_EQ(p.material[i], s.materials.at(0).name);
      for (std::size_t j = 0; j < i; ++j) {
        contacts += (p.position[i] - p.position[j]).norm() < p.radius[i] + p.radius[j];
      }
    }
    EXPECT_EQ(contacts, p.size() == 2 ? 1u : 1000u) << file;
    ++imports;
  }
  EXPECT_EQ(imports, 4u);
}

// Every key that any example or test scene here has in use is in the help.
TEST(Scene, HelpHasEveryKey) {
  const std::string help = scene_help();
  std::string texts =
      read_scene_text(kComposite, {}).effective_text + read_scene_text(import_scene(), {}).effective_text;
  for (const auto& file : example_scenes()) texts += read_scene(file, {}).effective_text;
  std::istringstream lines(texts);
  std::size_t keys = 0;
  for (std::string line; std::getline(lines, line);) {
    const std::size_t at = line.find(" = ");
    if (at == line.npos) continue;
    const std::string key = line.substr(0, at) + " ";
    EXPECT_TRUE(help.find("." + key) != help.npos || help.find("\n" + key) != help.npos) << key;
    ++keys;
  }
  EXPECT_GT(keys, 300u);
  EXPECT_NE(help.find("contact.sintering.starting_neck"), help.npos);
  EXPECT_NE(help.find("D_0gb of grain boundary diffusion (4.83)"), help.npos);
}

// The shipped files are read with the declarations of [materials.NAME], so that a key misspelt there is found.
TEST(MaterialLibrary, HoldsCompleteMaterials) {
  EXPECT_EQ(library_names(), (std::vector<std::string>{"Al2O3", "Cu", "NiAl"}));
  for (const std::string& name : library_names()) {
    const Material m = library_material(name).material;
    EXPECT_EQ(m.name, name);
    EXPECT_TRUE(m.diffusion.complete()) << name;
    EXPECT_TRUE(std::isfinite(m.density + m.youngs_modulus(300) + m.poissons_ratio(300) + m.surface_energy +
                              m.dihedral_angle + m.activation_temperature))
        << name;
  }
}

// The diffusion of NiAl was fitted to a die specimen of 58 um: another kind of specimen says so, and so does a much
// wider die; other diffusion, or another statement, is another set of parameters.
TEST(Scene, CalibrationNamesItsSpecimen) {
  const auto lines = [](const std::string& shape, double size, const std::string& material, bool sinters) {
    return calibration_warnings(
        read_scene_text("[materials.NiAl]\nlibrary = \"NiAl\"\n" + material +
                            "[[powder]]\nmaterial = \"NiAl\"\nnumber = 100\nsizes = \"list\"\ndiameters = [\"4 um\"]\n"
                            "[specimen]\n" +
                            shape + (sinters ? "[contact.sintering]\n" : "") +
                            "[process]\n[[process.stage]]\nname = \"heat\"\nduration = \"1 h\"\n"
                            "temperature = \"1400 degC\"\n",
                        {}),
        size);
  };
  const std::string die = "shape = \"cylinder\"\ndiameter = \"58 um\"\n", cell = "shape = \"periodic\"\n";
  EXPECT_TRUE(lines(die, 58e-6, "", true).empty());
  EXPECT_TRUE(lines(die, 80e-6, "", true).empty());
  const auto wide = lines(die, 90e-6, "", true);
  ASSERT_EQ(wide.size(), 1u);
  EXPECT_NE(wide[0].find("shape \"cylinder\" of 58 um, and this is one of shape \"cylinder\" of 90 um"),
            std::string::npos)
      << wide[0];
  const auto periodic = lines(cell, 40e-6, "", true);
  ASSERT_EQ(periodic.size(), 1u);
  EXPECT_EQ(periodic[0].find("the diffusion of NiAl was fitted to densities of a specimen of shape \"cylinder\""), 0u);
  EXPECT_TRUE(lines(cell, 40e-6, "", false).empty());
  EXPECT_TRUE(lines(cell, 40e-6, "activation_enthalpy = \"180 kJ/mol\"\n", true).empty());
  EXPECT_TRUE(lines(cell, 40e-6, "calibrated_on = \"periodic\"\ncalibrated_size = \"40 um\"\n", true).empty());
}
