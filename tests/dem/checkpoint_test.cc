#include "dem/io/checkpoint.h"

#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/check.h"
#include "tests/dem/scratch_folder.h"
#include "tests/dem/small_packings.h"

using namespace densify;
using namespace densify::dem;
using namespace densify::dem::testing;

namespace {

const CheckpointOwner owner{"scene 1", "0.1.0"};

struct Packing {
  const char* name;
  Setup (*make)(int threads);
};

void PrintTo(const Packing& packing, std::ostream* out) {
  *out << packing.name;
}

class EveryPacking : public ::testing::TestWithParam<Packing> {};

bool has_phase(const State& s, NeckPhase phase) {
  return std::any_of(s.contacts.neck.begin(), s.contacts.neck.end(), [&](const auto& h) { return h.phase == phase; });
}

}  // namespace

// The trajectory after a restart is that of the uninterrupted run, bit for bit, wherever it is cut: before activation,
// while necks activate, and later; the first cut is before any step.
TEST_P(EveryPacking, ContinuesBitForBit) {
  const ScratchFolder folder;
  Simulation whole(GetParam().make(1));
  bool pressed = false, activating = false, sintering = false;
  const std::size_t builds_before = whole.state().contacts.builds;
  for (const int cut : {0, 7, 40, 125, 200, 400}) {
    run_steps(whole, cut - int(whole.state().steps));
    pressed |= whole.contacts_now() > 20;
    activating |= has_phase(whole.state(), NeckPhase::activating);
    sintering |= has_phase(whole.state(), NeckPhase::sintering);
    write_checkpoint(folder / "c", whole, {}, owner);

    Simulation resumed(GetParam().make(1));
    read_checkpoint(folder / "c", resumed, owner);
    ASSERT_EQ(StateBits(resumed.state()), StateBits(whole.state())) << "cut " << cut;

    Simulation direct(GetParam().make(1));
    run_steps(direct, cut + 60);
    run_steps(resumed, 60);
    EXPECT_EQ(StateBits(resumed.state()), StateBits(direct.state())) << "cut " << cut;
  }
  // The cuts met what they are meant to meet.
  EXPECT_TRUE(pressed);
  EXPECT_TRUE(activating);
  EXPECT_TRUE(sintering);
  EXPECT_GT(whole.state().contacts.builds, builds_before + 1);
}

// A checkpoint may be continued with another number of threads.
TEST_P(EveryPacking, SameWithTwoThreads) {
  const ScratchFolder folder;
  Simulation one(GetParam().make(1)), two(GetParam().make(2));
  run_steps(one, 150);
  run_steps(two, 150);
  ASSERT_EQ(StateBits(one.state()), StateBits(two.state()));
  write_checkpoint(folder / "c", one, {}, owner);
  Simulation resumed(GetParam().make(2));
  read_checkpoint(folder / "c", resumed, owner);
  run_steps(one, 150);
  run_steps(resumed, 150);
  EXPECT_EQ(StateBits(one.state()), StateBits(resumed.state()));
}

INSTANTIATE_TEST_SUITE_P(Checkpoint, EveryPacking,
                         ::testing::Values(Packing{"periodic", periodic_packing}, Packing{"driven", driven_packing},
                                           Packing{"cylinder", cylinder_packing}, Packing{"closing", closing_packing},
                                           Packing{"closing_cylinder", closing_cylinder}),
                         [](const auto& test) { return test.param.name; });

// A run killed while it writes checkpoint after checkpoint leaves one that can be read.  The child reports its first
// one, so that every kill falls into later writing, at a different place each time.
TEST(Checkpoint, KilledWhileWriting) {
  const ScratchFolder folder;
  Simulation simulation(cylinder_packing(1));
  for (int round = 0; round < 20; ++round) {
    int report[2];
    ASSERT_EQ(::pipe(report), 0);
    const pid_t child = ::fork();
    ASSERT_GE(child, 0);
    if (child == 0) {
      for (RunPosition position;; ++position.snapshots) {
        write_checkpoint(folder / "c", simulation, position, owner);
        if (position.snapshots == 1 && ::write(report[1], "!", 1) != 1) ::_exit(1);
      }
    }
    char mark = 0;
    EXPECT_EQ(::read(report[0], &mark, 1), 1);
    ::usleep(useconds_t(700 * round));
    ::kill(child, SIGKILL);
    ::waitpid(child, nullptr, 0);
    ::close(report[0]);
    ::close(report[1]);
    EXPECT_GE(read_checkpoint(folder / "c", simulation, owner).snapshots, 1u);
  }
}

TEST(Checkpoint, CarriesThePositionOfTheRun) {
  const ScratchFolder folder;
  Simulation simulation(cylinder_packing(1));
  const RunPosition given{12, 3456, 7, 0.1 + 0.2, {1e-300, -0.0, 5}};
  write_checkpoint(folder / "c", simulation, given, owner);
  const RunPosition read = read_checkpoint(folder / "c", simulation, owner);
  EXPECT_EQ(read.history_rows, given.history_rows);
  EXPECT_EQ(read.history_bytes, given.history_bytes);
  EXPECT_EQ(read.snapshots, given.snapshots);
  EXPECT_EQ(read.wall_seconds, given.wall_seconds);
  EXPECT_EQ(read.numbers, given.numbers);
}

