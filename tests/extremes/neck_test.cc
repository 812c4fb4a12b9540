// Necks at the ends of their numbers: relaxation times from 1e-12 to 1e12 steps, dihedral angles near 0 and 180
// degrees, and a life from birth to equilibrium or to being torn apart.

#include <gtest/gtest.h>

#include "tests/extremes/necked_pair.h"
#include "tests/extremes/stopped.h"
#include "tests/extremes/table.h"
#include "tests/support/law_driver.h"

namespace densify::test {
namespace {

// A Maxwell element stretched at a constant rate v: backward Euler gives F_n = eta v (1 - (1 + x)^-n), x = k dt/eta,
// the trapezoidal update the same with (1 - x/2)/(1 + x/2); both are bounded by eta v (1 + 1) for every x.  `rate` is
// small, so that the neck of half a radius stays what it is.
TEST(Relaxation, AnyTimeOverAnyStep) {
  Table table("relaxation", "relaxation_over_step,backward_euler,trapezoidal");
  const double k = 1e5, radius = 5e-6, a = 0.5 * radius, step = 1e-3, rate = 1e-15;
  for (int power = -12; power <= 12; ++power) {
    const double x = std::pow(10, -power), eta = k * step / x;
    double worst[2] = {0, 0};
    for (auto update : {dem::MaxwellUpdate::backward_euler, dem::MaxwellUpdate::trapezoidal}) {
      dem::SinteringSettings settings;
      settings.damping_ratio = 0;
      settings.update = update;
      using Law = dem::SinteringContact<dem::LinearSpring>;
      const Law law{{{k}, 0}, settings, a * a * a * a / eta, 0, 0, 0.95, true, false};
      const auto rows = drive<Law>(
          law, {radius, 1e-3}, {a, 0, -1e9, dem::NeckPhase::sintering}, 0, 200 * step, 200,
          [&](double t) { return -1e-7 + rate * t; }, [](Law&, double) {});
      const bool euler = update == dem::MaxwellUpdate::backward_euler;
      for (int n = 1; n <= 200; ++n) {
        // 1 - q^n without the difference that cancels for slow relaxation.
        const double due =
            eta * rate * (euler ? -std::expm1(-n * std::log1p(x)) : 1 - std::pow((1 - 0.5 * x) / (1 + 0.5 * x), n));
        const double slow = k * rate * n * step;
        const double error = std::abs(rows[std::size_t(n)].force.total - due) / std::min(eta * rate, slow);
        worst[euler ? 0 : 1] = std::max(worst[euler ? 0 : 1], error);
      }
    }
    table.row(std::pow(10, power), worst[0], worst[1]);
    // Overlaps of 1e-7 m round at 1e-23, beside a way of 1e-18 a step, and the ringing keeps what
    // 200 steps round; 1 - q^n of the trapezoidal reference cancels.
    EXPECT_LT(worst[0], 1e-4) << "eta/k over dt 1e" << power;
    EXPECT_LT(worst[1], power < 8 ? 1e-3 : 1e-2 * std::pow(10, power - 8)) << "eta/k over dt 1e" << power;
  }
}

// The same in the program: a pair under a force creeps with F/eta whatever the ratio; in one extreme nothing flows, in
// the other the spring does not count.
TEST(Relaxation, PairUnderLoad) {
  for (int power : {-12, -8, -4, 0, 4, 8, 12}) {
    auto s = copper_pair(copper_radius, copper_radius, 0, 1);
    s.materials[0].surface_energy = 0;
    const double mass = 4.2559941e-10, k = 7e5, a = 0.3 * copper_radius;
    const double step = 0.8 * std::sqrt(2 * mass / k), eta = std::pow(10, power) * step * k;
    s.materials[0].diffusion.prefactor *= M_PI * std::pow(a, 4) / (8 * eta) / s.materials[0].diffusion.effective(1300);
    const double duration = 2000 * step;
    // A force that moves the pair by at most a ten-thousandth of the neck, by flow or by the spring.
    const double way = 1e-4 * copper_radius * 0.09;
    const double force = way / std::max(duration / eta, 1 / k);
    s.schedule = hold(duration, 1300, 0);
    s.contact.sintering->damping_ratio = 0.3;
    s.loads = {{0, Vec3(0, 0, force), 100 * step}, {1, Vec3(0, 0, -force), 100 * step}};
    s.particles.body[1].position[2] = 1.999 * copper_radius;
    Simulation sim(s);
    bond_all(sim, dem::NeckPhase::sintering, 0.3);
    const double before = approach(sim);
    run_to_end(sim);
    // Flow under the ramp counts for half of it.  Inertia of the free pair: m/(2 eta) of time lag where flow is fast.
    const double due = force / k + force / eta * (duration - 50 * step);
    const double lag = power < 0 ? 0.5 * mass / eta / duration : 0.0;
    if (lag > 0.01) continue;  // nothing holds the pair: it falls freely under the force
    EXPECT_NEAR((approach(sim) - before) / due, 1, 0.01 + lag) << power;
  }
}

// Nothing holds a pair whose neck flows faster than its inertia: it moves as the free masses do, and stays sound.
TEST(Relaxation, FallsFreelyThroughALiquidNeck) {
  auto s = copper_pair(copper_radius, copper_radius, 0, 1);
  s.materials[0].surface_energy = 0;
  const double mass = 4.2559941e-10, step = 0.8 * std::sqrt(2 * mass / 7e5);
  s.materials[0].diffusion.prefactor *= 1e20;
  s.contact.sintering->damping_ratio = 0;
  s.schedule = hold(1000 * step, 1300, 0);
  const double force = 2e-4 * copper_radius * mass / std::pow(1000 * step, 2);
  s.loads = {{0, Vec3(0, 0, force), 0}, {1, Vec3(0, 0, -force), 0}};
  s.particles.body[1].position[2] = 1.999 * copper_radius;
  Simulation sim(s);
  bond_all(sim, dem::NeckPhase::sintering, 0.3);
  const double before = approach(sim);
  run_to_end(sim);
  EXPECT_NEAR((approach(sim) - before) / (2e-4 * copper_radius), 1, 2e-3);  // 2 x a t^2/2
}

// A dihedral angle of 179.9 degrees: the neck grows to the radius itself, in the time of the quadrature.  One of 1.2
// degrees: the neck is at equilibrium with 0.0105 radii, and bonds.  One of 0.1 degrees is below the smallest neck that
// can be told from none, and is refused.
TEST(DihedralAngle, NearStraightAndNearNothing) {
  const auto duration = [](double psi, double a) {
    NeckQuadrature exact = exact_pair(copper_radius, 0);
    exact.dihedral = psi;
    return exact.time(a * a / (2 * copper_radius), exact.integrated());
  };
  for (double degrees : {179.9, 90.0, 1.2}) {
    const double psi = degrees * M_PI / 180, largest = copper_radius * std::sin(0.5 * psi);
    auto s = copper_pair(copper_radius, copper_radius, 0, 2 * duration(psi, largest));
    s.materials[0].dihedral_angle = psi;
    // Steps of a 20000th of the time that is due, with the pair's spring as the limit.
    s.integration.mass_scaling = std::pow(duration(psi, largest) / 20000, 2) * 7e5 / 4.2559941e-10;
    Simulation sim(s);
    while (!sim.finished() && !sim.all_at_equilibrium()) sim.advance();
    EXPECT_TRUE(sim.all_at_equilibrium()) << degrees;
    EXPECT_DOUBLE_EQ(sim.state().contacts.neck[0].radius, largest) << degrees;  // r is 2 r_i r_j/(r_i + r_j) there
    if (degrees > 10) {
      EXPECT_NEAR(sim.state().time / duration(psi, largest), 1, 1e-3) << degrees;
    }
    run_at_most(sim, 1000);
    EXPECT_EQ(sim.state().contacts.neck[0].phase, dem::NeckPhase::bonded);
  }
  auto s = copper_pair(copper_radius, copper_radius, 0, 1);
  s.materials[0].dihedral_angle = 0.1 * M_PI / 180;
  EXPECT_THROW(Simulation{s}, InputError);
}

/// A pair with a neck of 0.3 radii that is pulled apart by more than it can hold.
Setup torn_pair(dem::SinteringModel model, dem::NeckGrowth growth) {
  auto s = copper_pair(copper_radius, copper_radius, 0, 2e4);
  s.contact.sintering->model = model;
  s.contact.sintering->neck = growth;
  s.particles.body[1].position[2] = (2 - 0.045) * copper_radius;  // a = 0.3 r by sqrt(2 r u)
  s.integration.mass_scaling = 1e14;
  const double force = 5e-3;  // F_sint is 4e-4 N
  s.loads = {{0, Vec3(0, 0, -force), 100}, {1, Vec3(0, 0, force), 100}};
  return s;
}

// Torn apart: the neck thins by a^2 -= 2 r du and is gone; the spheres fly on under the force alone, loose and without
// a contact, in every model of the neck.  The momentum is still zero.
TEST(Neck, ForcedApart) {
  using enum dem::SinteringModel;
  using enum dem::NeckGrowth;
  for (const auto& [model, growth] :
       {std::pair{viscoelastic, integrated}, {viscoelastic, overlap}, {viscous, integrated}, {viscous, overlap}}) {
    Simulation sim(torn_pair(model, growth));
    bond_all(sim, dem::NeckPhase::sintering, 0.3);
    double largest = 0.3 * copper_radius, smallest = largest;
    while (!sim.finished() && sim.contacts_now() > 0) {
      sim.advance();
      const double a = sim.contacts_now() > 0 ? sim.state().contacts.neck[0].radius : smallest;
      EXPECT_GE(a, 0);
      largest = std::max(largest, a), smallest = std::min(smallest, a);
    }
    ASSERT_EQ(sim.contacts_now(), 0u) << int(model) << int(growth);
    EXPECT_LT(smallest, 0.1 * copper_radius) << int(model) << int(growth);
    EXPECT_GT(approach(sim), -0.1 * copper_radius);
    const double v = body(sim, 1).velocity[2];
    for (int n = 0; n < 10; ++n) sim.advance();
    dem::Recording record;
    sim.evaluate(&record);
    for (const auto& c : record.contact) EXPECT_FALSE(c.touching);
    EXPECT_GT(body(sim, 1).velocity[2], v);
    EXPECT_LT(momentum(sim.state().particles).norm(), 1e-12 * body(sim, 1).velocity.norm() / body(sim, 1).inverse_mass);
  }
}

// A neck at equilibrium is a bond and does not thin: under tension it stands at u = F/k.
TEST(Neck, BondHoldsUnderTension) {
  auto s = torn_pair(dem::SinteringModel::viscoelastic, dem::NeckGrowth::integrated);
  s.contact.sintering->damping_ratio = 0.5;
  Simulation sim(s);
  bond_all(sim, dem::NeckPhase::bonded, 0.3);
  const double before = approach(sim);
  run_to_end(sim);
  EXPECT_NEAR((before - approach(sim)) / (5e-3 / 7e5), 1, 1e-6);
}

}  // namespace
}  // namespace densify::test
