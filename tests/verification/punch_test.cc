// The load-controlled punch in equilibrium: measured stress against applied pressure.

#include <gtest/gtest.h>

#include "tests/support/setups.h"

namespace densify::test {
namespace {

constexpr double radius = 5e-6, pressure = 30e6;

/// An n x n x m simple cubic packing in a box of its own size under a punch, pressure ramped up in a tenth of the time.
Setup pressed(const dem::Material& material, const dem::ContactModel& contact, int n, int m, double temperature,
              double duration) {
  const Schedule schedule(
      temperature, 0,
      {{"ramp", 0.1 * duration, temperature, pressure}, {"hold", 0.9 * duration, temperature, pressure}});
  Setup s = empty_setup(material, contact, schedule);
  s.container.shape = dem::ContainerShape::box;
  s.container.size = 2 * radius * Vec3(n, n, m);
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
      for (int k = 0; k < m; ++k)
        add_sphere(s.particles, radius * Vec3(2 * i + 1, 2 * j + 1, 2 * k + 1), radius, Vec3::Zero());
  return s;
}

struct Means {
  double punch, bottom, side;  ///< of the normal forces over the last half [N]
};

Means run(Setup s) {
  Simulation sim(std::move(s));
  const double end = sim.setup().schedule.end();
  Means sum{0, 0, 0};
  const std::size_t punch = *sim.wall("punch"), bottom = *sim.wall("bottom"), side = *sim.wall("wall x-");
  double time = 0;
  while (!sim.finished()) {
    sim.advance(nullptr);
    if (sim.state().time < 0.5 * end) continue;
    const double dt = sim.state().last_step;
    const auto& f = sim.state().walls.normal_force();
    sum.punch += f[punch] * dt;
    sum.bottom += f[bottom] * dt;
    sum.side += f[side] * dt;
    time += dt;
  }
  return {sum.punch / time, sum.bottom / time, sum.side / time};
}

// A column of five elastic spheres: the punch carries p A, the bottom p A and the weight (here 10 % of it).
TEST(Punch, ElasticColumn) {
  auto contact = elastic_model(dem::Elasticity::hertz, dem::unset);
  contact.damping_ratio = 0.1;
  auto s = pressed(nickel_aluminide(), contact, 1, 5, 300, 5e-5);
  const double area = 4 * radius * radius, weight = 0.1 * pressure * area;
  s.integration.gravity = Vec3(0, 0, -weight / (5 * 5910 * 4.0 / 3 * M_PI * std::pow(radius, 3)));
  const Means m = run(s);
  EXPECT_NEAR(m.punch / (pressure * area), 1, 1e-3);
  EXPECT_NEAR(m.bottom / (pressure * area + weight), 1, 1e-3);
}

// A block that sinters under the punch: while it shortens steadily the damper against the running mean takes no share
// of the load, and the mean of the wall's force stays within 1 % of p A; without weight the bottom carries the same.
TEST(Punch, SinteringBlock) {
  auto contact = elastic_model(dem::Elasticity::hertz, dem::unset);
  contact.damping_ratio = 0.3;
  contact.sintering = dem::SinteringSettings{};
  auto s = pressed(nickel_aluminide(), contact, 3, 3, 1500, 600);
  s.integration.mass_scaling = 1e15;
  const double load = pressure * std::pow(6 * radius, 2);
  const Means m = run(s);
  EXPECT_NEAR(m.punch / load, 1, 0.01);
  EXPECT_NEAR(m.bottom / load, 1, 0.01);
}

}  // namespace
}  // namespace densify::test
