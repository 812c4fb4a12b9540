// The extremes for every way of stepping: masses from an accuracy, no inertia, and a periodic cell that stresses drive.

#include <gtest/gtest.h>

#include "dem/measure/measures.h"
#include "tests/dem/small_packings.h"
#include "tests/extremes/necked_pair.h"
#include "tests/extremes/stopped.h"

namespace densify::test {
namespace {

using dem::CellControl;
using dem::CellGoals;

struct Mode {
  const char* name;
  void (*choose)(Setup&);
};

const Mode modes[] = {
    {"accuracy",
     [](Setup& s) {
       s.integration.mass_scaling = 1;
       choose_settings(s.integration, 3e-3);
     }},
    {"inertia_free",
     [](Setup& s) {
       s.integration.method = dem::IntegrationMethod::inertia_free;
       s.integration.inertia_free.from = dem::InertiaFreeFrom::start;
       s.contact.friction.reset();  // which these steps refuse
       s.particles.angular_velocity.clear();
     }},
};

class Modes : public ::testing::TestWithParam<Mode> {
 protected:
  dem::Setup packing(const Schedule& schedule) const {
    auto s = dem::testing::cylinder_packing(1);
    s.contact.damping_ratio = 0.5;
    s.schedule = schedule;
    GetParam().choose(s);
    return s;
  }
};

double density(Simulation& sim) {
  dem::Recording record;
  sim.evaluate(&record);
  const auto m = measure(sim, record);
  sim.move();
  EXPECT_TRUE(m.stress.allFinite());
  return m.relative_density;
}

// All pressure within a millionth of the process: the punch carries it in the mean, or the run says what stopped it.
TEST_P(Modes, PressureAtOnce) {
  for (const double pressure : {3e7, 1e9}) {
    Simulation sim(packing(Schedule(953, 0, {{"jump", 1e-6, 953, pressure}, {"hold", 1, 953, pressure}})));
    expect_pressure_is_carried(sim, pressure, 0.5);
  }
}

// The pressure is taken away at once from a body with necks, three dozen spheres: it springs back by its overlaps of
// some per cent of a radius and stays.
TEST_P(Modes, PressureTakenAwayAtOnce) {
  Simulation sim(packing(Schedule(953, 0,
                                  {{"press", 0.3, 953, 3e7},
                                   {"sinter", 0.3, 960, 3e7},
                                   {"cool", 0.3, 950, 3e7},
                                   {"let go", 1e-6, 950, 0},
                                   {"rest", 1, 950, 0}})));
  while (sim.state().time < 0.9) sim.advance();
  const double pressed = density(sim);
  run_to_end(sim);
  EXPECT_NEAR(density(sim) / pressed, 1, 0.03);
}

// Activation while the load rises, back through it, again, cold and unloaded: densities never fall but by the elastic
// part of the last.
TEST_P(Modes, ActivationThereAndBackAgain) {
  Simulation sim(packing(Schedule(953, 0,
                                  {{"press and heat", 0.3, 960, 30e6},
                                   {"cool", 0.3, 950, 30e6},
                                   {"heat", 0.3, 960, 30e6},
                                   {"cool again", 0.3, 950, 30e6},
                                   {"unload", 0.3, 950, 0}})));
  double before = 0;
  for (const double stage : {0.3, 0.6, 0.9, 1.2}) {
    while (sim.state().time < stage) sim.advance();
    const double now = density(sim);
    EXPECT_GT(now, before - 2e-3) << stage;
    before = now;
  }
  run_to_end(sim);
  EXPECT_GT(density(sim), before - 0.02);
}

// One sphere, two, three in a box that none of them touches: nothing moves them, nothing is undefined, it ends.
TEST_P(Modes, NoneInContact) {
  for (const int number : {1, 2, 3}) {
    auto s = empty_setup(copper(), elastic_model(dem::Elasticity::hertz, dem::unset), hold(1, 300, 0));
    s.container.shape = dem::ContainerShape::box;
    s.container.size = Vec3::Constant(5e-4);
    s.container.punch = false;
    for (int i = 0; i < number; ++i) add_sphere(s.particles, (1 + i) * Vec3::Constant(1e-4), 5e-6, Vec3::Zero());
    GetParam().choose(s);
    Simulation sim(s);
    run_at_most(sim, 20'000);
    EXPECT_TRUE(sim.finished());
    for (int i = 0; i < number; ++i)
      EXPECT_EQ(body(sim, std::uint32_t(i)).position, Vec3((1 + i) * Vec3::Constant(1e-4)));
  }
}

INSTANTIATE_TEST_SUITE_P(All, Modes, ::testing::ValuesIn(modes), [](const auto& i) { return i.param.name; });

/// A periodic packing of loose grains, all six stresses driven: to `pressure` at the end of the first stage, then to 0.
Setup driven(double pressure, std::vector<Stage> stages) {
  auto s = dem::testing::periodic_packing(1);
  s.cell.velocity_gradient.setZero();
  s.contact.damping_ratio = 0.5;
  s.schedule = Schedule(300, 0, std::move(stages));
  const auto goals = [](double p) {
    CellGoals g;
    for (std::size_t c = 0; c < 6; ++c) g[c] = {CellControl::stress, c < 3 ? -p : 0};
    return g;
  };
  s.cell_path = dem::CellPath{{}, {goals(pressure)}};
  for (auto& c : s.cell_path->start) c = {CellControl::stress, 0};
  while (s.cell_path->stages.size() < s.schedule.stages().size()) s.cell_path->stages.push_back(goals(0));
  return s;
}

// 30 MPa on the cell within a millionth of the process: carried in the mean to 1 %.
TEST(DrivenCell, PressureAtOnce) {
  for (const bool equalised : {false, true}) {
    auto s = driven(3e7, {{"jump", 1e-6, 300, 0}, {"hold", 1, 300, 0}});
    s.cell_path->stages[1] = s.cell_path->stages[0];
    if (equalised) modes[0].choose(s);
    Simulation sim(s);
    double impulse = 0, time = 0;
    while (!sim.finished()) {
      sim.advance();
      if (sim.state().time < 0.5) continue;
      impulse += sim.cell_stress().trace() / 3 * sim.state().last_step;
      time += sim.state().last_step;
    }
    EXPECT_NEAR(impulse / time / -3e7, 1, 0.01);
  }
}

// The pressure is taken away at once from grains without necks: the cell springs apart.  That is no answer, and said.
TEST(DrivenCell, OfLooseGrainsThatFlyApartIsStopped) {
  for (const bool equalised : {false, true}) {
    auto s = driven(3e7, {{"press", 1, 300, 0}, {"let go", 1e-3, 300, 0}, {"rest", 100, 300, 0}});
    s.contact.damping_ratio = 0.05;
    if (equalised) modes[0].choose(s);
    Simulation sim(s);
    EXPECT_STOPS(run_at_most(sim, 2'000'000), "no two particles touch", "some pressure");
  }
}

// Without contact no force acts on the cell, and no damper either: it goes on as it is (a damper against the running
// mean of its rate once drove it).
TEST(DrivenCell, WithoutContactKeepsItsRate) {
  auto s = driven(0, {{"free", 1, 300, 0}});
  for (double& r : s.particles.reference_radius) r *= 0.5;
  s.cell.velocity_gradient = 1e-4 * Mat3::Identity();
  Simulation sim(s);
  dem::State state = sim.state();
  sim.advance();
  state = sim.state();
  state.cell_drive.mean = {3e-4, 3e-4, 3e-4, 0, 0, 0};
  state.cell_drive.slope = {1e-3, 1e-3, 1e-3, 0, 0, 0};
  sim.restore(state);
  run_at_most(sim, 100);
  EXPECT_EQ(sim.state().cell.velocity_gradient, Mat3(1e-4 * Mat3::Identity()));
}

}  // namespace
}  // namespace densify::test
