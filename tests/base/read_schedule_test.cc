#include <gtest/gtest.h>

#include "base/schedule.h"
#include "tests/base/scene_support.h"

using namespace densify;

namespace {

Schedule read(std::string_view text) {
  SceneDocument document = SceneDocument::from_text(text, "scene.toml", {});
  Section root = document.root();
  Schedule schedule = read_schedule(root);
  document.reject_unknown();
  return schedule;
}

std::string mistake(std::string_view text) {
  return test::message_of(text, [](Section& root) { read_schedule(root); });
}

// A first stage of 60 s at 20 degC, then the given lines from line 4 on.
std::string second_stage(const std::string& lines) {
  return mistake("[[stage]]\nname = \"load\"\nduration = \"60 s\"\n[[stage]]\nname = \"heat\"\n" + lines + "\n");
}

}  // namespace

// Loading to 30 MPa in 1 min, 15 K/min to 1400 degC (1380 K / 0.25 K/s = 5520 s), dwell until 180 min, unloading in 2
// h.
TEST(ReadSchedule, HotPressing) {
  const Schedule s = read(R"(
[[stage]]
name = "load"
duration = "1 min"
pressure = "30 MPa"
[[stage]]
name = "heat"
rate = "15 K/min"
temperature = "1400 degC"
[[stage]]
name = "dwell"
end = "180 min"
[[stage]]
name = "unload"
duration = "2 h"
pressure = "0 Pa"
temperature = "20 degC"
)");
  ASSERT_EQ(s.stages().size(), 4u);
  EXPECT_EQ(s.temperature(0.0), 293.15);
  EXPECT_EQ(s.stage_end(0), 60.0);
  EXPECT_DOUBLE_EQ(s.stage_end(1), 5580.0);
  EXPECT_DOUBLE_EQ(s.stage_end(2), 10800.0);
  EXPECT_DOUBLE_EQ(s.end(), 18000.0);
  EXPECT_DOUBLE_EQ(s.peak_temperature(), 1673.15);
  EXPECT_EQ(s.pressure(s.stage_end(2)), 30e6);
  EXPECT_EQ(s.pressure(s.end()), 0.0);
  EXPECT_DOUBLE_EQ(s.temperature(s.end()), 293.15);
}

// Cooling takes the same positive rate: 100 K at 10 K/min is 600 s.
TEST(ReadSchedule, CoolingRateIsPositiveToo) {
  const Schedule s = read(
      "start_temperature = \"500 K\"\nstart_pressure = \"2 bar\"\n[[stage]]\nname = \"cool\"\nrate = \"10 K/min\"\n"
      "temperature = \"400 K\"\n");
  EXPECT_DOUBLE_EQ(s.end(), 600.0);
  EXPECT_DOUBLE_EQ(s.temperature_rate(1.0), -1.0 / 6.0);
  EXPECT_EQ(s.pressure(300.0), 2e5);
}

TEST(ReadSchedule, GoesBackInTime) {
  EXPECT_EQ(
      second_stage("end = \"30 s\""),
      "scene.toml:6: stage.2.end: stage \"heat\" goes back in time (it starts at 60 s); end counts from the start of "
      "the process, so give a later one or a duration");
}

TEST(ReadSchedule, ExactlyOneDuration) {
  EXPECT_EQ(second_stage(""),
            "scene.toml:4: stage.2: stage \"heat\" needs exactly one of duration, end and rate, found none");
  EXPECT_EQ(
      second_stage("duration = \"1 s\"\nrate = \"1 K/s\""),
      "scene.toml:4: stage.2: stage \"heat\" needs exactly one of duration, end and rate, found duration and rate");
}

TEST(ReadSchedule, DurationMustBePositive) {
  EXPECT_EQ(second_stage("duration = \"0 s\""), "scene.toml:6: stage.2.duration: must be > 0 s, found \"0 s\"");
  EXPECT_EQ(second_stage("duration = \"-3 min\""), "scene.toml:6: stage.2.duration: must be > 0 s, found \"-3 min\"");
}

TEST(ReadSchedule, RateNeedsAnotherTemperature) {
  const std::string message =
      "scene.toml:6: stage.2.rate: stage \"heat\" has a rate but does not change the temperature; give a temperature "
      "or a "
      "duration";
  EXPECT_EQ(second_stage("rate = \"15 K/min\""), message);
  EXPECT_EQ(second_stage("rate = \"15 K/min\"\ntemperature = \"20 degC\""), message);
}

TEST(ReadSchedule, RateIsPositive) {
  EXPECT_EQ(second_stage("rate = \"-15 K/min\"\ntemperature = \"0 degC\""),
            "scene.toml:6: stage.2.rate: must be > 0 K/s, found \"-15 K/min\"");
}

TEST(ReadSchedule, TemperatureAndPressureAreNotNegative) {
  EXPECT_EQ(second_stage("duration = \"1 s\"\ntemperature = \"-300 degC\""),
            "scene.toml:7: stage.2.temperature: must be >= 0 K, found \"-300 degC\"");
  EXPECT_EQ(second_stage("duration = \"1 s\"\npressure = \"-1 Pa\""),
            "scene.toml:7: stage.2.pressure: must be >= 0 Pa, found \"-1 Pa\"");
}

TEST(ReadSchedule, StageNeedsAName) {
  EXPECT_EQ(mistake("[[stage]]\nduration = \"1 s\"\n"),
            "scene.toml:1: stage.1.name: missing, and required (name of the stage, as results call it); write name = "
            "\"...\"");
}

TEST(ReadSchedule, NoStage) {
  EXPECT_EQ(mistake(""), "scene.toml: stage: missing, and required (stages of the process in order)");
}

// The help visit needs no values.
TEST(ReadSchedule, DocumentsItsKeys) {
  SceneDocument document = SceneDocument::for_help();
  Section root = document.root();
  read_schedule(root);
  EXPECT_NE(document.help_text().find("stage.#.rate"), std::string::npos);
  EXPECT_NE(document.help_text().find("293.15 K"), std::string::npos);
}
