// The step limit of a packing against the eigenvalues of its whole system, translation and rotation.

#include <gtest/gtest.h>

#include "tests/support/contact_system.h"

namespace densify::test {
namespace {

constexpr double radius = 5e-6, k_n = 1e5;

enum class Body { simple_cubic, body_centred, face_centred, cluster };

Simulation make(Body kind, const dem::ContactModel& contact) {
  Setup s = empty_setup(copper(), contact, hold(1, 300, 0));
  const double spacing = 2 * radius * 0.999;
  if (kind == Body::cluster)
    fill_cluster(s, 2, 1.7 * radius, radius, 3);
  else
    fill_periodic(s, Lattice(kind), kind == Body::simple_cubic ? 3 : 2, spacing, radius);
  s.integration.skin = 0.1;
  Simulation sim(s);
  sim.advance(nullptr);
  return sim;
}

dem::ContactModel model(double damping, double tangential_ratio, double tangential_damping) {
  auto m = elastic_model(dem::Elasticity::linear, k_n);
  m.damping_ratio = damping;
  if (tangential_ratio > 0) m.friction = dem::FrictionModel{1e9, 1e9, tangential_ratio, tangential_damping};
  return m;
}

// The largest eigenvalues of the particles' matrix sums bound that of the whole from above: the limit is never above
// the true one, in crystals and in a shaken cluster of unequal spheres, with stiff and soft tangential springs.  It is
// not far below either.  With normal springs it is exact in a face-centred crystal (2/omega = 2 sqrt(m/(8 k)), A = 4 k
// 1) and sqrt(3/4) of it in the simple cubic one of 3 cells, whose largest wave is not in the box; a sum of all k
// without their directions would be sqrt(3) lower.  Sticking contacts resist in all directions.
TEST(PackingStability, LimitOfSpringsIsNeverAboveTheTrueOne) {
  for (Body kind : {Body::simple_cubic, Body::body_centred, Body::face_centred, Body::cluster})
    for (double tangential : {0.0, 2.0 / 7, 1.0}) {
      const Simulation sim = make(kind, model(0, tangential, 0));
      const double ratio = sim.state().critical_step / undamped_limit(assemble(sim));
      EXPECT_LE(ratio, 1 + 1e-9) << int(kind) << " k_t " << tangential;
      EXPECT_GE(ratio, tangential == 0 ? 0.8 : 0.49) << int(kind) << " k_t " << tangential;
      if (kind == Body::face_centred && tangential == 0) {
        EXPECT_NEAR(ratio, 1, 2e-3);
      }
    }
}

// The same with dampers, normal and tangential: at the limit no eigenvalue of the step is outside the unit circle.
// (Rigid motions sit at 1 as double roots, which eigenvalues find to the root of rounding.)
TEST(PackingStability, DampedSystemsAreStableAtTheLimit) {
  for (Body kind : {Body::body_centred, Body::cluster})
    for (const auto& m : {model(0.5, 0, 0), model(0.3, 1, 0.3), model(0, 0.5, 0.8), model(2, 0.1, 1)}) {
      const Simulation sim = make(kind, m);
      const ContactSystem s = assemble(sim);
      EXPECT_LT(spectral_radius(s, sim.state().critical_step), 1 + 1e-5) << int(kind) << " xi " << m.damping_ratio;
      EXPECT_GT(spectral_radius(s, 5 * sim.state().critical_step), 1.1);  // it does notice
    }
}

// A sphere that sticks to a floor with k_t = k_n: sliding and rolling answer with 1/m + r^2/J = 3.5/m to one fixed end,
// 2/sqrt(3.5 k/m); its damper counts the same way.
TEST(PackingStability, StickingToAWall) {
  for (double damping : {0.0, 1.0}) {
    const auto contact = model(0, 1, damping);
    auto s = empty_setup(copper(), contact, hold(1, 300, 0));
    s.container.shape = dem::ContainerShape::box;
    s.container.punch = false;
    s.container.size = Vec3::Constant(10 * radius);
    add_sphere(s.particles, Vec3(5 * radius, 5 * radius, 0.999 * radius), radius, Vec3::Zero());
    Simulation sim(s);
    sim.advance(nullptr);
    const double omega = std::sqrt(3.5 * k_n * sim.state().particles.body[0].inverse_mass);
    const double xi = damping * std::sqrt(3.5);  // c_t = 2 xi sqrt(m k_t) against a mass of m/3.5
    EXPECT_LE(sim.state().critical_step, 2 / omega * (std::sqrt(1 + xi * xi) - xi));
  }
}

/// Largest kinetic energy of `steps` steps over that of a small random motion at their beginning.
double growth(Body kind, const dem::ContactModel& contact, double step, int steps) {
  Setup s = empty_setup(copper(), contact, hold(1, 300, 0));
  fill_periodic(s, Lattice(kind), 2, 2 * radius * 0.999, radius);
  s.integration.skin = 0.1;
  s.integration.fixed_step = step;
  s.integration.guards.guarding = dem::Guarding::off;
  shake(s.particles, 1e-6 * radius / step, 5);
  Simulation sim(s);
  const double early = kinetic_energy(sim.state().particles);
  double late = 0;
  for (int n = 0; n < steps; ++n) {
    sim.advance(nullptr);
    late = std::max(late, kinetic_energy(sim.state().particles));
  }
  return late / early;
}

// The program itself: at 0.99 of its limit the kinetic energy of a crystal swings by no more than the leap-frog's own
// 1/(1 - 0.99^2) over 5000 steps, at 1.01 of the true limit of the dense system it grows until contacts open, a
// thousand times its first amplitude.  (Crystals that normal springs alone hold: BCC has floppy modes that buckle,
// whatever the step.)
TEST(PackingStability, CrystalsAtTheLimit) {
  struct Held {
    Body kind;
    dem::ContactModel contact;
  };
  for (const auto& [kind, contact] :
       {Held{Body::face_centred, model(0, 0, 0)}, Held{Body::face_centred, model(0, 1, 0)},
        Held{Body::body_centred, model(0, 2.0 / 7, 0)}}) {
    const Simulation sim = make(kind, contact);
    EXPECT_LT(growth(kind, contact, 0.99 * sim.state().critical_step, 5000), 1 / (1 - 0.99 * 0.99)) << int(kind);
    EXPECT_GT(growth(kind, contact, 1.01 * undamped_limit(assemble(sim)), 1000), 1e4) << int(kind);
  }
}

}  // namespace
}  // namespace densify::test
