#include "dem/io/result_file.h"

#include "base/check.h"
#include "dem/io/hdf5_file.h"
#include "tests/dem/scratch_folder.h"
#include "tests/dem/small_packings.h"

using namespace densify;
using namespace densify::dem;
using namespace densify::dem::testing;

namespace {

const RunDescription description{"temperature = \"20 °C\"\n", "0.1.0", "abc123", {{"time_s", "s"}, {"stage", ""}}};

/// A snapshot of the present state; leaves the simulation as it was.
Snapshot shoot(Simulation& simulation) {
  const State before = simulation.state();
  Recording recording;
  simulation.evaluate(&recording);
  Snapshot shot = take_snapshot(simulation, recording,
                                {before.time, simulation.temperature(), simulation.pressure(), 0.7, "press"});
  simulation.restore(before);
  return shot;
}

void expect_equal(const Hdf5Reader& file, const std::string& group, const Snapshot& s) {
  EXPECT_EQ(file.attribute<double>(group, "time"), s.moment.time);
  EXPECT_EQ(file.attribute<std::string>(group, "stage"), s.moment.stage);
  EXPECT_EQ(file.read<std::uint32_t>(group + "/particles/id"), s.id);
  EXPECT_EQ(file.read<double>(group + "/particles/radius"), s.radius);
  EXPECT_EQ(file.shape(group + "/particles/stress").columns, 6u);
  EXPECT_EQ(file.read<std::uint32_t>(group + "/contacts/first_id"), s.first_id);
  EXPECT_EQ(file.read<double>(group + "/contacts/normal_force"), s.normal_force);
}

}  // namespace

// Taking snapshots never changes the trajectory.
TEST(ResultFile, SnapshotsLeaveTheTrajectoryAlone) {
  for (auto make : {periodic_packing, cylinder_packing}) {
    Simulation watched(make(1)), alone(make(1));
    for (int part = 0; part < 10; ++part) {
      shoot(watched);
      run_steps(watched, 20);
      run_steps(alone, 20);
    }
    EXPECT_EQ(StateBits(watched.state()), StateBits(alone.state()));
  }
}

// While running: snapshots through links; when complete: all in one file, byte for byte that of a resumed run.
TEST(ResultFile, LinkedThenGathered) {
  const ScratchFolder folder;
  Simulation simulation(periodic_packing(1));
  run_steps(simulation, 130);
  std::vector<Snapshot> shots;
  for (int s = 0; s < 3; ++s) {
    shots.push_back(shoot(simulation));
    run_steps(simulation, 20);
  }
  std::filesystem::create_directory(folder / "a");
  auto history = HistoryFile::create(folder / "a/history.csv", description.history_columns);
  history.add_row(std::array{0.25}, "press");
  ResultFile whole(folder / "a", description, 0);
  for (const auto& s : shots) whole.add_snapshot(s);
  {
    const Hdf5Reader file(whole.path());
    EXPECT_EQ(file.attribute<std::uint64_t>("/", "complete"), 0u);
    EXPECT_FALSE(file.has_own("/snapshots/000002"));
    for (std::size_t s = 0; s < 3; ++s) expect_equal(file, "/snapshots/" + six_digits(s), shots[s]);
  }
  std::filesystem::copy(folder / "a", folder / "b", std::filesystem::copy_options::recursive);
  whole.consolidate(ResultFile::usual_largest);
  EXPECT_FALSE(std::filesystem::exists(folder / "a/snapshots"));
  const Hdf5Reader file(whole.path());
  EXPECT_EQ(file.attribute<std::uint64_t>("/", "complete"), 1u);
  EXPECT_EQ(file.text("/effective_input"), description.effective_input);
  EXPECT_EQ(file.attribute<std::string>("/", "git_revision"), "abc123");
  EXPECT_EQ(file.read<double>("/history/time_s"), std::vector<double>{0.25});
  EXPECT_EQ(file.attribute<std::string>("/history/time_s", "unit"), "s");
  EXPECT_EQ(file.texts("/history/stage"), std::vector<std::string>{"press"});
  for (std::size_t s = 0; s < 3; ++s) expect_equal(file, "/snapshots/" + six_digits(s), shots[s]);

  ResultFile resumed(folder / "b", description, 2);
  EXPECT_FALSE(Hdf5Reader(resumed.path()).has("/snapshots/000002"));
  EXPECT_FALSE(std::filesystem::exists(folder / "b/snapshots/000002.h5"));
  resumed.add_snapshot(shots[2]);
  resumed.consolidate(ResultFile::usual_largest);
  EXPECT_EQ(content_of(resumed.path()), content_of(whole.path()));
}

