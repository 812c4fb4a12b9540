#include <gtest/gtest.h>

#include "dem/contact/force_pass.h"
#include "dem/law/friction.h"
#include "tests/support/law_driver.h"

namespace densify::dem {
namespace {

using test::driver_input;
using test::DriverPair;

constexpr DriverPair pair{5e-6, 1e-3};
constexpr double stiffness = 1e5;

SinteringContact<LinearSpring> linear_law(double viscosity_of_half_radius_neck) {
  SinteringSettings settings;
  settings.damping_ratio = 0;
  const double a = 0.5 * pair.radius;
  return {{{stiffness}, 0}, settings, a * a * a * a / viscosity_of_half_radius_neck, 1.5, 2.8, 0.95, true, false};
}

SinteringContact<HertzSpring> hertz_law(double viscosity_of_half_radius_neck) {
  const auto l = linear_law(viscosity_of_half_radius_neck);
  return {{{2e11, 3e-4}, 0}, l.settings, l.mobility_factor, l.surface_energy, l.cap, l.sine, true, false};
}

// (4.15), (4.18): force, tangent and stored energy of each spring agree with each other by central differences; the
// inverse inverts.  The difference over h = 1e-6 u has an error of about 1e-10 with Hertz.
template <class Spring>
void check_spring(const Spring& s, double u) {
  const double h = 1e-6 * std::abs(u), r = 2.5e-6;
  EXPECT_NEAR((s.force(u + h, r) - s.force(u - h, r)) / (2 * h) / s.tangent(u, r), 1, 1e-8);
  EXPECT_NEAR((s.energy(u + h, r) - s.energy(u - h, r)) / (2 * h) / s.force(u, r), 1, 1e-8);
  EXPECT_NEAR(s.displacement(s.force(u, r), r) / u, 1, 1e-12);
}

TEST(Springs, TangentEnergyAndInverse) {
  for (double u : {-1e-7, -3e-9, 2e-9}) {
    check_spring(LinearSpring{1e5}, u);
    check_spring(HertzSpring{2e11, 3e-4}, u);
  }
}

// Hertz (4.18, 4.19): two like spheres of 5 um, E* = 150 GPa, overlap 0.1 um, reduced radius 2.5 um:
// F = 4/3 x 150e9 x sqrt(2.5e-6) x (1e-7)^1.5 = 10.0 mN; the equivalent radius of (4.21) is sqrt(2) stiffer.
TEST(Springs, HertzForceAndItsTwoRadii) {
  const HertzSpring s{4.0 / 3 * 150e9, 0};
  EXPECT_NEAR(s.force(-1e-7, 2.5e-6), -0.01, 1e-9);
  ContactModel m;
  EXPECT_EQ(elastic_radius(m, 5e-6, 5e-6), 2.5e-6);
  m.hertz_radius = HertzRadius::equivalent;
  EXPECT_NEAR(s.force(-1e-7, elastic_radius(m, 5e-6, 5e-6)) / s.force(-1e-7, 2.5e-6), std::sqrt(2.0), 1e-14);
}

// In tension Hertz goes on with the tangent of an overlap of tension_floor x R: (3/2)(4/3)E* R sqrt(floor).
TEST(Springs, HertzInTension) {
  const HertzSpring s{2e11, 3e-4};
  EXPECT_NEAR(s.force(1e-9, 2.5e-6) / (1.5 * 2e11 * 2.5e-6 * std::sqrt(3e-4) * 1e-9), 1, 1e-14);
  EXPECT_NEAR(s.tangent(1e-9, 2.5e-6) / s.tangent(-3e-4 * 2.5e-6, 2.5e-6), 1, 1e-14);
}

// (4.14, 4.22-4.25): F = k u + 2 xi sqrt(m k) v = -1e5 x 1e-7 - 2 x 0.3 sqrt(1e-3 x 1e5) x 1e-3 = -0.01 - 0.006 N.
TEST(KelvinVoigt, ForceOfSpringAndDamper) {
  const KelvinVoigt<LinearSpring> law{{stiffness}, 0.3};
  NormalInput in = driver_input(pair, -1e-7, 0, 0, 0);
  in.rate = -1e-3;
  EXPECT_NEAR(law.update(in).total, -0.016, 1e-15);
  EXPECT_EQ(law.update(in).sintering, 0);
}

template <class Law>
void check_kelvin_voigt(const Law& law) {
  NormalInput in = driver_input(pair, -1e-7, 0, 0, 0);
  const Linearisation l = law.linearise(in);
  auto at = [&](double u, double v) {
    NormalInput x = in;
    x.overlap = u;
    x.rate = v;
    return law.update(x).total;
  };
  const double h = 1e-12;
  EXPECT_NEAR((at(-1e-7 + h, 0) - at(-1e-7 - h, 0)) / (2 * h) / l.stiffness, 1, 1e-8);
  EXPECT_NEAR((at(-1e-7, 1e-3) - at(-1e-7, -1e-3)) / 2e-3 / l.damper, 1, 1e-12);
  EXPECT_EQ(l.stored, at(-1e-7, 0));
  EXPECT_TRUE(std::isinf(l.viscosity));
  in.overlap = 1e-9;
  EXPECT_EQ(law.linearise(in).stiffness, 0);
}

// `linearise` is the derivative of `update` by overlap and by rate.
TEST(KelvinVoigt, LineariseAgainstDifferences) {
  check_kelvin_voigt(KelvinVoigt<LinearSpring>{{stiffness}, 0.3});
  check_kelvin_voigt(KelvinVoigt<HertzSpring>{{2e11, 0}, 0.3});
}

// The small-step answer that a Linearisation stands for: spring(k) || damper(c) in series with a dashpot(eta).
double predicted(const Linearisation& l, double rate, double step) {
  const double change = step * (rate - l.stored / l.viscosity) / (1 + step * l.stiffness / l.viscosity);
  return l.active + l.stored + l.stiffness * change + (step > 0 ? l.damper * change / step : 0);
}

template <class Law>
void check_sintering(Law law, NeckPhase phase, double damping_ratio) {
  law.settings.damping_ratio = damping_ratio;
  law.active = phase != NeckPhase::deactivating && phase != NeckPhase::dormant;
  const NeckHistory start{0.5 * pair.radius, -2e-9, -20, phase};  // 20 s into a transition of 60 s
  // Steps far below eta/k = 1e-2 s: the updates then differ by less than 1e-5 of the damper's small share.
  const double step = 1e-7, rate = 1e-9;
  const NormalInput in = driver_input(pair, -1e-7, rate * step, step, 0);
  const Linearisation l = law.linearise(in, start);
  auto at = [&](double v) {
    NeckHistory h = start;
    NormalInput x = in;
    x.rate = v;
    return law.update(x, h).total;
  };
  const double scale = std::abs(l.stored) + l.active;
  EXPECT_NEAR(at(rate), predicted(l, rate, step), 1e-6 * scale) << int(phase);
  const double slope = (predicted(l, rate, step) - predicted(l, -rate, step)) / (2 * rate);
  EXPECT_NEAR((at(rate) - at(-rate)) / (2 * rate) / slope, 1, 2e-3) << int(phase);
}

// The same for every phase of a neck's life, springs, both updates, with and without damper.
TEST(SinteringContact, LineariseAgainstDifferences) {
  for (auto phase : {NeckPhase::activating, NeckPhase::sintering, NeckPhase::arriving, NeckPhase::bonded,
                     NeckPhase::deactivating, NeckPhase::dormant})
    for (auto update : {MaxwellUpdate::trapezoidal, MaxwellUpdate::backward_euler})
      for (double xi : {0.0, 0.4}) {
        auto linear = linear_law(1e3);
        linear.settings.update = update;
        check_sintering(linear, phase, xi);
        auto hertz = hertz_law(1e3);
        hertz.settings.update = update;
        check_sintering(hertz, phase, xi);
      }
}

// The viscous law (4.29) is F = F_sint + eta v at once; its linearisation has no spring.
TEST(SinteringContact, LineariseViscous) {
  auto law = linear_law(1e3);
  law.settings.model = SinteringModel::viscous;
  const NeckHistory start{0.5 * pair.radius, 0, 0, NeckPhase::sintering};
  const NormalInput in = driver_input(pair, -1e-7, -1e-14, 1e-5, 0);
  const Linearisation l = law.linearise(in, start);
  NeckHistory h = start;
  const double f = law.update(in, h).total;
  EXPECT_TRUE(std::isinf(l.stiffness));
  EXPECT_NEAR(l.viscosity, 1e3, 1e-9);
  EXPECT_NEAR(f, l.active + l.viscosity * in.rate, 1e-7 * l.active);
}

}  // namespace
}  // namespace densify::dem
