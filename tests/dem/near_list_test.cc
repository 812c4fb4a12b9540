// The near list is a matter of cost alone: with a fresh one before every step the trajectory is the same bit for bit.

#include "dem/contact/near_list.h"

#include <gtest/gtest.h>

#include "tests/dem/small_packings.h"

namespace densify::dem {
namespace {

// A fast mixture of touching, parting and necking pairs in a shearing cell and in a heated die: one run as always,
// another that forgets its near list before each step.
TEST(NearList, ChangesNoResult) {
  for (const bool periodic : {true, false})
    for (int threads : {1, 2}) {
      Simulation kept(periodic ? testing::periodic_packing(threads) : testing::cylinder_packing(threads));
      Simulation fresh(periodic ? testing::periodic_packing(threads) : testing::cylinder_packing(threads));
      for (auto* sim : {&kept, &fresh})
        for (auto& b : sim->mutable_state().particles.body) b.velocity *= 100;
      for (int step = 0; step < (threads == 1 ? 1500 : 30); ++step) {
        kept.advance(nullptr);
        fresh.restore(State(fresh.state()));
        fresh.advance(nullptr);
      }
      for (std::size_t p = 0; p < kept.state().particles.size(); ++p) {
        ASSERT_EQ(kept.state().particles.body[p].position, fresh.state().particles.body[p].position) << p;
        ASSERT_EQ(kept.state().particles.angular_velocity[p], fresh.state().particles.angular_velocity[p]) << p;
      }
      EXPECT_EQ(kept.state().contacts.builds, fresh.state().contacts.builds);
      if (threads == 1) {
        EXPECT_GT(kept.state().contacts.builds, 3u);
      }
    }
}

// What is left out is farther apart than the near skin.
TEST(NearList, LeavesOutOnlyWhatIsFar) {
  auto setup = testing::periodic_packing(1);
  setup.integration.skin = 1;  // reaches the second neighbours of the lattice
  Simulation sim(setup);
  State state = sim.state();
  auto& list = state.contacts;
  NearList near;
  EXPECT_TRUE(near.empty());
  near.prune(list, state.particles, state.cell, 1);
  EXPECT_LT(near.places().size(), list.size());
  EXPECT_GT(near.places().size(), 0u);
  EXPECT_GT(near.skin(), 0);
  EXPECT_LT(near.skin(), list.skin);
  std::size_t next = 0;
  for (std::uint32_t k = 0; k < list.size(); ++k) {
    const bool kept = next < near.places().size() && near.places()[next] == k;
    next += kept;
    const Body &a = state.particles.body[list.i(k)], &b = state.particles.body[list.j(k)];
    const double gap =
        (b.position - a.position + state.cell.shift(list.image(k))).norm() - a.radius - b.radius - near.skin();
    EXPECT_EQ(kept, gap < 0) << k;
  }
  NearList on_three_threads;
  on_three_threads.prune(list, state.particles, state.cell, 3);
  EXPECT_EQ(on_three_threads.places(), near.places());
  EXPECT_EQ(on_three_threads.bucket_end(), near.bucket_end());
}

// Particles at rest use up no skin; what served long enough is pruned again with half of it, until it is as narrow as
// it gets.
TEST(NearList, NarrowsWhileNothingMoves) {
  Simulation sim(testing::periodic_packing(1));
  State state = sim.state();
  NearList near;
  near.prune(state.contacts, state.particles, state.cell, 1);
  const double widest = near.skin();
  int prunings = 0;
  for (int pass = 0; pass < 10000; ++pass) {
    near.count_pass();
    if (!near.too_wide()) continue;
    const double before = near.skin();
    near.prune(state.contacts, state.particles, state.cell, 1);
    EXPECT_EQ(near.skin(), 0.5 * before);
    ++prunings;
  }
  EXPECT_EQ(prunings, 4);
  EXPECT_EQ(near.skin(), widest / 16);
}

}  // namespace
}  // namespace densify::dem
