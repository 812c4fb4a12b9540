// Where the work on a driven cell goes: crystals against closed forms, heat in a closed cell, and packings through a
// whole process, in which the balance closes.

#include "dem/measure/energy_balance.h"

#include <gtest/gtest.h>

#include "dem/io/scene.h"
#include "dem/specimen.h"
#include "tests/dem/small_packings.h"
#include "tests/support/neck_quadrature.h"
#include "tests/support/setups.h"

namespace densify::test {
namespace {

using dem::CellControl;
using dem::EnergyBalance;
using dem::EnergySums;
using dem::testing::StateBits;

dem::CellGoals rates(double xx, double yy, double zz, double xy) {
  dem::CellGoals g;
  const double value[6] = {xx, yy, zz, xy, 0, 0};
  for (std::size_t c = 0; c < 6; ++c) g[c] = {CellControl::rate, value[c]};
  return g;
}

dem::CellGoals pressure(double p) {
  dem::CellGoals g;
  for (std::size_t c = 0; c < 6; ++c) g[c] = {CellControl::stress, c < 3 ? -p : 0};
  return g;
}

/// Through the whole process; `work` becomes the integral of V sigma : D by the cell's own stress.
EnergySums balance_of(Simulation& sim, double* work = nullptr) {
  EnergyBalance balance;
  EnergySums sums;
  dem::Recording recording;
  const auto half = [&] {
    const auto& s = sim.state();
    return 0.5 * s.last_step * s.cell.volume() * sim.cell_stress().cwiseProduct(s.cell.velocity_gradient).sum();
  };
  while (true) {
    balance.evaluate(sim, recording, sums);
    if (work) *work += half();
    if (sim.finished()) return sums;
    balance.move(sim, recording, sums);
    if (work) *work += half();
  }
}

// A simple cubic crystal of linear springs, compressed along x by a slow rate: one contact a sphere stores k u^2/2 with
// u = L (1 - exp(-e)), the work of the boundary is that, and nothing else takes part.  1e-5, the steps' share.
TEST(EnergyBalance, ElasticCrystal) {
  constexpr double r = 5e-6, k = 1e5, strain = 1e-3;
  auto s = empty_setup(copper(), elastic_model(dem::Elasticity::linear, k), hold(1, 300, 0));
  fill_periodic(s, Lattice::simple_cubic, 3, 2 * r, r);
  const double time = 2e5 * Simulation(s).step_limit().critical;
  s.schedule = hold(time, 300, 0);
  s.cell_path = dem::CellPath{rates(-strain / time, 0, 0, 0), {rates(-strain / time, 0, 0, 0)}};
  Simulation sim(s);
  const EnergySums e = balance_of(sim);
  const double u = 2 * r * (1 - std::exp(-strain)), stored = 27 * 0.5 * k * u * u;
  EXPECT_NEAR(e.boundary / stored, 1, 1e-4);
  EXPECT_NEAR(e.stored / stored, 1, 1e-4);
  EXPECT_LT(std::abs(e.residual()), 1e-5 * stored);
  EXPECT_EQ(e.sintering, 0);
  EXPECT_EQ(e.viscous, 0);
  EXPECT_EQ(e.expansion, 0);
  EXPECT_EQ(e.stiffness, 0);
  EXPECT_LT(std::abs(e.motion), 1e-6 * stored);
}

// A face-centred crystal compressed from all sides while it sinters: 6 contacts a sphere, whose sintering force does
// the work integral of F_sint du and whose dashpots take integral of eta u' du, a^2 = 2 r u.  The springs lag by
// eta/k: 1e-2.
TEST(EnergyBalance, SinteringCrystal) {
  constexpr double r = 22.5e-6, time = 1e5, u = 0.15 * r;
  const dem::Material m = copper();
  const NeckQuadrature pair{r, m.diffusion.effective(1300), m.surface_energy, m.dihedral_angle, 0};
  const double rate = std::log(1 - 0.5 * u / r) / time;
  for (const auto model : {dem::SinteringModel::viscoelastic, dem::SinteringModel::viscous}) {
    auto contact = elastic_model(dem::Elasticity::linear, 7e7);
    contact.sintering = dem::SinteringSettings{};
    contact.sintering->model = model;
    contact.sintering->relaxation_time = 0;
    contact.sintering->damping_ratio = 0;
    contact.sintering->starting_neck = 1e-3;
    auto s = empty_setup(m, contact, hold(time, 1300, 0));
    fill_periodic(s, Lattice::face_centred, 1, 2 * r * (1 - 1e-9), r);
    s.integration.mass_scaling = model == dem::SinteringModel::viscous ? 1e19 : 1e17;
    s.cell_path = dem::CellPath{rates(rate, rate, rate, 0), {rates(rate, rate, rate, 0)}};
    Simulation sim(s);
    const EnergySums e = balance_of(sim);
    const double contacts = 24;
    const double sintering =
        contacts * u * simpson([&](double x) { return pair.driving(std::sqrt(2 * r * x * u)); }, 2000);
    const double viscous =
        contacts * u *
        simpson(
            [&](double x) {
              return M_PI * std::pow(2 * r * x * u, 2) / (8 * pair.diffusivity) * -rate * (2 * r - x * u);
            },
            2000);
    EXPECT_NEAR(e.sintering / sintering, 1, 1e-2) << int(model);
    EXPECT_NEAR(e.viscous / viscous, 1, 1e-2) << int(model);
    EXPECT_NEAR(e.boundary / (viscous - sintering), 1, 2e-2) << int(model);
    EXPECT_LT(std::abs(e.residual()), 2e-3 * viscous) << int(model);
  }
}

// Heat in a cell that stands still: what growth presses into the springs and what their softening takes is all that
// they store, and cold again they are as they were.  2e-3 of the energy when hot, the steps' share.
TEST(EnergyBalance, HeatInAClosedCell) {
  constexpr double r = 5e-6;
  dem::Material m = nickel_aluminide();
  m.youngs_modulus = PiecewiseLinear({{300, 190e9}, {900, 150e9}});
  m.activation_temperature = 2000;
  auto contact = elastic_model(dem::Elasticity::hertz, dem::unset);
  contact.damping_ratio = 0.05;
  EnergySums hot, cold;
  for (const bool back : {false, true}) {
    auto s = empty_setup(m, contact, hold(1, 300, 0));
    fill_periodic(s, Lattice::face_centred, 2, 2 * r * 0.995, r);
    const double time = 4000 * Simulation(s).step_limit().critical;
    std::vector<Stage> stages{{"heating", time, 900, 0}};
    if (back) stages.push_back({"cooling", time, 300, 0});
    s.schedule = Schedule(300, 0, stages);
    s.cell_path = dem::CellPath{{}, std::vector<dem::CellGoals>(stages.size())};
    Simulation sim(s);
    (back ? cold : hot) = balance_of(sim);
  }
  EXPECT_EQ(hot.boundary, 0);
  EXPECT_GT(hot.expansion, 0);
  EXPECT_LT(hot.stiffness, -0.1 * hot.stored);
  EXPECT_NEAR((hot.expansion + hot.stiffness) / (hot.stored - hot.stored_first), 1, 2e-3);
  EXPECT_LT(std::abs(cold.expansion + cold.stiffness), 2e-3 * hot.stored);
  EXPECT_NEAR(cold.stored / cold.stored_first, 1, 1e-9);
  EXPECT_LT(std::abs(cold.residual()), 2e-3 * hot.stored);
}

/// The example with cooling and unloading behind it.
dem::Setup whole_process(const std::vector<std::string>& overrides) {
  const auto scene = dem::read_scene(std::filesystem::path(DENSIFY_EXAMPLES) / "sinter_nial_rve", overrides);
  dem::Setup s = dem::make_setup(scene, dem::make_specimen(scene, 1, {}), 1);
  std::vector<Stage> stages = s.schedule.stages();
  stages.push_back({"cooling", 6000, 293.15, stages.back().end_pressure});
  stages.push_back({"unloading", 1000, 293.15, 0});
  s.schedule = Schedule(293.15, 0, stages);
  s.cell_path->stages.push_back(s.cell_path->stages.back());
  s.cell_path->stages.push_back(pressure(0));
  return s;
}

// A powder through loading, heating, sintering, cooling and unloading: the balance closes within 1 % of what is given,
// with and without friction, sheared or not, in steps of equalised inertia and of a mass factor; and the boundary's
// work is that of the cell's stress, the couples of which friction leaves unbalanced in motion.
TEST(EnergyBalance, WholeProcessOfAPowder) {
  const std::string small = "powder.1.number=200";
  for (const std::vector<std::string>& overrides : {std::vector<std::string>{},
                                                    {small, "integration.accuracy=", "integration.mass_scaling=1e18"},
                                                    {small, "contact.friction.coefficient=0.2"},
                                                    {small, "contact.friction.coefficient=0.2", "shear"}}) {
    const bool sheared = !overrides.empty() && overrides.back() == "shear";
    dem::Setup s = whole_process({overrides.begin(), overrides.end() - sheared});
    if (sheared)
      for (std::size_t stage = 1; stage < 4; ++stage) s.cell_path->stages[stage][3] = {CellControl::rate, 5e-5};
    Simulation sim(s);
    double work = 0;
    const EnergySums e = balance_of(sim, &work);
    const double given = std::abs(e.boundary) + std::abs(e.sintering) + std::abs(e.expansion) + std::abs(e.stiffness);
    const std::string what = overrides.empty() ? "the example" : overrides.back();
    EXPECT_LT(std::abs(e.residual()), 0.01 * given) << what;
    EXPECT_NEAR(e.boundary / work, 1, 1e-2) << what;
    EXPECT_GT(e.viscous, 0.4 * given) << what;
    EXPECT_EQ(e.friction > 1e-3 * given, s.contact.friction.has_value()) << what;
  }
}

// Adding up changes nothing.
TEST(EnergyBalance, ChangesNothing) {
  Simulation plain(dem::testing::driven_packing(1)), watched(dem::testing::driven_packing(1));
  EnergyBalance balance;
  EnergySums sums;
  dem::Recording recording;
  for (int n = 0; n < 300; ++n) {
    plain.advance(nullptr);
    balance.evaluate(watched, recording, sums);
    balance.move(watched, recording, sums);
  }
  EXPECT_EQ(StateBits(plain.state()), StateBits(watched.state()));
}

}  // namespace
}  // namespace densify::test
