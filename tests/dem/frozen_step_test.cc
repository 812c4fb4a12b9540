// The step of a contact with its neck frozen against the law's own update.

#include <gtest/gtest.h>

#include "dem/network/network.h"
#include "tests/support/law_driver.h"

namespace densify::dem {
namespace {

constexpr double k_n = 1e5;

// frozen_step is what `update` with backward Euler makes of a linear spring, at any step: the force at no rate, and the
// slope by the rate of a neck free of stress (whose growth then moves nothing), by differences over a rate that grows
// the neck by 1e-9 of itself.  Up to 1000 relaxation times, where the update loses four digits to a difference.
TEST(FrozenStep, AgainstUpdate) {
  constexpr test::DriverPair pair{5e-6, 1e-3};
  for (double xi : {0.0, 0.4}) {
    SinteringSettings settings;
    settings.damping_ratio = xi;
    const double a = 0.5 * pair.radius, eta = 1e3;
    const SinteringContact<LinearSpring> law{{{k_n}, 0}, settings, a * a * a * a / eta, 1.5, 2.8, 0.95, true, false};
    for (double h : {1e-8, 1e-4, 1e-2, 1.0, 10.0})
      for (auto phase : {NeckPhase::sintering, NeckPhase::bonded}) {
        auto force = [&](double stored, double rate) {
          NeckHistory neck{a, stored, 0, phase};
          NormalInput in = test::driver_input(pair, -1e-7, rate * h, h, h);
          const NormalForce f = law.update(in, neck);
          return f.total - f.sintering;  // F_sint follows the neck
        };
        auto linear = [&](double stored) {
          Linearisation l = law.linearise(test::driver_input(pair, -1e-7, 0, 0, h), {a, stored, 0, phase});
          l.active = 0;
          return frozen_step(l, h);
        };
        EXPECT_NEAR(force(-3e-9, 0) / linear(-3e-9).force, 1, 1e-11) << h;
        const double rate = 1e-9 * a * a / (2 * pair.radius * h);
        EXPECT_NEAR((force(0, rate) - force(0, -rate)) / (2 * rate) / linear(0).coefficient, 1, 1e-6) << h;
      }
  }
  EXPECT_EQ(frozen_step({std::numeric_limits<double>::infinity(), 0, 7, 3, 9}, 0.1).coefficient, 7);
}

}  // namespace
}  // namespace densify::dem
