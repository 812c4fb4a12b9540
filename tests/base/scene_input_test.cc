// One test a mistake: each message names the line, the key, what is wrong and what to write.

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <limits>

#include "tests/base/scene_support.h"

using namespace densify;
using densify::test::message_of;

namespace {

enum class Model { viscous, maxwell };

// A section [a] with one key `k` of each kind, chosen by the test.
template <class Read>
std::string mistake(std::string_view line, Read read) {
  return message_of("[a]\n\n" + std::string(line) + "\n", [&](Section& root) {
    root.section("a", Need::required, "test section", [&](Section& section) { read(section); });
  });
}

void read_length(Section& s) {
  double value = std::numeric_limits<double>::quiet_NaN();
  s.quantity("k", value, dim::length, Range::positive(), Need::required, "mean radius");
}

void read_ratio(Section& s) {
  double value = 0.3;
  s.quantity("k", value, dim::none, Range::inside(-1.0, 0.5), Need::optional, "Poisson's ratio");
}

void read_integer(Section& s) {
  std::uint32_t value = 1;
  s.integer("k", value, 1, 100, Need::optional, "how many");
}

void read_choice(Section& s) {
  Model model = Model::viscous;
  s.choice("k", model, {{"viscous", Model::viscous}, {"maxwell", Model::maxwell}}, Need::optional, "law");
}

void read_table(Section& s) {
  PiecewiseLinear value;
  s.table("k", value, dim::temperature, dim::pressure, Range::positive(), Need::required, "Young's modulus");
}

void read_vector(Section& s) {
  std::array<double, 3> value{};
  s.vector3("k", value, dim::acceleration, Need::optional, "gravity");
}

}  // namespace

TEST(SceneInput, SyntaxErrorHasLineAndColumn) {
  const std::string message = message_of("[a]\nk = = 3\n", [](Section&) {});
  EXPECT_EQ(message.substr(0, 17), "scene.toml:2:5: E") << message;
}

TEST(SceneInput, BareNumberWhereALengthIsDue) {
  EXPECT_EQ(mistake("k = 4.86e-6", read_length),
            "scene.toml:3: a.k: a bare number where a length is due; write \"4.86 um\"");
  EXPECT_EQ(mistake("k = 0", read_length), "scene.toml:3: a.k: a bare number where a length is due; write \"4.86 um\"");
}

TEST(SceneInput, MissingUnit) {
  EXPECT_EQ(mistake("k = \"3\"", read_length),
            "scene.toml:3: a.k: \"3\": unit missing; a length is due, such as \"4.86 um\"");
}

TEST(SceneInput, UnknownUnit) {
  EXPECT_EQ(mistake("k = \"3 Um\"", read_length),
            "scene.toml:3: a.k: \"3 Um\": unknown unit \"Um\"; did you mean \"um\"?");
}

TEST(SceneInput, WrongDimension) {
  EXPECT_EQ(mistake("k = \"3 s\"", read_length),
            "scene.toml:3: a.k: \"3 s\": expected length such as \"4.86 um\", got time");
}

TEST(SceneInput, NegativeRadius) {
  EXPECT_EQ(mistake("k = \"-3 um\"", read_length), "scene.toml:3: a.k: must be > 0 m, found \"-3 um\"");
}

TEST(SceneInput, PoissonsRatioOfTwo) {
  EXPECT_EQ(mistake("k = 2.0", read_ratio), "scene.toml:3: a.k: must be > -1 and < 0.5, found 2");
}

TEST(SceneInput, NumbersMustBeFinite) {
  for (const char* value : {"k = nan", "k = inf", "k = -inf"}) {
    EXPECT_EQ(mistake(value, read_ratio), "scene.toml:3: a.k: must be a finite number");
  }
}

TEST(SceneInput, QuantityOfAWrongKind) {
  EXPECT_EQ(mistake("k = true", read_length), "scene.toml:3: a.k: expected a length such as \"4.86 um\", found true");
  EXPECT_EQ(mistake("k = [\"3 um\"]", read_length),
            "scene.toml:3: a.k: expected a length such as \"4.86 um\", found a list");
  EXPECT_EQ(mistake("k = 2026-01-01", read_length),
            "scene.toml:3: a.k: expected a length such as \"4.86 um\", found a date or time");
}

