#pragma once
// Two spheres that touch, with necks that sinter or not: the extremes differ in their numbers only.

#include "tests/support/neck_quadrature.h"
#include "tests/support/setups.h"

namespace densify::test {

inline constexpr double copper_diffusivity = 2.51930572e-28;  // D_eff of copper at 1300 K [m^5/(N s)]
inline constexpr double copper_radius = 22.5e-6;              // of Table 5.1 [m]

/// Two spheres of copper at 1300 K that just touch, sintering at once without transition, pressed together by `force`.
inline Setup copper_pair(double ri, double rj, double force, double duration) {
  auto contact = elastic_model(dem::Elasticity::linear, 7e5);
  contact.sintering = dem::SinteringSettings{};
  contact.sintering->relaxation_time = 0;
  contact.sintering->starting_neck = 1e-3;
  auto s = empty_setup(copper(), contact, hold(duration, 1300, 0));
  add_sphere(s.particles, Vec3::Zero(), ri, Vec3::Zero());
  add_sphere(s.particles, Vec3(0, 0, (ri + rj) * (1 - 1e-9)), rj, Vec3::Zero());
  if (force > 0) s.loads = {{0, Vec3(0, 0, force), 0}, {1, Vec3(0, 0, -force), 0}};
  return s;
}

/// How far the surfaces have come together [m].
inline double approach(const Simulation& sim) {
  return body(sim, 0).radius + body(sim, 1).radius - (body(sim, 1).position - body(sim, 0).position).norm();
}

inline void run_to_end(Simulation& sim) {
  while (!sim.finished()) sim.advance();
}

/// The same pair without inertia and elasticity.
inline NeckQuadrature exact_pair(double radius, double force) {
  return {radius, copper_diffusivity, 1.72, 146 * M_PI / 180, force};
}

}  // namespace densify::test
