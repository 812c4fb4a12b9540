// Output never changes the trajectory, and a feature that a scene leaves out has no arrays, columns or datasets.

#include <gtest/gtest.h>

#include "base/check.h"
#include "dem/history_row.h"
#include "dem/io/checkpoint.h"
#include "dem/io/hdf5_file.h"
#include "dem/io/state_image.h"
#include "dem/run.h"
#include "tests/dem/scratch_folder.h"
#include "tests/dem/small_packings.h"

using namespace densify;
using namespace densify::dem;
using densify::dem::testing::content_of;
using densify::dem::testing::message_of;
using densify::dem::testing::ScratchFolder;
using densify::dem::testing::write_plainly;

namespace {

const std::filesystem::path kScenes = DENSIFY_TEST_SCENES;

Scene lattice(std::vector<std::string> overrides) {
  // A shorter process than the file's: press, heat beyond activation, a little cooling.
  for (const char* shorter : {"process.stage.1.duration=100 s", "process.stage.2.rate=300 K/min",
                              "process.stage.3.temperature=1250 degC", "output.visualisation=false"})
    overrides.insert(overrides.begin(), shorter);
  return read_scene(kScenes / "lattice.toml", overrides);
}

/// The lattice without a section of its text.
Scene lattice_without(const ScratchFolder& folder, const std::string& section) {
  std::string text = content_of(kScenes / "lattice.toml");
  const std::size_t begin = text.find(section), end = text.find("\n[", begin);
  EXPECT_NE(begin, text.npos);
  write_plainly(folder / "scene.toml", text.erase(begin, end - begin + 1));
  write_plainly(folder / "lattice.csv", content_of(kScenes / "lattice.csv"));
  return read_scene(folder / "scene.toml", {"output.visualisation=false", "process.stage.1.duration=100 s",
                                            "process.stage.2.rate=300 K/min", "process.stage.3.rate=300 K/min"});
}

void run_in(const Scene& scene, const std::filesystem::path& folder) {
  RunOptions options;
  options.folder = folder;
  options.version = "test";
  run(scene, options);
}

/// Every number of the final state of a run, as bytes.
std::string final_state(const Scene& scene, const std::filesystem::path& folder) {
  Simulation sim(make_setup(scene, read_specimen(folder / "specimen.h5"), 1));
  read_checkpoint(folder / "checkpoint.h5", sim, {fingerprint(scene), "test"});
  EXPECT_EQ(sim.state().time, scene.schedule.end());
  Hdf5Writer image(folder / "compared.h5");
  write_state(image, sim.state());
  return image.image();
}

Simulation simulation_of(const Scene& scene) {
  return Simulation(make_setup(scene, make_specimen(scene, 1, {}), 1));
}

bool has_column(const Scene& scene, const std::string& part) {
  for (const auto& c : history_columns(simulation_of(scene).setup()))
    if (c.name.find(part) != c.name.npos) return true;
  return false;
}

}  // namespace

// Rows, snapshots and checkpoints at other times, or hardly any: bit for bit the same final state.
TEST(Run, OutputNeverChangesTheTrajectory) {
  const ScratchFolder folder;
  const Scene plain = lattice({});
  run_in(plain, folder / "plain");
  const std::string state = final_state(plain, folder / "plain");
  int number = 0;
  for (const std::vector<std::string>& output :
       {std::vector<std::string>{"output.history_interval=1e-30 s"},
        std::vector<std::string>{"output.history_interval=1 h", "output.snapshot_interval=1 h"},
        std::vector<std::string>{"output.snapshot_interval=10 s", "output.visualisation=true",
                                 "output.stress_fields=true"},
        std::vector<std::string>{"output.checkpoint_interval=10 ms", "title=another"}}) {
    const Scene scene = lattice(output);
    const auto place = folder / std::to_string(number++);
    run_in(scene, place);
    EXPECT_TRUE(final_state(scene, place) == state) << output.front();
  }
}

TEST(Run, WithoutFrictionNothingRotates) {
  const ScratchFolder folder;
  const Scene scene = lattice_without(folder, "[contact.friction]");
  Simulation sim = simulation_of(scene);
  while (sim.state().time < 200) sim.advance();
  EXPECT_TRUE(sim.state().particles.angular_velocity.empty());
  EXPECT_TRUE(sim.state().particles.torque.empty());
  EXPECT_TRUE(sim.state().contacts.tangential.empty());
  run_in(scene, folder / "run");
  const Hdf5Reader result(folder / "run/result.h5");
  EXPECT_TRUE(result.has("/snapshots/000001/contacts/normal_force"));
  EXPECT_FALSE(result.has("/snapshots/000001/contacts/tangential_force"));
  EXPECT_FALSE(result.has("/snapshots/000001/particles/angular_velocity"));
}

