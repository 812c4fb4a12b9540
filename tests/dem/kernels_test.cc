// The contact kernels of every instruction set, passes that keep a record, and every number of threads give the same
// results bit for bit: all do the same IEEE operations in the same order.

#include <gtest/gtest.h>

#include <bit>
#include <cstdint>
#include <cstdlib>

#include "base/check.h"
#include "dem/contact/kernel.h"
#include "tests/dem/small_packings.h"

namespace densify::dem {
namespace {

using testing::StateBits;

/// Sets the variable for as long as it lives.
class Instructions {
 public:
  explicit Instructions(const char* name) { setenv("DENSIFY_INSTRUCTIONS", name, 1); }
  ~Instructions() { unsetenv("DENSIFY_INSTRUCTIONS"); }
};

struct Variant {
  const char* name;
  void (*change)(Setup&);
};

const Variant variants[] = {
    {"friction, Hertz, sintering", [](Setup&) {}},
    {"without friction", [](Setup& s) { s.contact.friction.reset(); }},
    {"linear",
     [](Setup& s) {
       s.contact.elasticity = Elasticity::linear;
       s.contact.normal_stiffness = 1e5;
       s.contact.friction->tangential_damping_ratio = 0.2;
     }},
    {"loose", [](Setup& s) { s.contact.sintering.reset(); }},
    {"loose, linear, without friction",
     [](Setup& s) {
       s.contact.sintering.reset();
       s.contact.friction.reset();
       s.contact.elasticity = Elasticity::linear;
       s.contact.normal_stiffness = 1e5;
     }},
    {"trapezoidal, smaller radius, neck of the overlap",
     [](Setup& s) {
       s.contact.sintering->update = MaxwellUpdate::trapezoidal;
       s.contact.sintering->radius = SinteringRadius::smaller;
       s.contact.sintering->neck = NeckGrowth::overlap;
       s.contact.hertz_radius = HertzRadius::equivalent;
     }},
    {"viscous at equilibrium", [](Setup& s) { s.contact.sintering->at_equilibrium = AtEquilibrium::viscous; }},
    {"no transition", [](Setup& s) { s.contact.sintering->relaxation_time = 0; }},
    {"undamped",
     [](Setup& s) {
       s.contact.damping_ratio = 0;
       s.contact.sintering->damping_ratio = 0;
     }},
};

/// A run through activation, with necks in several phases.
State end_of(Setup setup, int steps) {
  Simulation sim(std::move(setup));
  for (int k = 0; k < steps; ++k) sim.advance();
  return sim.state();
}

struct Recorded {
  StateBits end;
  std::vector<std::uint64_t> contact;  ///< the bits of every contact's record
  bool operator==(const Recorded&) const = default;
};

/// The same run, recorded at every step; the records of every 20th are kept.
Recorded recorded_run(Setup setup, int steps) {
  Simulation sim(std::move(setup));
  Recording recording;
  std::vector<std::uint64_t> contact;
  for (int k = 0; k < steps; ++k) {
    sim.advance(&recording);
    if (k % 20 != 0) continue;
    for (const auto& r : recording.contact)
      for (double x : {r.force[0], r.force[1], r.force[2], r.normal, r.couple[0], r.couple[1], r.couple[2], r.sintering,
                       r.lever_i, r.lever_j, r.damping, r.elastic_energy, double(r.touching)})
        contact.push_back(std::bit_cast<std::uint64_t>(x));
  }
  return {StateBits(sim.state()), std::move(contact)};
}

TEST(Kernels, EveryInstructionSetGivesTheSameBits) {
  ASSERT_STREQ(available_kernels().front().name, "baseline");
  for (const bool periodic : {true, false})
    for (const auto& variant : variants) {
      auto setup = periodic ? testing::periodic_packing(1) : testing::cylinder_packing(1);
      variant.change(setup);
      std::vector<StateBits> ends;
      std::vector<Recorded> recorded;
      for (const auto& kernels : available_kernels()) {
        const Instructions chosen(kernels.name);
        ends.emplace_back(end_of(setup, 400));
        recorded.push_back(recorded_run(setup, 400));
      }
      ASSERT_GT(recorded[0].contact.size(), 10'000u);
      for (std::size_t k = 0; k < ends.size(); ++k) {
        EXPECT_EQ(ends[k], ends[0]) << variant.name;
        EXPECT_EQ(recorded[k].end, ends[0]) << variant.name << ", recorded";
        EXPECT_TRUE(recorded[k].contact == recorded[0].contact) << variant.name << ", records";
      }
    }
}

// 1000 particles are in several chunks, whose sums cross their borders.
TEST(Kernels, ThreadsAndChunksGiveTheSameBits) {
  auto packing = [](int threads) {
    auto s = testing::common_setup(threads);
    testing::add_lattice(s, {10, 10, 10}, 4e-6, Vec3::Zero(), 1);
    s.container.shape = ContainerShape::periodic;
    s.cell.periodic = true;
    s.cell.h = 40e-6 * Mat3::Identity();
    s.cell.velocity_gradient << -0.02, 0.05, 0, 0, -0.02, 0, 0, 0, -0.03;
    return s;
  };
  const StateBits one(end_of(packing(1), 120));
  for (int threads : {2, 3}) EXPECT_EQ(StateBits(end_of(packing(threads), 120)), one) << threads;
  const Recorded recorded = recorded_run(packing(1), 120);
  EXPECT_EQ(recorded.end, one) << "recorded";
  EXPECT_TRUE(recorded_run(packing(2), 120) == recorded) << "recorded";
}

TEST(Kernels, UnknownInstructionSetIsRefused) {
  const Instructions chosen("avx3");
  try {
    chosen_kernels();
    FAIL() << "accepted";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("they have baseline"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace densify::dem
