// Crystals under a prescribed rate of deformation: stiffness and viscosity of SC, BCC and FCC in closed form, with the
// centre distance L and springs k_n, k_t (or dashpots) a contact:
//   SC  C11 = k_n/L, C12 = 0, C44 = k_t/(2 L)
//   BCC C11 = (k_n + 2 k_t)/(sqrt3 L), C12 = (k_n - k_t)/(sqrt3 L), C44 = (k_n + k_t/2)/(sqrt3 L)
//   FCC C11 = sqrt2 (k_n + k_t)/L, C12 = (k_n - k_t)/(sqrt2 L), C44 = (k_n + k_t)/(sqrt2 L)

#include <gtest/gtest.h>

#include "tests/support/setups.h"

namespace densify::test {
namespace {

constexpr double radius = 5e-6, spacing = 2 * radius * (1 - 1e-5);

struct Moduli {
  double c11, c12, c44;
};

Moduli closed_form(Lattice lattice, double kn, double kt) {
  const double l = spacing, r2 = std::sqrt(2.0), r3 = std::sqrt(3.0);
  switch (lattice) {
    case Lattice::simple_cubic:
      return {kn / l, 0, kt / (2 * l)};
    case Lattice::body_centred:
      return {(kn + 2 * kt) / (r3 * l), (kn - kt) / (r3 * l), (kn + 0.5 * kt) / (r3 * l)};
    default:
      return {r2 * (kn + kt) / l, (kn - kt) / (r2 * l), (kn + kt) / (r2 * l)};
  }
}

/// Stress gained per strain (or rate) `d`, which is applied over a few steps.
Mat3 response(const Setup& setup, double neck, const Mat3& d, int steps, double step) {
  Setup s = setup;
  s.integration.fixed_step = step;
  Simulation sim(s);
  if (neck > 0) bond_all(sim, dem::NeckPhase::sintering, neck);
  sim.mutable_state().cell.velocity_gradient = d;
  dem::Recording record;
  sim.advance(&record);
  Mat3 start = Mat3::Zero();  // dashpots answer the rate from the first moment on
  if (neck == 0) start = contact_stress(sim, record, sim.state().cell.volume());
  for (int n = 1; n < steps; ++n) sim.advance(nullptr);
  sim.advance(&record);
  return contact_stress(sim, record, sim.state().cell.volume()) - start;
}

void check(const Setup& s, double neck, const Moduli& m, int steps, double step, double strain) {
  const double rate = strain / (steps * step);
  const double scale = neck > 0 ? rate : strain, tolerance = 2e-3 * m.c11;
  const Mat3 pull = response(s, neck, rate * Vec3(1, 0, 0).asDiagonal().toDenseMatrix(), steps, step) / scale;
  EXPECT_NEAR(pull(0, 0), m.c11, tolerance);
  EXPECT_NEAR(pull(1, 1), m.c12, tolerance);
  EXPECT_NEAR(pull(0, 1), 0, tolerance);
  Mat3 shear = Mat3::Zero();
  shear(0, 1) = shear(1, 0) = 0.5 * rate;
  const Mat3 t = response(s, neck, shear, steps, step) / scale;
  EXPECT_NEAR(t(0, 1), m.c44, tolerance);
  EXPECT_NEAR(t(1, 0), m.c44, tolerance);
  EXPECT_NEAR(t(0, 0), 0, tolerance);
}

// Loose elastic contacts that stick (mu = 1e6), strain 2e-6 over an overlap of 1e-5: the prestress counts 1e-5.
TEST(LatticeStress, ElasticStiffness) {
  for (auto lattice : {Lattice::simple_cubic, Lattice::body_centred, Lattice::face_centred})
    for (double ratio : {0.5, 1.0}) {
      auto contact = elastic_model(dem::Elasticity::linear, 1e5);
      contact.friction = dem::FrictionModel{1e6, 1e6, ratio, 0};
      auto s = empty_setup(copper(), contact, hold(1, 300, 0));
      fill_periodic(s, lattice, 3, spacing, radius);
      s.integration.skin = 0.1;
      check(s, 0, closed_form(lattice, 1e5, ratio * 1e5), 100, 1e-11, 2e-6);
    }
}

// Viscous necks without surface tension: eta in place of k_n, k_t = 0; a sheared crystal flows at
// sigma_xy = eta gamma'/(sqrt3 L) in BCC.
TEST(LatticeStress, ViscosityOfNecks) {
  for (auto lattice : {Lattice::simple_cubic, Lattice::body_centred, Lattice::face_centred}) {
    auto contact = elastic_model(dem::Elasticity::linear, 1e5);
    contact.sintering = dem::SinteringSettings{};
    contact.sintering->model = dem::SinteringModel::viscous;
    auto material = copper();
    material.surface_energy = 0;
    auto s = empty_setup(material, contact, hold(1e6, 1300, 0));
    fill_periodic(s, lattice, 3, spacing, radius);
    s.integration.skin = 0.1;
    s.integration.mass_scaling = 1e14;
    const double eta = M_PI * std::pow(0.3 * radius, 4) / (8 * 2.51930572e-28);
    check(s, 0.3, closed_form(lattice, eta, 0), 100, 1e-3, 2e-6);
  }
}

// Simple shear: a full turn of shear by one cell edge maps the crystal on itself, and the cell, whose edges are
// exchanged for shorter ones on the way, too.  The velocity gradient is not symmetric, the list is rebuilt many times,
// and the crystal of loose spheres that do not overlap meets no force.
TEST(LatticeStress, ShearByACellIsTheSameCrystal) {
  auto s = empty_setup(copper(), elastic_model(dem::Elasticity::linear, 1e5), hold(1, 300, 0));
  fill_periodic(s, Lattice::simple_cubic, 3, 2.9 * radius, radius);
  s.integration.fixed_step = 1e-3;  // far above the limit of contacts, which there are none of
  s.integration.guards.guarding = dem::Guarding::off;
  const Mat3 before = s.cell.h;
  Simulation sim(s);
  sim.mutable_state().cell.velocity_gradient(0, 1) = 1;
  while (!sim.finished()) sim.advance(nullptr);
  const auto& cell = sim.state().cell;
  EXPECT_LT((cell.h.col(1) - before.col(1)).norm(), 1e-9 * before.norm());
  EXPECT_LT((cell.h.col(0) - before.col(0)).norm(), 1e-12 * before.norm());
  for (const auto& a : sim.state().particles.body) EXPECT_LT(a.velocity.norm(), 1e-15);
}

}  // namespace
}  // namespace densify::test
