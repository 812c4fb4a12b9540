// What --set changes, and what its mistakes say: the override stands where the line would.

#include <gtest/gtest.h>

#include <limits>

#include "tests/base/scene_support.h"

using namespace densify;
using densify::test::message_of;

namespace {

constexpr std::string_view kScene = R"(
title = "press"
[powder]
seed = 3
[[process.stage]]
pressure = "1 MPa"
[[process.stage]]
pressure = "2 MPa"
)";

struct Values {
  std::string title;
  std::int64_t seed = 0;
  double pressure[2] = {0.0, 0.0};
  double step = 0.5;

  void read(Section& root) {
    root.text("title", title, Need::optional, "title");
    root.section("powder", Need::required, "powder",
                 [this](Section& s) { s.integer("seed", seed, 0, 1000, Need::required, "seed"); });
    root.section("process", Need::required, "process", [this](Section& process) {
      process.list("stage", Need::required, "stages", [this](Section& s, std::size_t i) {
        s.quantity("pressure", pressure[i], dim::pressure, Range::non_negative(), Need::required, "pressure");
      });
    });
    root.section("integration", Need::optional, "integration", [this](Section& s) {
      s.quantity("step", step, dim::none, Range::positive(), Need::required, "step");
    });
  }
};

Values read(const std::vector<std::string>& overrides) {
  Values values;
  SceneDocument document = SceneDocument::from_text(kScene, "scene.toml", overrides);
  Section root = document.root();
  values.read(root);
  document.reject_unknown();
  return values;
}

std::string mistake(const std::string& assignment) {
  Values values;
  return message_of(kScene, [&](Section& root) { values.read(root); }, {assignment});
}

}  // namespace

// With and without the quotes that a shell eats; list entries count from 1; a missing table is made.
TEST(SceneOverride, ReplacesAndCreates) {
  EXPECT_EQ(read({}).pressure[1], 2e6);
  EXPECT_EQ(read({"process.stage.2.pressure=\"5 MPa\""}).pressure[1], 5e6);
  EXPECT_EQ(read({"process.stage.2.pressure=5 MPa"}).pressure[1], 5e6);
  EXPECT_EQ(read({"process.stage.1.pressure=5 MPa"}).pressure[0], 5e6);
  EXPECT_EQ(read({"process.stage.1={pressure = \"7 MPa\"}"}).pressure[0], 7e6);
  EXPECT_EQ(read({"powder.seed=42"}).seed, 42);
  EXPECT_EQ(read({"integration.step=0.1"}).step, 0.1);
  EXPECT_EQ(read({"title=a = b"}).title, "a = b");
  EXPECT_EQ(read({"powder.seed=42", "powder.seed=43"}).seed, 43);
}

// An empty value is as if the key had never been written.
TEST(SceneOverride, EmptyValueRemoves) {
  EXPECT_EQ(read({"title="}).title, "");
  EXPECT_EQ(read({"integration.step=0.3", "integration="}).step, 0.5);
  EXPECT_EQ(read({"nothing.at.all="}).seed, 3);
  EXPECT_NE(mistake("powder.seed=").find("powder.seed: missing, and required"), std::string::npos);
}

TEST(SceneOverride, WrongValueNamesTheOverride) {
  EXPECT_EQ(mistake("process.stage.1.pressure=5"),
            "--set process.stage.1.pressure=5: a bare number where a pressure is due; write \"30 MPa\"");
  EXPECT_EQ(mistake("powder.seed=-1"), "--set powder.seed=-1: must be >= 0 and <= 1000, found -1");
  EXPECT_EQ(
      mistake("process.stage.1={pressure = \"3 um\"}"),
      "--set process.stage.1={pressure = \"3 um\"}: process.stage.1.pressure: \"3 um\": expected pressure such as "
      "\"30 MPa\", got length");
}

TEST(SceneOverride, MisspeltKeyNamesTheOverride) {
  EXPECT_EQ(mistake("process.stage.1.presure=5 MPa"),
            "--set process.stage.1.presure=5 MPa: unknown key; did you mean \"pressure\"?");
  EXPECT_EQ(mistake("proces.stage=5"), "--set proces.stage=5: proces: unknown key; did you mean \"process\"?");
  EXPECT_EQ(mistake("integration.stepp=5"),
            "--set integration.stepp=5: integration.step: missing, and required (step); write step = 0.3");
}

TEST(SceneOverride, ListEntryOutOfRange) {
  EXPECT_EQ(mistake("process.stage.3.pressure=5 MPa"),
            "--set process.stage.3.pressure=5 MPa: process.stage is a list; number its entries from 1 to 2, as in "
            "process.stage.1");
  EXPECT_EQ(mistake("process.stage.0.pressure=5 MPa").find("number its entries from 1 to 2") == std::string::npos,
            false);
  EXPECT_NE(mistake("process.stage.pressure=5 MPa").find("process.stage is a list"), std::string::npos);
}

TEST(SceneOverride, PathThroughAValue) {
  EXPECT_EQ(mistake("title.x=5"), "--set title.x=5: title is a text, not a table");
}

TEST(SceneOverride, NotAnAssignment) {
  for (const char* text : {"powder", "=3", "powder..seed=3", ""}) {
    EXPECT_EQ(mistake(text), std::string("--set ") + text + ": not understood; write --set path.to.key=value");
  }
}