TEST(SceneInput, MissingKeyShowsTheSpelling) {
  EXPECT_EQ(mistake("", read_length), "scene.toml:1: a.k: missing, and required (mean radius); write k = \"4.86 um\"");
}

TEST(SceneInput, MissingSection) {
  EXPECT_EQ(message_of("", [](Section& root) { root.section("a", Need::required, "powder", [](Section&) {}); }),
            "scene.toml: a: missing, and required (powder)");
}

TEST(SceneInput, SectionOfAWrongKind) {
  EXPECT_EQ(message_of("a = 3", [](Section& root) { root.section("a", Need::optional, "powder", [](Section&) {}); }),
            "scene.toml:1: a: expected a section [a], found 3");
}

TEST(SceneInput, WholeNumbers) {
  EXPECT_EQ(mistake("k = 3.5", read_integer), "scene.toml:3: a.k: expected a whole number, found 3.5");
  EXPECT_EQ(mistake("k = \"3\"", read_integer), "scene.toml:3: a.k: expected a whole number, found \"3\"");
  EXPECT_EQ(mistake("k = -1", read_integer), "scene.toml:3: a.k: must be >= 1 and <= 100, found -1");
  EXPECT_EQ(mistake("k = 101", read_integer), "scene.toml:3: a.k: must be >= 1 and <= 100, found 101");
}

// The type of the variable bounds the key even where the declaration does not.
TEST(SceneInput, WholeNumberFitsItsType) {
  const auto read = [](Section& s) {
    std::uint8_t value = 0;
    s.integer("k", value, -5, 1000, Need::optional, "small");
  };
  EXPECT_EQ(mistake("k = 256", read), "scene.toml:3: a.k: must be >= 0 and <= 255, found 256");
}

TEST(SceneInput, FlagAndText) {
  bool flag = false;
  EXPECT_EQ(mistake("k = \"true\"", [&](Section& s) { s.flag("k", flag, "switch"); }),
            "scene.toml:3: a.k: expected true or false (without quotes), found \"true\"");
  std::string text;
  EXPECT_EQ(mistake("k = 3", [&](Section& s) { s.text("k", text, Need::optional, "name"); }),
            "scene.toml:3: a.k: expected a text in quotes, found 3");
  EXPECT_EQ(mistake("k = \"\"", [&](Section& s) { s.text("k", text, Need::required, "name"); }),
            "scene.toml:3: a.k: must not be empty");
}

TEST(SceneInput, UnknownChoiceSuggestsTheNearest) {
  EXPECT_EQ(mistake("k = \"maxwel\"", read_choice),
            "scene.toml:3: a.k: \"maxwel\" is not among \"viscous\", \"maxwell\"; did you mean \"maxwell\"?");
}

TEST(SceneInput, UnknownKeySuggestsTheNearest) {
  const auto read = [](Section& root) {
    root.section("powder", Need::required, "powder", [](Section& s) {
      double mean = 1.0;
      std::int64_t seed = 1;
      s.quantity("mean_radius", mean, dim::length, Range::positive(), Need::optional, "mean");
      s.integer("seed", seed, 0, 100, Need::optional, "seed");
    });
  };
  EXPECT_EQ(message_of("[powder]\nseed = 3\nmean_raduis = \"3 um\"\n", read),
            "scene.toml:3: powder.mean_raduis: unknown key; did you mean \"mean_radius\"?");
  EXPECT_EQ(message_of("[powder]\nhumidity = 3\n", read),
            "scene.toml:2: powder.humidity: unknown key; known here: mean_radius, seed");
  EXPECT_EQ(message_of("[powder]\nzz = 3\n[podwer]\nseed = 3\n", read).substr(0, 24), "scene.toml:2: powder.zz:");
  EXPECT_EQ(message_of("[powder]\n[powdr]\nseed = 3\n", read),
            "scene.toml:2: powdr: unknown key; did you mean \"powder\"?");
}