TEST(Run, WithoutPoreClosureThereAreNoLocalDensities) {
  const ScratchFolder folder;
  EXPECT_FALSE(has_column(lattice({}), "local_density"));
  run_in(lattice({}), folder / "open");
  const Scene closing = lattice({"contact.sintering.pore_closure.porosity=0.3"});
  EXPECT_TRUE(has_column(closing, "local_density"));
  run_in(closing, folder / "closing");
  for (const bool is_closing : {false, true}) {
    const Hdf5Reader result(folder / (is_closing ? "closing/result.h5" : "open/result.h5"));
    EXPECT_EQ(result.has("/snapshots/000003/particles/local_density"), is_closing);
    EXPECT_EQ(result.has("/snapshots/000003/contacts/flow_share"), is_closing);
  }
}

TEST(Run, EnergiesOnlyWhereAskedFor) {
  const auto columns = [](bool energies) {
    dem::Setup s = dem::testing::driven_packing(1);
    s.energies = energies;
    std::size_t count = 0;
    for (const auto& c : history_columns(s)) count += c.name.ends_with("_J");
    return count;
  };
  EXPECT_EQ(columns(false), 0u);
  EXPECT_EQ(columns(true), 10u);
}

TEST(Run, WithoutSinteringThereAreNoNecks) {
  const ScratchFolder folder;
  const Scene scene = lattice_without(folder, "[contact.sintering]");
  Simulation sim = simulation_of(scene);
  while (!sim.finished()) sim.advance();
  EXPECT_TRUE(sim.state().contacts.neck.empty());
  EXPECT_FALSE(has_column(scene, "neck"));
  EXPECT_FALSE(has_column(scene, "sintering"));
  run_in(scene, folder / "run");
  const Hdf5Reader result(folder / "run/result.h5");
  for (const char* name : {"neck_radius", "sintering_force", "elastic_displacement", "phase"})
    EXPECT_FALSE(result.has(std::string("/snapshots/000003/contacts/") + name)) << name;
  EXPECT_TRUE(has_column(lattice({}), "neck"));
}

// Before activation no contact carries a neck, though the scene has sintering.
TEST(Run, NoNecksBeforeActivation) {
  Simulation sim = simulation_of(lattice({}));
  while (sim.state().time < 100) sim.advance();
  EXPECT_TRUE(sim.state().contacts.neck.empty());
  while (!sim.finished()) sim.advance();
  EXPECT_FALSE(sim.state().contacts.neck.empty());
}

TEST(Run, RadiiAreLeftAloneAtConstantTemperature) {
  Simulation sim = simulation_of(lattice({}));
  sim.advance();
  Body& body = sim.mutable_state().particles.body[3];
  const double untouched = body.radius *= 1 - 1e-9;  // a mark that an evaluation of (4.17) would wipe out
  while (sim.state().time < 90) sim.advance();       // loading, at 20 degC
  EXPECT_EQ(sim.state().particles.body[3].radius, untouched);
  while (sim.state().time < 110) sim.advance();  // heating
  EXPECT_GT(sim.state().particles.body[3].radius, untouched);
}

// A velocity that is not finite, however it came about, stops the next evaluation with the particle's number.
TEST(Run, NonFiniteStateStopsTheStep) {
  Simulation sim = simulation_of(lattice({}));
  for (int step = 0; step < 10; ++step) sim.advance();
  auto& particles = sim.mutable_state().particles;
  particles.body[7].velocity[1] = unset;
  const std::string message = message_of<RunError>([&] {
    for (int step = 0; step < 3; ++step) sim.advance();
  });
  EXPECT_NE(message.find("particle " + std::to_string(particles.id[7]) + " "), message.npos) << message;
}

// A specimen that is not the run's is found out before it is made to fit: the checkpoint names the scene.
TEST(Run, ResumeLooksAtTheSceneFirst) {
  const ScratchFolder folder;
  run_in(lattice({}), folder / "run");
  const Scene other = lattice({"specimen.size=[\"8 um\", \"12 um\", \"12 um\"]"});
  RunOptions options;
  options.folder = folder / "run";
  options.mode = Continue::resume;
  EXPECT_NE(message_of<InputError>([&] { run(other, options); }).find("belongs to another scene"), std::string::npos);
}

// Hundreds of rows at a time fall on one step, or none ever: an interval may have any length.
TEST(Run, ShortestIntervalIsOneRowAStep) {
  const ScratchFolder folder;
  const Scene scene = lattice({"output.history_interval=1e-300 s"});
  run_in(scene, folder / "run");
  const History history = read_history(folder / "run/history.csv");
  const auto steps = std::find(history.columns.begin(), history.columns.end(), "steps") - history.columns.begin();
  ASSERT_LT(std::size_t(steps), history.columns.size());
  EXPECT_EQ(double(history.stage.size()), history.values[std::size_t(steps)].back() + 1);
}
