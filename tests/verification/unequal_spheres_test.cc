// Two unequal spheres sinter as two equal ones of the sintering radius (4.33), for both radii and both readings of the
// neck; and the similarity laws (4.77)-(4.79).

#include <gtest/gtest.h>

#include "tests/support/neck_quadrature.h"
#include "tests/support/setups.h"

namespace densify::test {
namespace {

constexpr double small = 10e-6, large = 30e-6;

Setup pair_of(double ri, double rj, const dem::SinteringSettings& settings, double force, double duration) {
  auto contact = elastic_model(dem::Elasticity::linear, 7e5);
  contact.sintering = settings;
  contact.sintering->relaxation_time = 0;
  contact.sintering->starting_neck = 1e-3;
  auto s = empty_setup(copper(), contact, hold(duration, 1300, 0));
  s.integration.step_safety = 0.7;
  add_sphere(s.particles, Vec3::Zero(), ri, Vec3::Zero());
  add_sphere(s.particles, Vec3(0, 0, (ri + rj) * (1 - 1e-9)), rj, Vec3::Zero());
  if (force > 0) s.loads = {{0, Vec3(0, 0, force), 0}, {1, Vec3(0, 0, -force), 0}};
  return s;
}

double approach(const Simulation& sim) {
  return body(sim, 0).radius + body(sim, 1).radius - (body(sim, 1).position - body(sim, 0).position).norm();
}

struct Reading {
  dem::SinteringModel model;
  dem::SinteringRadius radius;
  dem::NeckGrowth neck;
  double force;
  double mass_factor;
};

// 2000 s; r = 15 um (equivalent) or 10 um (smaller).  Mass factors keep the share of inertia below 1e-4.
TEST(UnequalSpheres, AgainstQuadrature) {
  using enum dem::SinteringModel;
  using enum dem::SinteringRadius;
  using enum dem::NeckGrowth;
  for (const Reading& c :
       {Reading{viscoelastic, equivalent, integrated, 0, 1e14}, Reading{viscoelastic, smaller, integrated, 0, 1e14},
        Reading{viscoelastic, equivalent, overlap, 0, 1e14}, Reading{viscoelastic, smaller, overlap, 3e-3, 1e14},
        Reading{viscous, equivalent, integrated, 3e-3, 1e15}, Reading{viscous, smaller, overlap, 0, 1e15}}) {
    dem::SinteringSettings settings;
    settings.model = c.model;
    settings.radius = c.radius;
    settings.neck = c.neck;
    auto s = pair_of(small, large, settings, c.force, 2000);
    s.integration.mass_scaling = c.mass_factor;
    Simulation sim(s);
    while (!sim.finished()) sim.advance(nullptr);
    const double r = c.radius == smaller ? small : 2 * small * large / (small + large);
    const NeckQuadrature exact{r, 2.51930572e-28, 1.72, 146 * M_PI / 180, c.force};
    const auto neck = c.neck == overlap ? exact.of_overlap() : exact.integrated();
    EXPECT_NEAR(approach(sim) / exact.approach(2000, r, neck), 1, 2e-4) << int(c.radius) << int(c.neck) << int(c.model);
  }
}

double strain_of(Setup s) {
  Simulation sim(std::move(s));
  while (!sim.finished()) sim.advance(nullptr);
  return approach(sim) / (body(sim, 0).radius + body(sim, 1).radius);
}

// Lengths x s, surface energy x g, diffusivity x d.  Free: forces go as g s, and eta v = F gives the time s^4/(g d),
// a strain rate as gamma D/r^4.  With stiffness x g and mass x g tau^2 (in the density and mass factor of 1/s^3) every
// step is the same step: equal to rounding, amplified by 1e4 steps.
TEST(Similarity, FreeSinteringRateGoesAsGammaDOverR4) {
  const double s = 3, g = 0.7, d = 5, tau = s * s * s * s / (g * d);
  auto one = pair_of(small, large, {}, 0, 1000);
  one.integration.mass_scaling = 1e13;
  auto other = pair_of(s * small, s * large, {}, 0, 1000 * tau);
  other.materials[0].surface_energy *= g;
  other.materials[0].diffusion.prefactor *= d;
  other.contact.normal_stiffness *= g;
  other.integration.mass_scaling = 1e13 * g * tau * tau / (s * s * s);
  EXPECT_NEAR(strain_of(other) / strain_of(one), 1, 1e-9);
}

// Under a pressure p (force p r^2) with gamma/(p r) kept, rates go as p D/r^3: time s^3/(q d) for pressure x q.
TEST(Similarity, PressedRateGoesAsPressureDOverR3) {
  const double s = 3, q = 2, d = 5, f = q * s * s, tau = s * s * s / (q * d);
  auto one = pair_of(small, large, {}, 3e-3, 1000);
  one.integration.mass_scaling = 1e13;
  auto other = pair_of(s * small, s * large, {}, 3e-3 * f, 1000 * tau);
  other.materials[0].surface_energy *= q * s;
  other.materials[0].diffusion.prefactor *= d;
  other.contact.normal_stiffness *= f / s;
  other.integration.mass_scaling = 1e13 * f * tau * tau / (s * s * s * s);
  EXPECT_NEAR(strain_of(other) / strain_of(one), 1, 1e-9);
}

// The same without tying gamma: the sintering force of a large sphere is then too small to count, and the rate goes as
// p D/r^3 alone.  gamma x 1e-6 leaves 1e-6 of the load.
TEST(Similarity, PressureAlone) {
  const double s = 3;
  auto one = pair_of(small, small, {}, 3e-3, 1000);
  one.materials[0].surface_energy *= 1e-6;
  one.integration.mass_scaling = 1e13;
  auto other = pair_of(s * small, s * small, {}, 3e-3 * s * s, 1000 * s * s * s);
  other.materials[0].surface_energy *= 1e-6;
  other.integration.mass_scaling = 1e13;
  EXPECT_NEAR(strain_of(other) / strain_of(one), 1, 2e-4);
}

}  // namespace
}  // namespace densify::test