TEST(SceneInput, Vectors) {
  EXPECT_EQ(mistake("k = [\"0 m/s^2\", \"0 m/s^2\"]", read_vector),
            "scene.toml:3: a.k: expected three components, found 2");
  EXPECT_EQ(mistake("k = [\"0 m/s^2\",\n 0,\n \"0 m/s^2\"]", read_vector),
            "scene.toml:4: a.k: a bare number where an acceleration is due; write \"9.81 m/s^2\"");
  EXPECT_EQ(mistake("k = \"9.81 m/s^2\"", read_vector),
            "scene.toml:3: a.k: expected a list such as [\"9.81 m/s^2\", ...], found \"9.81 m/s^2\"");
}

TEST(SceneInput, Lists) {
  std::vector<double> radii;
  const auto read = [&](Section& s) {
    s.quantity_list("k", radii, dim::length, Range::positive(), Need::required, "radii");
  };
  EXPECT_EQ(mistake("k = []", read), "scene.toml:3: a.k: the list is empty; give at least one entry");
  EXPECT_EQ(mistake("k = [\"3 um\", \"-1 um\"]", read), "scene.toml:3: a.k: must be > 0 m, found \"-1 um\"");
  std::vector<std::string> names;
  EXPECT_EQ(mistake("k = [3]", [&](Section& s) { s.text_list("k", names, Need::optional, "names"); }),
            "scene.toml:3: a.k: expected a text in quotes, found 3");
}

TEST(SceneInput, Tables) {
  EXPECT_EQ(mistake("k = [[\"298 K\", \"188 GPa\"],\n [\"298 K\", \"150 GPa\"]]", read_table),
            "scene.toml:3: a.k: the first column must increase, and pair 2 does not; sort the table");
  EXPECT_EQ(mistake("k = [[\"298 K\", \"188 GPa\"],\n [\"400 K\"]]", read_table),
            "scene.toml:4: a.k: expected pairs such as [\"1400 degC\", \"30 MPa\"]");
  EXPECT_EQ(mistake("k = [[\"298 K\", \"188 GPa\"],\n [\"400 K\", \"-1 GPa\"]]", read_table),
            "scene.toml:4: a.k: must be > 0 Pa, found \"-1 GPa\"");
  EXPECT_EQ(mistake("k = []", read_table), "scene.toml:3: a.k: the table is empty; give at least one pair");
  EXPECT_EQ(mistake("k = 183e9", read_table),
            "scene.toml:3: a.k: a bare number where a pressure is due; write \"30 MPa\"");
}

TEST(SceneInput, ListOfSectionsAndNamedSections) {
  const auto list = [](Section& root) { root.list("wall", Need::required, "walls", [](Section&, std::size_t) {}); };
  EXPECT_EQ(message_of("[wall]\n", list), "scene.toml:1: wall: expected a list of sections, each headed [[wall]]");
  EXPECT_EQ(message_of("wall = []\n", list), "scene.toml:1: wall: the list is empty; give at least one [[wall]]");
  const auto named = [](Section& root) {
    root.named_list("material", Need::required, "m", [](Section&, std::string) {});
  };
  EXPECT_EQ(message_of("[material]\nNiAl = 3\n", named),
            "scene.toml:2: material.NiAl: expected sections headed [material.NAME], found 3");
  EXPECT_EQ(message_of("[material]\n", named),
            "scene.toml:1: material: is empty; give sections headed [material.NAME]");
}

TEST(SceneInput, FileThatIsNotThere) {
  const auto message = [](const std::filesystem::path& file) -> std::string {
    try {
      SceneDocument::from_file(file, {});
    } catch (const InputError& e) {
      return e.what();
    }
    return "accepted";
  };
  EXPECT_EQ(message("no/such.toml"), "no/such.toml: there is no such scene file");
  EXPECT_NE(message(std::filesystem::temp_directory_path()).find("is a folder"), std::string::npos);
}
