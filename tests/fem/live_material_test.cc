// Volume elements of particles in finite elements: the density of a die-pressed element alone, going back, checkpoints,
// seeds, ranks, and what is refused.

#include "coupling/live_material.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>

#include "base/check.h"
#include "dem/specimen.h"
#include "fem/press/press_run.h"

namespace densify::coupling {
namespace {

constexpr double radius = 6.5e-3, height = 8e-3;

/// What all scenes here have in common; necks begin to sinter slowly, under a load that has pressed the grains before.
const std::string hot = R"(
[materials.NiAl]
library = "NiAl"
[contact]
elasticity = "hertz"
[contact.sintering]
model = "viscoelastic"
relaxation_time = "60 s"
viscosity_before = "1e12 N s/m"
tension_floor = 3e-4
[contact.sintering.pore_closure]
[integration]
method = "inertia_free"
mass_scaling = 1e17
skin = 1
[integration.inertia_free]
step_tolerance = 1e-3
force_tolerance = 1e-4
[process]
start_temperature = "700 degC"
start_pressure = "10 MPa"
[[process.stage]]
name = "heating"
duration = "30 min"
temperature = "1000 degC"
pressure = "20 MPa"
[[process.stage]]
name = "hold"
duration = "5 min"
)";

/// 40 grains packed at random.
dem::Scene grains(const std::vector<std::string>& overrides) {
  return dem::read_scene_text(hot + R"(
[[powder]]
material = "NiAl"
number = 40
sizes = "lognormal"
mean = "4 um"
standard_deviation = "0.5 um"
minimum = "3 um"
maximum = "5 um"
[specimen]
shape = "periodic"
[specimen.packing]
green_density = 0.60
)",
                              overrides);
}

/// 32 grains whose radii differ by up to 1 %, face-centred: they keep their neighbours, so that nothing jumps.
dem::Scene crystal() {
  const auto path = std::filesystem::path(testing::TempDir()) / ("live_crystal_" + std::to_string(getpid()) + ".csv");
  std::ofstream table(path);
  table << "x,y,z,radius,material\n";
  const double edge = 8 * std::numbers::sqrt2;
  for (int k = 0; k < 32; ++k) {
    const int cell = k / 4, corner = k % 4;
    const Vec3 at = edge * Vec3(cell % 2 + 0.25 + (corner == 1 || corner == 2 ? 0.5 : 0),
                                cell / 2 % 2 + 0.25 + (corner == 1 || corner == 3 ? 0.5 : 0),
                                cell / 4 + 0.25 + (corner == 2 || corner == 3 ? 0.5 : 0));
    table << at[0] << ',' << at[1] << ',' << at[2] << ',' << 4 * (1 + 0.01 * std::sin(37.0 * k)) << ",NiAl\n";
  }
  table.close();
  const std::string e = std::to_string(2 * edge) + " um";
  return dem::read_scene_text(hot + R"(
[specimen]
shape = "periodic"
[specimen.import]
length_unit = "1 um"
file = ")" + path.string() + R"("
[specimen.cell]
a = [")" + e + R"(", "0 um", "0 um"]
b = ["0 um", ")" + e + R"(", "0 um"]
c = ["0 um", "0 um", ")" + e + R"("]
)",
                              {});
}

struct Pressing {
  dem::Scene scene;
  std::shared_ptr<LiveMaterial> material;
  fem::PressBody<2> body;
  fem::PressRun<2> run;

  static fem::PressSettings settings(double friction) {
    fem::PressSettings s;
    s.friction = friction;
    s.wall_stiffness = 100 * 188e9 / radius;
    return s;
  }

  Pressing(const dem::Scene& s, int radial, int axial, ElementSeeds seeds, double friction, double accuracy,
           MPI_Comm comm)
      : scene(s),
        material(
            std::make_shared<LiveMaterial>(scene, LiveSettings{seeds, 1e-3}, std::size_t(radial * axial), 4, comm)),
        body({radius, height, radial, axial}, material, material->mean_density(), scene.schedule.temperature(0),
             degree_one(friction), comm),
        run(body, scene.schedule, {radius}, {accuracy, 1e-9, 1}) {}

  static fem::PressSettings degree_one(double friction) {
    auto s = settings(friction);
    s.degree = 1;
    return s;
  }
};

/// Densities of the same powder in a cell that the stages drive as a die does, at its own steps.
std::vector<std::pair<double, double>> die_pressed(const dem::Scene& scene) {
  dem::GreenBody body = pressed_powder(scene, 0, scene.schedule.pressure(0));
  dem::Setup setup = dem::make_setup(scene, body, 1);
  setup.integration.inertia_free.from = dem::InertiaFreeFrom::start;
  setup.integration.inertia_free.step_tolerance = 2e-4;
  dem::CellPath path;
  path.start[2] = {dem::CellControl::stress, -scene.schedule.pressure(0)};
  for (const Stage& stage : scene.schedule.stages()) {
    dem::CellGoals goals;
    goals[2] = {dem::CellControl::stress, -stage.end_pressure};
    path.stages.push_back(goals);
  }
  setup.cell_path = path;
  dem::Simulation sim(std::move(setup));
  std::vector<std::pair<double, double>> densities;
  double solid = 0;
  while (true) {
    if (solid == 0) sim.refresh();
    solid = 0;
    for (const dem::Body& b : sim.state().particles.body) solid += 4.0 / 3 * M_PI * std::pow(b.radius, 3);
    densities.push_back({sim.state().time, solid / sim.state().cell.volume()});
    if (sim.finished()) return densities;
    sim.advance();
  }
}

