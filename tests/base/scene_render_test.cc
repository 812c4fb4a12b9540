// The same declarations read, print the help and write the effective input.

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>
#include <map>

#include "tests/base/scene_support.h"

using namespace densify;
using densify::test::effective_of;

namespace {

constexpr double kNotSet = std::numeric_limits<double>::quiet_NaN();

enum class Model { viscous, maxwell };

struct Everything {
  std::string title = "untitled";
  double step = 0.1;
  double mass_factor = 1.0;
  bool friction = true;
  Model model = Model::maxwell;
  double unset = kNotSet;
  std::array<double, 3> gravity{0.0, 0.0, -9.81};
  std::vector<double> radii;
  std::vector<std::string> names;
  std::map<std::string, PiecewiseLinear> modulus;
  std::vector<double> forces;
  double output_every = 60.0;
  std::uint64_t seed = 1;

  void read(Section& root) {
    root.section("powder", Need::defaulted, "the powder", [this](Section& s) {
      s.integer("seed", seed, 0, std::numeric_limits<std::int64_t>::max(), Need::optional, "random seed");
      s.quantity_list("radii", radii, dim::length, Range::positive(), Need::optional, "radii");
    });
    root.text("title", title, Need::optional, "title of the scene");
    root.quantity("step", step, dim::none, Range::unit_interval(), Need::optional, "step over critical step");
    root.quantity("mass_factor", mass_factor, dim::none, Range::positive(), Need::optional, "mass scaling");
    root.quantity("unset", unset, dim::length, Range::any(), Need::optional, "nothing by default");
    root.flag("friction", friction, "Coulomb friction");
    root.choice("model", model, {{"viscous", Model::viscous}, {"maxwell", Model::maxwell}}, Need::optional, "law");
    root.vector3("gravity", gravity, dim::acceleration, Need::optional, "gravity");
    root.text_list("names", names, Need::optional, "names");
    root.named_list("material", Need::required, "materials", [this](Section& s, std::string name) {
      s.table("young", modulus[name], dim::temperature, dim::pressure, Range::positive(), Need::required, "modulus");
    });
    root.list("load", Need::optional, "loads", [this](Section& s, std::size_t i) {
      forces.resize(i + 1, kNotSet);
      s.quantity("force", forces[i], dim::force, Range::any(), Need::required, "force");
      s.section("extra", Need::optional, "more", [](Section& below) {
        double angle = kNotSet;
        below.quantity("angle", angle, dim::angle, Range::any(), Need::optional, "direction");
      });
    });
    root.section("output", Need::optional, "output", [this](Section& s) {
      s.quantity("every", output_every, dim::time, Range::positive(), Need::optional, "interval");
    });
  }
};

constexpr std::string_view kScene = R"toml(
names = ["a \"b\"", 'c\d']
mass_factor = 1e14
step = "5 %"
model = "viscous"
[material.NiAl]
young = [["25 degC", "188.3 GPa"], ["1400 degC", "150.1 GPa"]]
[material."Al2O3 (alpha)"]
young = "390.7 GPa"
[powder]
radii = ["1.1 um", "3.3 um"]
[[load]]
force = "0.01 N"
[load.extra]
angle = "147 deg"
[[load]]
force = "-3.7 uN"
)toml";

}  // namespace

TEST(SceneRender, ReadsEveryKind) {
  Everything e;
  effective_of(kScene, [&](Section& root) { e.read(root); });
  EXPECT_EQ(e.title, "untitled");
  EXPECT_EQ(e.names, (std::vector<std::string>{"a \"b\"", "c\\d"}));
  EXPECT_EQ(e.mass_factor, 1e14);
  EXPECT_EQ(e.step, 0.05);
  EXPECT_EQ(e.model, Model::viscous);
  EXPECT_EQ(e.radii, (std::vector<double>{1.1e-6, 3.3e-6}));
  EXPECT_EQ(e.forces, (std::vector<double>{0.01, -3.7e-6}));
  EXPECT_EQ(e.modulus.at("NiAl").knots().size(), 2u);
  EXPECT_EQ(e.modulus.at("Al2O3 (alpha)")(500.0), 390.7e9);
  EXPECT_TRUE(std::isnan(e.unset));
  EXPECT_EQ(e.output_every, 60.0);
}

