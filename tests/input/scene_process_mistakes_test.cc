// Mistakes in process, loads and integration.

#include <gtest/gtest.h>

#include "tests/input/scene_mistake.h"

using namespace densify::test;

TEST(SceneMistakes, ScheduleThatGoesBackInTime) {
  EXPECT_EQ(mistake("rate = \"15 K/min\"", "end = \"20 min\""),
            "scene.toml:34: process.stage.2.end: stage \"heating\" goes back in time (it starts at 1980 s); end counts "
            "from the start of the process, so give a later one or a duration");
}

// 0.5 x 1911 K against 600 degC.
TEST(SceneMistakes, ActivationAboveThePeakTemperature) {
  EXPECT_EQ(mistake("temperature = \"1400 degC\"", "temperature = \"600 degC\""),
            "scene.toml:28: process.stage: sintering would never start: its lowest activation temperature is 955.5 K "
            "and the process peaks at 873.15 K; heat more, lower activation_temperature, or remove "
            "[contact.sintering]");
}

TEST(SceneMistakes, PressureWithoutAPunch) {
  EXPECT_EQ(mistake("[walls.punch]\ndamping_ratio = 0.3", "[walls.punch]\ncontrol = \"fixed\""),
            "scene.toml:28: process.stage: stage \"loading\": there is no punch that could apply a pressure; set "
            "walls.punch.control = \"pressure\", or remove the pressure");
  EXPECT_EQ(message_of(R"toml([materials.Cu]
library = "Cu"
[specimen]
shape = "free"
[specimen.import]
file = "particles.csv"
[process]
start_pressure = "1 MPa"
[[process.stage]]
name = "rest"
duration = "1 s"
pressure = "0 Pa"
)toml"),
            "scene.toml:8: process.start_pressure: there is no punch that could apply a pressure; choose shape = "
            "\"cylinder\", \"box\" or \"periodic\", or remove the pressure");
}

TEST(SceneMistakes, EquilibriumOfNecksThatCannotForm) {
  EXPECT_EQ(message_of(changed("[contact.sintering]\nmodel = \"viscoelastic\"\n", ""),
                       {"process.stop_when=all_necks_at_equilibrium"}),
            "--set process.stop_when=all_necks_at_equilibrium: there are no necks without [contact.sintering]; add it, "
            "or remove this key");
}

TEST(SceneMistakes, StepThatIsNotPositive) {
  EXPECT_EQ(mistake_added("fixed_step = \"0 s\"\n"),
            "scene.toml:38: integration.fixed_step: must be > 0 s, found \"0 s\"");
}

TEST(SceneMistakes, SafetyAboveOne) {
  EXPECT_EQ(mistake_added("step_safety = 1.2\n"),
            "scene.toml:38: integration.step_safety: must be > 0 and <= 1, found 1.2");
}

TEST(SceneMistakes, NegativeMassScaling) {
  EXPECT_EQ(mistake("mass_scaling = 1e17", "mass_scaling = -1e17"),
            "scene.toml:37: integration.mass_scaling: must be > 0, found -1e+17");
}

TEST(SceneMistakes, InertiaFreeWithFriction) {
  EXPECT_EQ(message_of(kGood, {"integration.method=inertia_free"}),
            "--set integration.method=inertia_free: \"inertia_free\" has no rotations, which [contact.friction] needs; "
            "remove it, or use method = \"explicit\"");
}

TEST(SceneMistakes, InertiaFreeSettingsOfAnExplicitRun) {
  EXPECT_EQ(mistake_added("inertia_free.force_tolerance = 0.01\n"),
            "scene.toml:38: integration.inertia_free: belongs to method = \"inertia_free\"; remove it, or set method");
}

TEST(SceneMistakes, TangentialShareAboveOne) {
  EXPECT_EQ(mistake_added("method = \"inertia_free\"\ninertia_free.tangential_share = 2\n"),
            "scene.toml:39: integration.inertia_free.tangential_share: must be > 0 and <= 1, found 2");
}

TEST(SceneMistakes, EqualisedInertiaWithoutAStep) {
  EXPECT_EQ(mistake("mass_scaling = 1e17", "inertia = \"equalised\""),
            "scene.toml:37: integration.inertia: equalised masses follow from a step; give inertia_measure (3e-3 is a "
            "good value) or fixed_step");
}

