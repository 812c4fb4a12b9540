// Steps without inertia against closed forms: two copper spheres of Table 5.1, a Maxwell crystal, a thermo-elastic one.

#include <gtest/gtest.h>

#include "tests/support/neck_quadrature.h"
#include "tests/support/setups.h"

namespace densify::test {
namespace {

constexpr double radius = 22.5e-6;

void drop_inertia(Setup& s) {
  s.integration.method = dem::IntegrationMethod::inertia_free;
  s.integration.inertia_free.from = dem::InertiaFreeFrom::start;
}

Setup copper_pair(dem::SinteringModel model, double force, std::vector<Stage> stages) {
  auto contact = elastic_model(dem::Elasticity::linear, 7e5);
  contact.sintering = dem::SinteringSettings{};
  contact.sintering->model = model;
  contact.sintering->relaxation_time = 0;
  contact.sintering->starting_neck = 1e-3;
  auto s = empty_setup(copper(), contact, Schedule(1300, 0, std::move(stages)));
  drop_inertia(s);
  s.integration.inertia_free.force_tolerance = 1e-6;
  for (int i = 0; i < 2; ++i) add_sphere(s.particles, Vec3(0, 0, i * 2 * radius * (1 - 1e-9)), radius, Vec3::Zero());
  if (force > 0) s.loads = {{0, Vec3(0, 0, force), 0}, {1, Vec3(0, 0, -force), 0}};
  return s;
}

double strain(const Simulation& sim) {
  return 1 - (body(sim, 1).position - body(sim, 0).position).norm() / (2 * radius);
}

/// Strains at the end of each stage of the given durations [s].
std::vector<double> strains_at(dem::SinteringModel model, double force, const std::vector<double>& times,
                               double tolerance, std::uint64_t& steps) {
  std::vector<Stage> stages;
  double before = 0;
  for (const double t : times) {
    stages.push_back({"to " + std::to_string(t), t - before, 1300, 0});
    before = t;
  }
  Setup s = copper_pair(model, force, stages);
  s.integration.inertia_free.step_tolerance = tolerance;
  Simulation sim(s);
  std::vector<double> strains;
  while (!sim.finished()) {
    sim.advance(nullptr);
    if (sim.state().time >= times[strains.size()]) strains.push_back(strain(sim));
  }
  steps = sim.state().steps;
  return strains;
}

// Strain u/2r of two spheres without inertia (by quadrature): free and under 0.01 N.  1e-4 of the radius is what one
// step may err by an estimate of first order; the rule's second order leaves less than 1e-3 of each strain.
TEST(InertiaFree, CopperSpheres) {
  for (auto model : {dem::SinteringModel::viscoelastic, dem::SinteringModel::viscous}) {
    const double tolerance = 1e-4;
    std::uint64_t steps = 0;
    const std::vector<double> free{0.0156718837, 0.0341209017, 0.0746232217, 0.1642137736};
    const auto at = strains_at(model, 0, {1e3, 1e4, 1e5, 1e6}, tolerance, steps);
    for (std::size_t k = 0; k < free.size(); ++k) EXPECT_NEAR(at[k] / free[k], 1, 1e-3) << k << " steps " << steps;
    EXPECT_LT(steps, 1000u);
    const std::vector<double> pressed{0.0476722471, 0.1027738489};
    const auto under = strains_at(model, 0.01, {1e3, 1e4}, tolerance, steps);
    for (std::size_t k = 0; k < pressed.size(); ++k) EXPECT_NEAR(under[k] / pressed[k], 1, 1e-3) << k;
    EXPECT_LT(steps, 1000u);
  }
}

// Equal steps over 1e5 s under 0.01 N: the error against the quadrature falls with the step by the order of the rule.
// Viscosity and sintering force are taken at the neck's mean over the step, which makes the viscous pair second order.
TEST(InertiaFree, OrderOfTheStep) {
  const NeckQuadrature exact{radius, 2.51930572e-28, 1.72, 146 * M_PI / 180, 0.01};
  auto error = [&](int steps) {
    auto s = copper_pair(dem::SinteringModel::viscous, 0.01, {{"grow", 1e3, 1300, 0}, {"measure", 9e4, 1300, 0}});
    Simulation sim(s);
    while (sim.state().time < 1e3) sim.advance(nullptr);
    const double begin = strain(sim) * 2 * radius;
    auto fixed = s;
    fixed.integration.inertia_free.fixed_step = 9e4 / steps;
    Simulation rest(fixed);
    rest.restore(sim.state());
    while (!rest.finished()) rest.advance(nullptr);
    const double end = exact.time(begin, exact.integrated()) + 9e4;
    return strain(rest) * 2 * radius / exact.approach(end, radius, exact.integrated()) - 1;
  };
  const double coarse = error(32), fine = error(64);
  EXPECT_NEAR(std::log2(coarse / fine), 2, 0.3) << coarse << " " << fine;
  EXPECT_LT(std::abs(fine), 1e-3);
}

/// A periodic crystal of sintering contacts that is compressed at a constant rate.
Setup crystal(Lattice lattice, const Mat3& flow, std::vector<Stage> stages, double viscosity_step) {
  auto contact = elastic_model(dem::Elasticity::linear, 1e5);
  contact.sintering = dem::SinteringSettings{};
  contact.sintering->relaxation_time = 0;
  auto s = empty_setup(copper(), contact, Schedule(1300, 0, std::move(stages)));
  fill_periodic(s, lattice, 3, 1.9 * radius, radius);
  s.cell.velocity_gradient = flow;
  drop_inertia(s);
  s.integration.inertia_free.fixed_step = viscosity_step;
  return s;
}

// A Maxwell crystal strained at a constant rate D from rest: sigma = C_visc : D (1 - exp(-t/tau)) + the sintering
// stress, tau = eta/k.  In a step h << tau the elastic answer k h, after many tau the viscous one; backward Euler's
// 1 - (1 + h/tau)^-n in between.  BCC with contacts at L: C11 = k/(sqrt3 L) per uniaxial rate.
TEST(InertiaFree, StepResponseOfAMaxwellCrystal) {
  const double a = 0.4 * radius, eta = M_PI * std::pow(a, 4) / (8 * 2.51930572e-28), tau = eta / 1e5;
  const double rate = 1e-11 / tau, spacing = 1.9 * radius;
  Mat3 flow = Mat3::Zero();
  flow(2, 2) = -rate;
  for (const double h : {1e-3 * tau, tau, 1e3 * tau}) {
    auto s = crystal(Lattice::body_centred, flow, {{"strain", 4 * h, 1300, 0}}, h);
    Simulation sim(s);
    sim.evaluate(nullptr);
    bond_all(sim, dem::NeckPhase::sintering, 0.4);
    dem::Recording record;
    while (!sim.finished()) sim.advance(&record);
    sim.evaluate(&record);
    double passive = 0;  // all contacts of a body-centred crystal are alike
    for (const auto& c : record.contact)
      if (c.touching) passive = c.normal - c.sintering;
    const double steps = double(sim.state().steps);
    const double share = 1 - std::pow(1 + h / tau, -steps);
    EXPECT_NEAR(passive / (-eta * rate * spacing / 3 * share), 1, 1e-5) << h / tau;
  }
}

// A particle that nothing holds gains F h/M a step, M = max(1, mass_share x mass_scaling) times its real mass: it is
// not thrown as far as one likes.  Of the velocity before it keeps exp(-h/t), t = sqrt(M/k) the time of its swing.
TEST(InertiaFree, NothingHoldsALooseParticle) {
  for (const double scaling : {1.0, 1e8}) {
    auto s =
        empty_setup(copper(), elastic_model(dem::Elasticity::linear, 1e5), Schedule(300, 0, {{"hold", 1, 300, 0}}));
    drop_inertia(s);
    s.integration.mass_scaling = scaling;
    s.integration.inertia_free.mass_share = 1e-3;
    add_sphere(s.particles, Vec3::Zero(), radius, Vec3::Zero());
    const double mass = std::max(1.0, 1e-3 * scaling) * s.materials[0].density * 4 * M_PI / 3 * std::pow(radius, 3);
    const double h = 0.5 * std::sqrt(mass / 1e5), force = 1e-4 * mass * radius / (h * h);
    s.integration.inertia_free.fixed_step = h;
    s.loads = {{0, Vec3(0, 0, force), 0}};
    Simulation sim(s);
    double velocity = 0, way = 0;
    for (int n = 1; n <= 5; ++n) {
      sim.advance(nullptr);
      velocity = std::exp(-0.5) * velocity + h * force / mass;
      way += h * velocity;
      EXPECT_NEAR(body(sim, 0).velocity[2] / velocity, 1, 1e-12);
      EXPECT_NEAR(body(sim, 0).position[2] / way, 1, 1e-12);
    }
  }
}

// Three bonded spheres in a row pulled by T at their ends, the middle one by q across: the force turns with the branch,
// F cos(t) = T and 2 F sin(t) = q, so that tan(t) = q/(2 T) and every branch is L + F/k long.  What holds the middle
// sphere is T/L, fifty times f k: a Newton matrix without it never comes to rest in steps of any length.
TEST(InertiaFree, StringUnderTension) {
  const double k = 1e5, tension = 0.3 * k * radius, across = 0.2 * tension, gap = 1.999 * radius;
  auto contact = elastic_model(dem::Elasticity::linear, k);
  contact.sintering = dem::SinteringSettings{};
  contact.sintering->relaxation_time = 0;
  auto s = empty_setup(copper(), contact, Schedule(1300, 0, {{"pull", 1500, 1300, 0}}));
  drop_inertia(s);
  s.integration.inertia_free.fixed_step = 10;
  s.integration.inertia_free.force_tolerance = 1e-8;
  s.integration.inertia_free.tangential_share = 0.003;
  for (int i = 0; i < 3; ++i) add_sphere(s.particles, Vec3(0, 0, (i - 1) * gap), radius, Vec3::Zero());
  // The string is tight before it turns; elongations are summed along the normals at the ends of 100 steps.
  for (const double end : {-1.0, 1.0}) {
    const std::uint32_t p = end < 0 ? 0 : 2;
    s.loads.push_back({p, Vec3(0, 0, end * tension), 100});
    s.loads.push_back({p, Vec3(-across / 2, 0, 0), 1000});
  }
  s.loads.push_back({1, Vec3(across, 0, 0), 1000});
  Simulation sim(s);
  sim.evaluate(nullptr);
  bond_all(sim, dem::NeckPhase::bonded, 0.5);
  while (!sim.finished()) sim.advance(nullptr);
  const Vec3 branch = body(sim, 1).position - body(sim, 0).position;
  EXPECT_NEAR(branch[0] / branch[2] / (across / (2 * tension)), 1, 1e-6);
  EXPECT_NEAR((branch.norm() - gap) / (std::hypot(tension, across / 2) / k), 1, 1e-3);
  EXPECT_EQ(sim.inertia_free_count().rejected, 0u);
}

}  // namespace
}  // namespace densify::test