// In the order of declaration, values before tables; what nobody set is left out, a defaulted section is not.
TEST(SceneRender, EffectiveTextHoldsEveryValueInUse) {
  Everything e;
  EXPECT_EQ(effective_of("[material.NiAl]\nyoung = \"183 GPa\"\n", [&](Section& root) { e.read(root); }),
            R"(title = "untitled"
step = 0.1
mass_factor = 1.0
friction = true
model = "maxwell"
gravity = ["0 m/s^2", "0 m/s^2", "-9.81 m/s^2"]

[powder]
seed = 1

[material.NiAl]
young = "1.83e+11 Pa"
)");
}

// Reading the effective text again gives the same values bit for bit, and the same text.
TEST(SceneRender, EffectiveTextComesBack) {
  Everything first;
  Everything second;
  const std::string text = effective_of(kScene, [&](Section& root) { first.read(root); });
  EXPECT_EQ(effective_of(text, [&](Section& root) { second.read(root); }), text);
  EXPECT_EQ(first.names, second.names);
  EXPECT_EQ(first.radii, second.radii);
  EXPECT_EQ(first.forces, second.forces);
  EXPECT_EQ(first.mass_factor, second.mass_factor);
  EXPECT_EQ(first.gravity, second.gravity);
  ASSERT_EQ(first.modulus.size(), second.modulus.size());
  EXPECT_EQ(first.modulus.at("NiAl").knots(), second.modulus.at("NiAl").knots());
  EXPECT_NE(text.find("[load.extra]\nangle = \"2.56563400043166"), std::string::npos) << text;
}

// A visit for help reads nothing, goes into every section once, and prints aligned columns.
TEST(SceneRender, HelpShowsEveryKey) {
  Everything e;
  SceneDocument document = SceneDocument::for_help();
  Section root = document.root();
  EXPECT_TRUE(root.documenting());
  e.read(root);
  const std::string help = document.help_text();
  const auto line = [&help](const std::string& path) {
    const std::size_t at = help.find("\n" + path + " ");
    if (at == std::string::npos) return std::string("no line for ") + path;
    std::string text = help.substr(at + 1, help.find('\n', at + 1) - at - 1);
    for (std::size_t gap = text.find("   "); gap != std::string::npos; gap = text.find("   ")) text.erase(gap, 1);
    return text;
  };
  EXPECT_EQ(line("step"), "step  number  >= 0 and <= 1  0.1  step over critical step");
  EXPECT_EQ(line("unset"), "unset  length (m)  -  -  nothing by default");
  EXPECT_EQ(line("model"), "model  choice  \"viscous\", \"maxwell\"  \"maxwell\"  law");
  EXPECT_EQ(line("powder.seed"), "powder.seed  whole number  >= 0  1  random seed");
  EXPECT_EQ(line("material.<name>.young"),
            "material.<name>.young  pressure (Pa) or table over temperature  > 0 Pa  required  modulus");
  EXPECT_EQ(line("load.#.extra.angle"), "load.#.extra.angle  angle (rad)  -  -  direction");
  EXPECT_EQ(line("output.every"), "output.every  time (s)  > 0 s  60 s  interval");
  // Aligned: the last column starts at the same place in every line.
  EXPECT_EQ(help.find("meaning"), help.substr(help.find("\nfriction") + 1).find("Coulomb friction"));
}

TEST(SceneRender, KnowsPlacesAndFolder) {
  SceneDocument document = SceneDocument::from_text("[a]\nk = 1\n", "some/where/scene.toml", {});
  Section root = document.root();
  EXPECT_EQ(root.directory(), "some/where");
  EXPECT_TRUE(root.has("a"));
  EXPECT_FALSE(root.has("b"));
  const bool found = root.section("a", Need::optional, "a", [](Section& a) {
    EXPECT_EQ(a.where("k"), "some/where/scene.toml:2: a.k");
    EXPECT_EQ(a.where("absent"), "some/where/scene.toml:1: a.absent");
    EXPECT_EQ(a.where(""), "some/where/scene.toml:1: a");
  });
  EXPECT_TRUE(found);
}