TEST(SceneMistakes, EqualisedInertiaWithTwoSteps) {
  EXPECT_EQ(mistake("mass_scaling = 1e17", "inertia = \"equalised\"\nfixed_step = \"1 s\"\ninertia_measure = 3e-3"),
            "scene.toml:38: integration.fixed_step: and inertia_measure both choose the step; remove one of them");
}

TEST(SceneMistakes, EqualisedInertiaWithMassScaling) {
  EXPECT_EQ(mistake_added("inertia = \"equalised\"\nfixed_step = \"1 s\"\n"),
            "scene.toml:37: integration.mass_scaling: has no meaning with inertia = \"equalised\", whose masses follow "
            "from the step; remove it");
}

TEST(SceneMistakes, MeasureOfUniformInertia) {
  EXPECT_EQ(mistake_added("inertia_measure = 3e-3\n"),
            "scene.toml:38: integration.inertia_measure: belongs to inertia = \"equalised\"; set that, or remove this "
            "key");
  EXPECT_EQ(mistake_added("smallest_step = \"1 ms\"\n"),
            "scene.toml:38: integration.smallest_step: belongs to inertia_measure; give that with inertia = "
            "\"equalised\", or remove this key");
}

TEST(SceneMistakes, MeasureOfInertiaThatIsNoShare) {
  EXPECT_EQ(mistake("mass_scaling = 1e17", "inertia = \"equalised\"\ninertia_measure = 3"),
            "scene.toml:38: integration.inertia_measure: must be > 0 and <= 1, found 3");
}

TEST(SceneMistakes, SmallestStepAboveTheLargest) {
  EXPECT_EQ(mistake("mass_scaling = 1e17",
                    "inertia = \"equalised\"\ninertia_measure = 3e-3\nlargest_step = \"1 s\"\nsmallest_step = \"2 s\""),
            "scene.toml:40: integration.smallest_step: is above largest_step; lower it");
}

TEST(SceneMistakes, AccuracyThatIsNoName) {
  EXPECT_EQ(mistake("mass_scaling = 1e17", "accuracy = \"refernce\""),
            "scene.toml:37: integration.accuracy: \"refernce\" is not among > 0 and <= 0.1, or \"draft\" = 0.01, or "
            "\"standard\" = 0.003, or \"reference\" = 0.001; did you mean \"reference\"?");
  EXPECT_EQ(mistake("mass_scaling = 1e17", "accuracy = 0.5"),
            "scene.toml:37: integration.accuracy: must be > 0 and <= 0.1, found 0.5");
}

TEST(SceneMistakes, AccuracyBesideWhatItChooses) {
  const auto refused = [](const std::string& message, const std::string& line, const std::string& other) {
    EXPECT_EQ(message,
              "scene.toml:" + line +
                  ": integration.accuracy: chooses masses and steps of equalised inertia itself, and so does " + other +
                  "; remove one of them");
  };
  refused(mistake_added("accuracy = 3e-3\n"), "38", "mass_scaling");
  refused(mistake("mass_scaling = 1e17", "accuracy = 3e-3\nfixed_step = \"1 s\""), "37", "fixed_step");
  refused(mistake("mass_scaling = 1e17", "accuracy = 3e-3\ninertia = \"uniform\""), "37", "inertia = \"uniform\"");
  refused(mistake("mass_scaling = 1e17", "accuracy = 3e-3\nmethod = \"inertia_free\""), "37",
          "method = \"inertia_free\"");
}

TEST(SceneMistakes, LoadOnANegativeParticle) {
  EXPECT_EQ(mistake_added("[[load]]\nparticle = -1\nforce = [\"1 N\", \"0 N\", \"0 N\"]\n"),
            "scene.toml:39: load.1.particle: must be >= 0 and <= 4294967295, found -1");
}

TEST(SceneMistakes, SceneThatIsNotThere) {
  try {
    densify::dem::read_scene("no/such/scene.toml", {});
    FAIL();
  } catch (const densify::InputError& e) {
    EXPECT_STREQ(e.what(), "no/such/scene.toml: there is no such scene file");
  }
}

TEST(SceneMistakes, OverlapOfMoreThanTheWholeParticle) {
  EXPECT_EQ(mistake_added("[guards]\nlargest_overlap = 2.5\n"),
            "scene.toml:39: guards.largest_overlap: must be > 0 and <= 2, found 2.5");
}
