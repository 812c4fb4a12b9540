// Every contact model at 0.99 and at 1.01 of its step limit: as a pair, a chain, a crystal and a packing.

#include <gtest/gtest.h>

#include "tests/extremes/stopped.h"
#include "tests/extremes/table.h"
#include "tests/support/contact_system.h"

namespace densify::test {
namespace {

constexpr double radius = 5e-6, overlap = 1e-3;  // the second over the radius

enum class Model { linear, hertz, friction, bond, maxwell, trapezoidal, viscous };
constexpr Model all_models[] = {Model::linear,  Model::hertz,       Model::friction, Model::bond,
                                Model::maxwell, Model::trapezoidal, Model::viscous};
enum class Body { pair, chain, crystal, packing };
constexpr Body all_bodies[] = {Body::pair, Body::chain, Body::crystal, Body::packing};

constexpr const char* model_names[] = {"Linear", "Hertz", "Friction", "Bond", "Maxwell", "Trapezoidal", "Viscous"};
constexpr const char* body_names[] = {"Pair", "Chain", "Crystal", "Packing"};

bool has_neck(Model m) {
  return m != Model::linear && m != Model::hertz && m != Model::friction;
}

dem::ContactModel contact_of(Model m) {
  auto contact = elastic_model(m == Model::hertz ? dem::Elasticity::hertz : dem::Elasticity::linear, 1e5);
  if (m == Model::friction) contact.friction = dem::FrictionModel{1e9, 1e9, 2.0 / 7, 0};  // never slides
  if (!has_neck(m)) return contact;
  contact.sintering = dem::SinteringSettings{};
  contact.sintering->damping_ratio = 0;
  if (m == Model::trapezoidal) contact.sintering->update = dem::MaxwellUpdate::trapezoidal;
  if (m == Model::viscous) contact.sintering->model = dem::SinteringModel::viscous;
  return contact;
}

/// Copper whose necks of 0.3 radii have the viscosity eta [N s/m] and no sintering force.
dem::Material material_with(double eta) {
  auto m = copper();
  m.surface_energy = 0;
  const double a = 0.3 * radius;
  m.diffusion.prefactor *= M_PI * std::pow(a, 4) / (8 * eta) / m.diffusion.effective(1300);
  return m;
}

/// Spheres of +-2 % in a periodic cube, pressed into each other by about a hundredth and come to rest.
Setup resting_packing(const Setup& empty, bool loose) {
  Setup s = empty;
  fill_periodic(s, Lattice::face_centred, 2, 2 * radius * (1 - 0.5 * overlap), radius);
  if (!loose) return s;
  std::mt19937 random(3);
  std::uniform_real_distribution<double> u(-1, 1);
  for (double& r : s.particles.reference_radius) r *= 1.02 + 0.02 * u(random);
  const auto friction = s.contact.friction;
  s.contact.friction.reset();  // at rest without it, since its springs begin anew
  s.integration.drag = 2e6;
  Simulation sim(s);
  run_at_most(sim, 4000);
  for (std::size_t p = 0; p < s.particles.size(); ++p) {
    s.particles.body[p].position = body(sim, std::uint32_t(p)).position;
    s.particles.body[p].velocity.setZero();
  }
  s.integration.drag = 0;
  s.contact.friction = friction;
  return s;
}

Setup make_setup(Model model, Body kind) {
  const double eta = model == Model::viscous ? 300 : 1e4 * 1e5 * 1e-8;  // Maxwell: eta/k is 1e4 steps or so
  Setup s = empty_setup(material_with(eta), contact_of(model), hold(1, 1300, 0));
  s.integration.skin = 0.1;
  if (kind == Body::pair) {
    for (int i = 0; i < 2; ++i) add_sphere(s.particles, Vec3(0, 0, i * (2 - overlap) * radius), radius, Vec3::Zero());
    if (has_neck(model)) return s;
    // Pressed together by what their spring holds.
    Simulation probe(s);
    dem::Recording record;
    probe.evaluate(&record);
    const Vec3 push(0, 0, record.contact[0].normal);
    s.loads = {{0, -push, 0}, {1, push, 0}};
  } else if (kind == Body::chain) {
    const double edge = 8 * (2 - overlap) * radius;
    for (int i = 0; i < 8; ++i)
      add_sphere(s.particles, Vec3(0.5 * edge, 0.5 * edge, (i + 0.5) * edge / 8), radius, Vec3::Zero());
    make_periodic(s, edge);
  } else if (kind == Body::crystal) {
    fill_periodic(s, Lattice::face_centred, 2, (2 - overlap) * radius, radius);
  } else {
    s = resting_packing(s, !has_neck(model));
    if (has_neck(model)) {  // necks hold any arrangement: unequal spheres, free, deep in each other
      s.particles = {};
      s.cell = {};
      s.container.shape = dem::ContainerShape::free;
      fill_cluster(s, 2, 1.7 * radius, radius, 3);
    }
  }
  return s;
}

Simulation make(Model model, const Setup& setup) {
  Simulation sim(setup);
  if (has_neck(model)) {
    bond_all(sim, model == Model::bond ? dem::NeckPhase::bonded : dem::NeckPhase::sintering, 0.3);
    for (auto& h : sim.mutable_state().contacts.neck) h.since = -1e9;
  }
  return sim;
}

/// The smallest step at which the dense system of all contacts is not stable [s].
double true_limit(Model model, const Simulation& sim) {
  const ContactSystem s = assemble(sim);
  return model == Model::viscous ? dashpot_limit(s) : undamped_limit(s);
}

/// Largest kinetic energy of `steps` steps over that of a small random motion at their beginning; infinite when the
/// motion has no end.
double growth(Model model, Setup s, double step, dem::Guarding guarding, int steps) {
  s.integration.fixed_step = step;
  s.integration.guards.guarding = guarding;
  shake(s.particles, 1e-7 * radius / step, 5);
  if (s.particles.size() == 8 || s.particles.size() == 2)  // a chain and a pair move along their line
    for (auto& b : s.particles.body) b.velocity.head<2>().setZero();
  Simulation sim = make(model, s);
  const double early = kinetic_energy(sim.state().particles);
  double late = 0;
  try {
    for (int n = 0; n < steps; ++n) {
      sim.advance();
      late = std::max(late, kinetic_energy(sim.state().particles));
    }
  } catch (const RunError& error) {
    if (guarding == dem::Guarding::on) throw;
    return std::numeric_limits<double>::infinity();
  }
  return late / early;
}

class AtTheLimit : public testing::TestWithParam<std::tuple<Model, Body>> {};

// 0.99 of the program's own limit: a small motion stays small over 3000 steps.  A mode at 0.99 of its limit shows its
// energy as kinetic up to 1/(1 - 0.99^2) = 50 times the least; what is shared with a hundred other modes far less.
// A fixed step of 1.01 times the limit is refused.  1.01 of the true limit, by the eigenvalues of all contacts at once,
// grows without end when nothing guards it: the program's limit is needed.  It is at most a factor 2 below the true
// one.
TEST_P(AtTheLimit, StableBelowRefusedAbove) {
  const auto [model, kind] = GetParam();
  const auto s = make_setup(model, kind);
  Simulation sim = make(model, s);
  sim.evaluate(nullptr);
  const double own = sim.step_limit().critical, whole = true_limit(model, sim);
  Table("step_limit", "model,body,own_over_true").row(model_names[int(model)], body_names[int(kind)], own / whole);
  EXPECT_LE(own, whole * (1 + 1e-3));  // by what a contact under load changes while it swings
  EXPECT_GE(own, (model == Model::viscous ? 0.45 * 0.45 : 0.45) * whole);
  EXPECT_LT(growth(model, s, 0.99 * own, dem::Guarding::on, 3000), 60);
  EXPECT_STOPS(growth(model, s, 1.01 * own, dem::Guarding::on, 1), "fixed_step", "stability limit");
  EXPECT_GT(growth(model, s, 1.01 * whole, dem::Guarding::off, 3000), 1e3);
}

std::string name_of(const testing::TestParamInfo<std::tuple<Model, Body>>& info) {
  return std::string(model_names[int(std::get<0>(info.param))]) + body_names[int(std::get<1>(info.param))];
}

INSTANTIATE_TEST_SUITE_P(StepLimit, AtTheLimit,
                         testing::Combine(testing::ValuesIn(all_models), testing::ValuesIn(all_bodies)), name_of);

}  // namespace
}  // namespace densify::test
