// The benchmark's own answers: what it simulates, what its force check finds, what it prints.

#include "app/bench.h"

#include <gtest/gtest.h>

#include "app/bench_job.h"
#include "base/check.h"
#include "base/data_path.h"

namespace densify::app {
namespace {

std::filesystem::path packing(const std::string& name) {
  return data_path("benchmark/packings/" + name + ".data");
}

dem::Simulation simulation(BenchCase c, int threads) {
  return dem::Simulation(bench_setup({"p1751", c, threads, 0}, packing("p1751")));
}

// Solid fraction of the file's spheres: 1751 of mean diameter 1 fill 0.76 of the cube.
TEST(Bench, PackingIsWhatTheReadmeSays) {
  const auto sim = simulation(BenchCase::A, 1);
  EXPECT_EQ(sim.state().particles.size(), 1751u);
  EXPECT_NEAR(sim.solid_volume() / sim.state().cell.volume(), 0.76, 1e-3);
  EXPECT_NEAR(2.0 * double(sim.contacts_now()) / 1751, 5.24, 0.02);
}

// c = 2 xi sqrt(m k) must be 250 1/s times the reduced mass pi/12 of two mean particles, k = 1e5.
TEST(Bench, DamperIsThatOfThePeers) {
  const auto setup = bench_setup({"m2k", BenchCase::B, 1, 0}, packing("m2k"));
  const double m = 0.2617993878, xi = setup.contact.damping_ratio;
  EXPECT_NEAR(2 * xi * std::sqrt(m * 1e5), 250 * m, 1e-9);
  const auto& f = *setup.contact.friction;
  EXPECT_NEAR(2 * f.tangential_damping_ratio * std::sqrt(m * f.tangential_stiffness_ratio * 1e5), 125 * m, 1e-9);
}

// The pass agrees with the plain double loop to rounding, on one thread and on two, after steps that move the lists.
TEST(Bench, ForcesAgreeWithThePlainLoop) {
  for (const BenchCase c : {BenchCase::A, BenchCase::B, BenchCase::S})
    for (int threads : {1, 2}) {
      auto sim = simulation(c, threads);
      for (int step = 0; step < 5; ++step) sim.advance(nullptr);
      EXPECT_LT(force_deviation(sim), 1e-11) << int(c) << " " << threads;
    }
}

// The check sees one contact that the list has lost, by about its own force over the largest.
TEST(Bench, ForceCheckSeesALostContact) {
  auto sim = simulation(BenchCase::A, 1);
  sim.advance(nullptr);
  auto& list = sim.mutable_state().contacts;
  const auto& body = sim.state().particles.body;
  for (std::size_t k = 0; k < list.size(); ++k) {
    const double reach = body[list.i(k)].radius + body[list.j(k)].radius;
    if (list.image(k) != dem::ImageCode::none) continue;
    if ((body[list.i(k)].position - body[list.j(k)].position).norm() > 0.999 * reach) continue;
    list.first.erase(list.first.begin() + std::ptrdiff_t(k));
    list.second.erase(list.second.begin() + std::ptrdiff_t(k));
    --list.buckets.back().end;
    break;
  }
  auto damaged = sim.state();
  sim.restore(std::move(damaged));
  EXPECT_GT(force_deviation(sim), 1e-6);
}

TEST(Bench, JsonHasItsKeys) {
  BenchResult r;
  r.packing = "m2k";
  r.benchmark.assign(1, 'B');
  r.particles = 2000;
  r.ns_per_contact_step = 12.3456;
  const std::string json = to_json(r);
  for (const char* key : {"packing", "case", "particles", "coordination_number", "ns_per_contact_step",
                          "particle_steps_per_s", "bytes_per_particle", "list_builds", "force_check"}) {
    std::string quoted(1, '"');
    quoted += key;
    quoted += "\": ";
    EXPECT_NE(json.find(quoted), std::string::npos) << key;
  }
  EXPECT_NE(json.find("\"ns_per_contact_step\": 12.346,"), std::string::npos) << json;
  EXPECT_EQ(json.front(), '{');
  EXPECT_EQ(json.back(), '}');
}

TEST(Bench, UnknownNamesAreRefused) {
  BenchOptions options;
  options.packings = {"m2l"};
  try {
    bench_command(options);
    FAIL() << "accepted";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("did you mean \"m2k\""), std::string::npos) << error.what();
  }
  options.packings = {"m2k"};
  options.cases = {"C"};
  EXPECT_THROW(bench_command(options), InputError);
  options.cases = {"A"};
  options.threads = 0;
  EXPECT_THROW(bench_command(options), InputError);
}

}  // namespace
}  // namespace densify::app
