// A cell that an owner strains without inertia: stress and tangent of crystals in closed form, of a packing against
// difference quotients, work, exact volume and time, and going back.

#include <gtest/gtest.h>

#include "tests/dem/small_packings.h"
#include "tests/support/setups.h"

namespace densify::test {
namespace {

using dem::CellAnswer;
using dem::testing::StateBits;

constexpr double radius = 5e-6;

void drop_inertia(Setup& s) {
  s.integration.method = dem::IntegrationMethod::inertia_free;
  s.integration.inertia_free.from = dem::InertiaFreeFrom::start;
  s.integration.inertia_free.force_tolerance = 1e-6;
}

Mat3 symmetric(const Vec6& e) {
  Mat3 m;
  m << e[0], 0.5 * e[5], 0.5 * e[4], 0.5 * e[5], e[1], 0.5 * e[3], 0.5 * e[4], 0.5 * e[3], e[2];
  return m;
}

// A face-centred crystal of springs k, spacing L: C11 = sqrt2 k/L, C12 = C44 = k/(sqrt2 L).  The tangent by the rate is
// C x step.  Prestress adds some 1e-3 of overlap over radius, resistance across contacts the share f = 1e-4.  Its
// stress is that of three springs a sphere and plane: 2 sqrt2 F/L^2.
TEST(CellStrain, CrystalOfSprings) {
  const double k = 1e5, l = 2 * radius * (1 - 1e-3), step = 10;
  dem::Setup s = empty_setup(copper(), elastic_model(dem::Elasticity::linear, k), hold(100, 300, 0));
  fill_periodic(s, Lattice::face_centred, 3, l, radius);
  drop_inertia(s);
  s.integration.inertia_free.tangential_share = 1e-4;
  Simulation sim(s);
  const CellAnswer a = sim.strain({symmetric({-1e-5, 0, 0, 0, 0, 1e-5}) / step, step});
  const Mat6 tangent = sim.strain_tangent().stress;
  const double c11 = std::sqrt(2.0) * k / l, c12 = k / (std::sqrt(2.0) * l), p = -2 * std::sqrt(2.0) * k * 1e-3 / l;
  Mat6 c = Mat6::Zero();
  c.topLeftCorner<3, 3>().setConstant(c12);
  c.diagonal() << c11, c11, c11, c12, c12, c12;
  EXPECT_EQ(a.steps, 1);
  EXPECT_LT((tangent / step - c).norm(), 3e-3 * c.norm());
  Vec6 expected = c * Vec6(-1e-5, 0, 0, 0, 0, 1e-5);
  expected.head<3>().array() += p;
  EXPECT_LT((a.stress - expected).norm(), 2e-3 * expected.norm());
  EXPECT_EQ(sim.state().time, step);
}

/// Loose unequal spheres, or sintering ones, pressed into contact.
Setup packing(bool sintering) {
  auto contact = elastic_model(dem::Elasticity::hertz, dem::unset);
  const double hot = 1400, cold = 300, temperature = sintering ? hot : cold;
  if (sintering) contact.sintering = dem::SinteringSettings{}, contact.sintering->relaxation_time = 0;
  Setup s = empty_setup(nickel_aluminide(), contact, hold(1000, temperature, 0));
  s.reference_temperature = temperature;
  fill_periodic(s, Lattice::face_centred, 3, 9.8e-6, radius);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> u(-1, 1);
  for (std::size_t p = 0; p < s.particles.size(); ++p) {
    s.particles.reference_radius[p] *= 1 + 0.05 * u(random);
    s.particles.body[p].position += 2e-7 * Vec3(u(random), u(random), u(random));
  }
  drop_inertia(s);
  s.integration.mass_scaling = 1e10;
  s.integration.skin = 1;
  s.integration.inertia_free.step_tolerance = 1e-2;
  return s;
}

/// The packing after some steps towards higher density.
Simulation pressed(const Setup& s) {
  Simulation sim(s);
  for (int n = 1; n <= 10; ++n) sim.strain({symmetric({-1e-4, -1e-4, -2e-4, 0, 0, 1e-5}), double(n)});
  return sim;
}

// The tangent against central differences of the stress, of springs and of necks that flow: within 5e-3 of its largest
// entry, and twice the largest stress times the step, which is what the strain does to branches and volume.  Work:
// contacts do what the stress does, but for forces within force_tolerance of balance.
TEST(CellStrain, TangentIsTheDerivativeAndWorkIsStressTimesRate) {
  for (const bool sintering : {false, true}) {
    Simulation sim = pressed(packing(sintering));
    const dem::State before = sim.state();
    const double step = 1, e = sintering ? 1e-6 : 1e-7;
    Vec6 rate;
    rate << -1e-4, -1e-4, -2e-4, 0, 0, 1e-5;
    const auto at = [&](const Vec6& r) {
      sim.restore(before);
      return sim.strain({symmetric(r), before.time + step});
    };
    const CellAnswer a = at(rate);
    const Mat6 tangent = sim.strain_tangent().stress;
    EXPECT_EQ(a.steps, 1);
    EXPECT_LT(a.mismatch, 1e-4 * a.power);
    Mat6 quotient;
    for (int c = 0; c < 6; ++c)
      quotient.col(c) = (at(rate + e * Vec6::Unit(c)).stress - at(rate - e * Vec6::Unit(c)).stress) / (2 * e);
    const double geometry = 2 * a.stress.cwiseAbs().maxCoeff() * step;
    EXPECT_LT((quotient - tangent).cwiseAbs().maxCoeff(), 5e-3 * tangent.cwiseAbs().maxCoeff() + geometry)
        << sintering << "\n"
        << quotient << "\n\n"
        << tangent << "\n\n"
        << geometry;
  }
}

// Volume goes as exp(tr strain) to rounding whatever steps it takes, ends are met exactly, and the estimate of the
// error makes the steps.
TEST(CellStrain, VolumeAndTimeAreExact) {
  dem::Setup s = packing(true);
  s.integration.inertia_free.step_tolerance = 1e-5;
  Simulation sim(s);
  const double volume = sim.state().cell.volume();
  Vec6 rate;
  rate << -1e-4, -3e-4, -2e-4, 1e-4, 0, 2e-4;
  const CellAnswer a = sim.strain({symmetric(rate), 10.0});
  EXPECT_GT(a.steps, 1);
  EXPECT_GT(a.error, 0);
  EXPECT_EQ(sim.state().time, 10.0);
  EXPECT_NEAR(sim.state().cell.volume() / volume / std::exp(-6e-3), 1, 1e-12);
}

// A cell that was strained, taken back and strained otherwise is bit for bit the one that went there at once.
TEST(CellStrain, GoingBackLeavesNoTrace) {
  for (const bool sintering : {false, true}) {
    Simulation sim = pressed(packing(sintering)), other = pressed(packing(sintering));
    const dem::State before = sim.state();
    sim.strain({symmetric({1e-4, -1e-3, -2e-4, 0, 0, 1e-3}), before.time + 2});
    sim.restore(before);
    EXPECT_TRUE(StateBits(sim.state()) == StateBits(other.state()));
    const dem::CellStretch stretch{symmetric({-1e-4, 0, -2e-4, 0, 1e-4, 0}), before.time + 1};
    const CellAnswer a = sim.strain(stretch), b = other.strain(stretch);
    EXPECT_EQ(a.stress, b.stress);
    EXPECT_EQ(sim.strain_tangent().stress, other.strain_tangent().stress);
    EXPECT_TRUE(StateBits(sim.state()) == StateBits(other.state()));
  }
}

// A search that begins with the motion foretold by the tangent ends where one from the last velocities does, within the
// tolerance of the balance, and sooner.
TEST(CellStrain, TheTangentForetellsTheMotion) {
  Simulation sim = pressed(packing(true));
  const dem::State before = sim.state();
  const Mat3 rate = symmetric({-1e-4, -1e-4, -2e-4, 0, 0, 1e-5}), change = symmetric({0, 0, 2e-6, 0, 0, 0});
  sim.strain({rate, before.time + 1});
  const Eigen::VectorXd guess = sim.strain_velocities() + 2e-6 * sim.strain_tangent().motion.col(2);
  const auto solutions = [&](const Eigen::VectorXd* start, Vec6& stress) {
    sim.restore(before);
    const std::uint64_t so_far = sim.inertia_free_count().solutions;
    stress = sim.strain({rate + change, before.time + 1, start}).stress;
    return sim.inertia_free_count().solutions - so_far;
  };
  Vec6 with, without;
  EXPECT_LT(solutions(&guess, with), solutions(nullptr, without));
  EXPECT_LT((with - without).norm(), 1e-4 * without.norm());
}

// Only a periodic cell without inertia that nothing else drives can be strained.
TEST(CellStrain, NeedsAFreeCell) {
  dem::Setup s = packing(false);
  s.integration.inertia_free.from = dem::InertiaFreeFrom::activation;
  Simulation sim(s);
  EXPECT_THROW(sim.strain({Mat3::Zero(), 1}), std::logic_error);
}

}  // namespace
}  // namespace densify::test