double at(const std::vector<std::pair<double, double>>& curve, double time) {
  std::size_t k = 1;
  while (k + 1 < curve.size() && curve[k].first < time) ++k;
  const auto& [t0, a] = curve[k - 1];
  const auto& [t1, b] = curve[k];
  return a + (b - a) * (time - t0) / (t1 - t0);
}

// One finite element without friction in its die is its volume element pressed in a die: the same density, solid over
// cell, at every time to 1e-3, though one is driven by strain and the other by stress, in other steps.  Contacts do the
// work of the stress to 1 %, and the element's density is that of the body.
TEST(LiveMaterial, OneElementIsItsVolumeElementInADie) {
  Pressing p(crystal(), 1, 1, ElementSeeds::one, 0, 3e-3, MPI_COMM_SELF);
  const auto alone = die_pressed(p.scene);
  const double mass = p.body.mass();
  while (!p.run.done()) {
    const fem::PressRow& row = p.run.advance();

    EXPECT_NEAR(row.density.mean, at(alone, row.time), 1e-3) << row.time;
    EXPECT_NEAR(row.density.mean, p.material->element(0).density(), 1e-9) << row.time;
  }
  EXPECT_GT(p.run.row().density.mean, alone.front().second + 0.03);
  EXPECT_NEAR(p.body.mass() / mass, 1, 1e-10);
  const LiveCount c = p.material->count();
  EXPECT_LT(c.mismatch_work, 1e-2 * c.contact_work);
  EXPECT_LT(c.largest_mismatch, 1e-2);
  EXPECT_GT(c.steps, std::uint64_t(p.run.row().steps));
}

// A step tried with another load leaves no trace: the next is bit for bit that of a body that never tried it.
TEST(LiveMaterial, ARefusedStepLeavesNoTrace) {
  const dem::Scene scene = crystal();
  Pressing tried(scene, 1, 2, ElementSeeds::one, 0, 1e-2, MPI_COMM_SELF),
      straight(scene, 1, 2, ElementSeeds::one, 0, 1e-2, MPI_COMM_SELF);
  const double hot_now = scene.schedule.temperature(0);
  const auto load = [&](double step, double pressure) { return fem::PressLoad{step, hot_now, radius, 1, pressure}; };
  tried.body.try_step(load(20, 10.5e6));
  tried.body.try_step(load(10, 10.1e6)), straight.body.try_step(load(10, 10.1e6));
  tried.body.accept(), straight.body.accept();
  EXPECT_EQ(tried.material->element(1).image(), straight.material->element(1).image());
  EXPECT_EQ(tried.body.state().points, straight.body.state().points);
}

// Images of the volume elements and the state of the body are all that a run goes on from, bit for bit.
TEST(LiveMaterial, GoesOnFromImagesBitForBit) {
  const dem::Scene scene = grains({});
  Pressing first(scene, 1, 2, ElementSeeds::each, 0.1, 1e-2, MPI_COMM_SELF),
      second(scene, 1, 2, ElementSeeds::each, 0.1, 1e-2, MPI_COMM_SELF);
  for (int k = 0; k < 4; ++k) first.run.advance();
  second.body.restore(first.body.state());
  second.run.restore(first.run.memory());
  second.material->restore(first.material->memory());
  for (int k = 0; k < 3; ++k) first.run.advance(), second.run.advance();
  EXPECT_EQ(first.body.state().points, second.body.state().points);
  EXPECT_EQ(first.material->memory().images, second.material->memory().images);
}

// With a seed for each, elements differ from the start and stay themselves; with one they begin alike, and without
// friction they stay alike to the tolerance of their stresses.
TEST(LiveMaterial, SeedsMakeElementsDiffer) {
  const dem::Scene scene = grains({});
  for (const ElementSeeds seeds : {ElementSeeds::one, ElementSeeds::each}) {
    Pressing p(scene, 1, 2, seeds, 0, 1e-2, MPI_COMM_SELF);
    while (p.run.row().time < 1200) p.run.advance();
    const double difference = std::abs(p.material->element(0).density() - p.material->element(1).density());
    if (seeds == ElementSeeds::one)
      EXPECT_LT(difference, 1e-4);
    else
      EXPECT_GT(difference, 1e-3);
  }
}

// All ranks together find what one alone does, within the balance of forces.
TEST(LiveMaterial, RanksAgree) {
  const dem::Scene scene = grains({});
  Pressing alone(scene, 1, 2, ElementSeeds::each, 0.1, 1e-2, MPI_COMM_SELF),
      together(scene, 1, 2, ElementSeeds::each, 0.1, 1e-2, MPI_COMM_WORLD);
  for (int k = 0; k < 4; ++k) {
    const fem::PressRow &a = alone.run.advance(), &b = together.run.advance();
    EXPECT_NEAR(a.density.mean, b.density.mean, 1e-6);
    EXPECT_NEAR(a.forces.bottom / b.forces.bottom, 1, 1e-3);
  }
  EXPECT_EQ(together.material->count().elements, 2u);
}

void expect_refused(const dem::Scene& scene, const std::string& key) {
  try {
    LiveMaterial(scene, {}, 1, 4, MPI_COMM_SELF);
    FAIL() << key;
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find(key), std::string::npos) << error.what();
  }
}

// What cannot be moved by an owner is refused with its key.
TEST(LiveMaterial, Refuses) {
  expect_refused(grains({"process.start_pressure=0 MPa"}), "process.start_pressure");
  expect_refused(grains({"specimen.packing.green_density=0.9"}), "green_density");
  dem::Scene s = grains({});
  s.contact.friction = dem::FrictionModel{};
  expect_refused(s, "contact.friction");
  s = grains({});
  s.container.shape = dem::ContainerShape::box;
  expect_refused(s, "specimen.shape");
}

}  // namespace
}  // namespace densify::coupling