namespace {

/// Reading these bytes as a checkpoint: the message of the refusal; the simulation must stay as it was.
std::string refusal(const std::filesystem::path& path, const std::string& bytes, Simulation& simulation) {
  write_plainly(path, bytes);
  const StateBits before(simulation.state());
  const auto message = message_of<InputError>([&] { read_checkpoint(path, simulation, owner); });
  EXPECT_EQ(StateBits(simulation.state()), before);
  return message;
}

}  // namespace

// Truncated at any length and with any byte changed a file is refused; FNV-1a misses no single byte.
TEST(Checkpoint, DamagedFileRefused) {
  const ScratchFolder folder;
  Simulation simulation(cylinder_packing(1));
  run_steps(simulation, 120);
  write_checkpoint(folder / "c", simulation, {}, owner);
  const std::string good = content_of(folder / "c");
  run_steps(simulation, 1);
  const std::string damaged = "the checkpoint is not readable (truncated or damaged)";
  for (std::size_t length = 0; length < good.size(); length += 1 + length / 5)
    EXPECT_NE(refusal(folder / "d", good.substr(0, length), simulation).find(damaged), std::string::npos) << length;
  for (std::size_t cut : {good.size() - 1, good.size() - 100})
    EXPECT_NE(refusal(folder / "d", good.substr(0, cut), simulation).find(damaged), std::string::npos);
  EXPECT_NE(refusal(folder / "d", good + "x", simulation).find(damaged), std::string::npos);
  for (std::size_t at = 0; at < good.size(); at += 1 + at / 60) {
    std::string changed = good;
    changed[at] = char(changed[at] ^ (1 << (at % 8)));
    const auto message = refusal(folder / "d", changed, simulation);
    const bool in_format_number = at == std::string("Densify checkpoint, format ").size();
    // A changed format number may still be a number.
    const bool other_format = in_format_number && message.find("has format") != std::string::npos;
    EXPECT_TRUE(other_format || message.find(damaged) != std::string::npos) << at;
  }
  EXPECT_NE(refusal(folder / "d", "time_s,stage\n0,press\n", simulation).find(damaged), std::string::npos);
}

TEST(Checkpoint, MissingFileNamed) {
  const ScratchFolder folder;
  Simulation simulation(cylinder_packing(1));
  const auto message = message_of<InputError>([&] { read_checkpoint(folder / "c", simulation, owner); });
  EXPECT_NE(message.find("no checkpoint"), std::string::npos);
}

// Local densities in a scene whose pores do not resist are no state of it.
TEST(Checkpoint, LocalDensitiesOfNoPoreClosureRefused) {
  const ScratchFolder folder;
  Simulation closing(closing_packing(1)), open(driven_packing(1));
  run_steps(closing, 200);
  ASSERT_FALSE(closing.state().local_density.of.empty());
  write_checkpoint(folder / "c", closing, {}, owner);
  const auto message = message_of<InputError>([&] { read_checkpoint(folder / "c", open, owner); });
  EXPECT_NE(message.find("/state/local_density does not fit"), std::string::npos) << message;
}

TEST(Checkpoint, OfAnotherSceneRefused) {
  const ScratchFolder folder;
  Simulation simulation(cylinder_packing(1));
  write_checkpoint(folder / "c", simulation, {}, {"scene 2", "0.1.0"});
  const auto message = message_of<InputError>([&] { read_checkpoint(folder / "c", simulation, owner); });
  EXPECT_NE(message.find("belongs to another scene"), std::string::npos) << message;
}

// A state that does not fit is refused even when fingerprint and checksum are right: the other packing, another number
// of particles, histories that the scene does not have.
TEST(Checkpoint, UnfittingStateRefused) {
  const ScratchFolder folder;
  Simulation periodic(periodic_packing(1));
  run_steps(periodic, 120);
  write_checkpoint(folder / "c", periodic, {}, owner);
  dem::Setup without_friction = periodic_packing(1), without_necks = periodic_packing(1),
             one_more = periodic_packing(1);
  without_friction.contact.friction.reset();
  without_necks.contact.sintering.reset();
  one_more.particles.id.push_back(64);
  one_more.particles.body.push_back({Vec3::Zero(), 0, Vec3::Zero(), 0});
  one_more.particles.reference_radius.push_back(1e-7);
  one_more.particles.material.push_back(0);
  one_more.particles.angular_velocity.push_back(Vec3::Zero());
  for (dem::Setup* setup : {&without_friction, &without_necks, &one_more}) {
    Simulation other(std::move(*setup));
    EXPECT_THROW(read_checkpoint(folder / "c", other, owner), InputError);
  }
  Simulation cylinder(cylinder_packing(1));
  EXPECT_THROW(read_checkpoint(folder / "c", cylinder, owner), InputError);
}

// A header of a later format is read as far as to say so.
TEST(Checkpoint, OtherFormatNamed) {
  const ScratchFolder folder;
  Simulation simulation(cylinder_packing(1));
  write_checkpoint(folder / "c", simulation, {}, owner);
  std::string bytes = content_of(folder / "c");
  const auto at = bytes.find("format " + std::to_string(checkpoint_format));
  bytes[at + 7] = '9';
  EXPECT_NE(refusal(folder / "d", bytes, simulation).find("format 9"), std::string::npos);
}