// Killed while the gathered snapshots' files were being removed: they come back out of result.h5.
TEST(ResultFile, ResumeAfterAKillWhileGathering) {
  const ScratchFolder folder;
  Simulation simulation(cylinder_packing(1));
  const Snapshot shot = shoot(simulation);
  {
    ResultFile file(folder.path(), description, 0);
    file.add_snapshot(shot);
    file.add_snapshot(shot);
    file.consolidate(ResultFile::usual_largest);
  }
  ResultFile file(folder.path(), description, 1);
  expect_equal(Hdf5Reader(file.path()), "/snapshots/000000", shot);
  std::filesystem::remove(folder / "snapshots/000000.h5");
  EXPECT_NE(message_of<InputError>([&] { ResultFile(folder.path(), description, 1); }).find("missing"),
            std::string::npos);
}

// Results that would not fit into the memory are complete with snapshots in files of their own.
TEST(ResultFile, LargeResultsStayLinked) {
  const ScratchFolder folder;
  Simulation simulation(cylinder_packing(1));
  const Snapshot shot = shoot(simulation);
  ResultFile file(folder.path(), description, 0);
  file.add_snapshot(shot);
  file.consolidate(1000);
  const Hdf5Reader read(file.path());
  EXPECT_EQ(read.attribute<std::uint64_t>("/", "complete"), 1u);
  EXPECT_FALSE(read.has_own("/snapshots/000000"));
  expect_equal(read, "/snapshots/000000", shot);
}

// What a scene leaves out has no array in the file.
TEST(ResultFile, OnlyFeaturesInUse) {
  const ScratchFolder folder;
  dem::Setup plain = cylinder_packing(1);
  plain.contact.friction.reset();
  plain.contact.sintering.reset();
  Simulation cylinder(std::move(plain)), periodic(periodic_packing(1));
  run_steps(periodic, 150);
  ResultFile file(folder.path(), description, 0);
  file.add_snapshot(shoot(cylinder));
  file.add_snapshot(shoot(periodic));
  const Hdf5Reader read(file.path());
  for (const char* name : {"particles/angular_velocity", "contacts/tangential_force", "contacts/neck_radius",
                           "contacts/sintering_force", "contacts/phase", "contacts/image", "cell"}) {
    EXPECT_FALSE(read.has(std::string("/snapshots/000000/") + name)) << name;
    EXPECT_TRUE(read.has(std::string("/snapshots/000001/") + name)) << name;
  }
  EXPECT_EQ(read.texts("/snapshots/000000/walls/name"), (std::vector<std::string>{"die", "bottom", "punch"}));
  EXPECT_EQ(read.shape("/snapshots/000000/walls/force").rows, 3u);
  EXPECT_FALSE(read.has("/snapshots/000001/walls"));
}

// Two spheres pressed together with force F along x: sigma_xx = -F s / V with s from the centre to the contact point,
// nothing else (6.5).  F and s are read from the recording, where |F| is the recorded normal force.
TEST(Snapshot, StressOfAPressedPair) {
  dem::Setup setup = cylinder_packing(1);
  setup.container.shape = ContainerShape::free;
  setup.contact.friction.reset();
  setup.particles = {};
  for (int p = 0; p < 2; ++p) {
    setup.particles.body.push_back({Vec3(p == 0 ? 1.98e-6 : 0, 0, 0), 0, Vec3::Zero(), 0});
    setup.particles.reference_radius.push_back(1e-6);
    setup.particles.material.push_back(0);
    setup.particles.id.push_back(std::uint32_t(1 - p));
  }
  Simulation simulation(std::move(setup));
  const Snapshot s = shoot(simulation);
  EXPECT_EQ(s.id, (std::vector<std::uint32_t>{0, 1}));
  EXPECT_EQ(s.position[0], Vec3(0, 0, 0));  // sorted by id, whatever the order in memory
  ASSERT_EQ(s.normal_force.size(), 1u);
  const double r = s.radius[0], volume = 4.0 / 3 * M_PI * r * r * r, arm = 0.99e-6;
  EXPECT_NEAR(s.overlap[0], 1.98e-6 - 2 * r, 1e-20);
  EXPECT_LT(s.normal_force[0], 0);
  for (std::size_t p = 0; p < 2; ++p) {
    EXPECT_NEAR(s.stress[p][0], s.normal_force[0] * arm / volume, 1e-12 * std::abs(s.stress[p][0]));
    for (int c = 1; c < 6; ++c) EXPECT_EQ(s.stress[p][c], 0) << c;
    EXPECT_EQ(s.coordination[p], 1u);
  }
}
