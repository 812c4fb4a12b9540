// Tables of what volume elements answer: interpolation, symmetry, the loose powder in closed form, the file, and one
// test a mistake.

#include <gtest/gtest.h>
#include <unistd.h>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <cmath>

#include "base/check.h"
#include "base/elastic_tensor.h"
#include "coupling/point_path.h"
#include "coupling/press_scene.h"
#include "coupling/table_law.h"
#include "fem/press/viscous_solid.h"

namespace densify::coupling {
namespace {

// Through the nodes, between neighbours' values everywhere, and of second order at least: a cubic's values are met to
// the fourth power of the distance where it is monotone, here to 1e-4 with nodes 0.1 apart.
TEST(ShapePreserving, PassesNothing) {
  std::vector<double> x;
  Eigen::MatrixXd y(2, 11);
  for (int k = 0; k <= 10; ++k) x.push_back(0.1 * k), y.col(k) << std::pow(0.1 * k, 3), k < 5 ? 0 : 1;
  const ShapePreserving curve(x, y);
  for (int k = 0; k <= 10; ++k) EXPECT_NEAR((curve(0.1 * k) - y.col(k)).norm(), 0, 1e-15);
  for (double t = 0; t <= 1; t += 0.01) {
    EXPECT_NEAR(curve(t)[0], t * t * t, 7.5e-3);
    EXPECT_GE(curve(t)[1], -1e-14);
    EXPECT_LE(curve(t)[1], 1 + 1e-14);
  }
  EXPECT_EQ(curve(-1)[0], 0);
  EXPECT_EQ(curve(2)[0], 1);
}

// The part that turns about z leave alone is the mean over all of them (here over 360), and is a tensor's own when it
// is already so.
TEST(AxialTensor, IsTheMeanOverTurns) {
  Mat6 a = Mat6::Random();
  const Mat6 c = a * a.transpose();
  Mat6 mean = Mat6::Zero();
  for (int k = 0; k < 360; ++k) mean += rotated(c, Mat3(Eigen::AngleAxisd(k * M_PI / 180, Vec3::UnitZ()))) / 360;
  EXPECT_LT((full_tensor(axial_part(c)) - mean).norm() / c.norm(), 1e-12);
  EXPECT_LT((full_tensor(axial_part(mean)) - mean).norm() / c.norm(), 1e-12);
  EXPECT_LT((inverse_tensor(axial_part(c)) * full_tensor(axial_part(c)) - Mat6::Identity()).norm(), 1e-10);
}

// A powder that yields in a die under axial and lateral pressure does so without lateral strain: the direction of
// sliding, yield : stress, has no lateral component.
TEST(Yield, OfADieIsAxial) {
  for (const double lateral : {20e6, 25e6, 29.5e6}) {
    const Mat6 y = yield_of(30e6, lateral);
    const Vec6 stress = (Vec6() << -lateral, -lateral, -30e6, 0, 0, 0).finished();
    EXPECT_NEAR(stress.dot(y * stress), 1, 1e-12);
    const Vec6 direction = y * stress;
    EXPECT_NEAR(direction[0] / direction[2], 0, 1e-12);
    EXPECT_GT(Eigen::SelfAdjointEigenSolver<Mat6>(y).eigenvalues()[0], 0);
  }
}

SinteringNode necked(double density, double viscosity, double stress) {
  return {density,
          axial_part(fem::isotropic_tensor(2 * viscosity, viscosity)),
          axial_part(fem::isotropic_tensor(0.5, 0.3)),
          {stress, stress},
          0.1,
          0.05,
          0.2,
          0};
}

/// A made-up powder: yields at 20 MPa (density/0.7)^20, viscosity and sintering stress of its own.
ResponseTable made_up() {
  ResponseTable t;
  t.material = "M", t.scene = "title = \"made up\"", t.revision = "none";
  t.particles = 10, t.elements = 2;
  t.reference_temperature = 1600, t.activation_temperature = 900;
  t.diffusion = {1.2e-29, 1e-5, 2e5, 1e-9};
  t.thermal_expansion = 1e-5;
  t.youngs_modulus = PiecewiseLinear({{300, 200e9}, {1600, 150e9}});
  for (double rho = 0.6; rho < 0.7401; rho += 0.005) {
    const double p = 20e6 * std::pow(rho / 0.7, 20);
    t.cold.push_back({rho, p, 0.9 * p, 0.002, axial_part(fem::isotropic_tensor(0.5, 0.3))});
  }
  for (const double birth : {0.65, 0.7}) {
    SinteringBranch b{"die", birth, birth / 0.7, {}};
    for (int k = 0; k <= 20; ++k) {
      const double rho = birth * std::pow(0.98 / birth, k / 20.0);
      b.nodes.push_back(necked(rho, 1e9 * std::exp(10 * k / 20.0), 1e6 * (1 + k / 20.0)));
    }
    t.sintering.push_back(b);
  }
  t.check = {0.8, 2, {1, 2}, {300, 1600}, {0.7, 0.9}, {0.7, 0.9}, 0.01, 0.002};
  return t;
}

// Under a pressure that grows, the powder in a die follows its curve: the density at which it yields at that pressure.
// What is left is elastic slip, 1e-4 of the pressure for a strain of 1 %: 1e-5 of the density.
TEST(TableLaw, LoosePowderFollowsItsCurve) {
  const fem::ViscousSolid material(std::make_shared<TableLaw>(made_up(), false));
  const Schedule load(300, 0, {{"load", 100, 300, 20e6}, {"unload", 100, 300, 18e6}, {"again", 100, 300, 30e6}});
  const auto density = drive_point(material, load, PathKind::die, 0.62, {50, 100, 200, 216, 300});
  const auto curve = [](double p) { return 0.7 * std::pow(p / 20e6, 1 / 20.0); };
  EXPECT_NEAR(density[0], curve(10e6), 2e-4);  // nodes 0.005 apart
  EXPECT_NEAR(density[1], 0.7, 2e-4);
  EXPECT_NEAR(density[2], density[1], 1e-6);  // what has been pressed stays
  EXPECT_NEAR(density[3], density[1], 1e-6);  // and yields again only where it had yielded
  EXPECT_NEAR(density[4], curve(30e6), 2e-4);

  const TableLaw law(made_up(), false);
  EXPECT_NEAR(*law.presses_to(10e6), curve(10e6), 2e-4);
  EXPECT_NEAR(*law.presses_to(20e6), 0.7, 2e-4);
  EXPECT_FALSE(law.presses_to(1.01 * law.loose_pressures().second));
  EXPECT_FALSE(law.presses_to(0.99 * law.loose_pressures().first));
}

// Tangents of a step in which the powder slides, or flows, against central differences; the law's own slopes are
// quotients over 1e-6 of the density, of which 1e-5 is off.
TEST(TableLaw, TangentsAreDerivatives) {
  const fem::ViscousSolid material(std::make_shared<TableLaw>(made_up(), false));
  for (const bool hot : {false, true}) {
    std::vector<double> state(material.state_size()), after(state.size());
    material.begin(0.68, state);
    const Vec6 strain = (Vec6() << -0.002, 0.001, -0.01, 0.001, 0.002, -0.001).finished();
    const auto at = [&](const Vec6& e) {
      const fem::PointStep step{e, 10, hot ? 1500.0 : 300, hot ? 1500.0 : 300};
      fem::PointAnswer answer{};
      material.update({&step, 1}, state, after, {&answer, 1});
      return answer;
    };
    const Mat6 tangent = at(strain).tangent;
    for (int c = 0; c < 6; ++c) {
      const Vec6 d = 1e-7 * Vec6::Unit(c);
      const Vec6 difference = (at(strain + d).stress - at(strain - d).stress) / 2e-7;
      EXPECT_LT((tangent.col(c) - difference).norm() / tangent.norm(), 1e-4) << hot << c;
    }
  }
}

// At the nodes of a branch the law has the branch's numbers, elsewhere in temperature by the diffusion; between two
// branches at the same share of the way a mean.
TEST(TableLaw, HasTheNodesOfTheTable) {
  const ResponseTable t = made_up();
  const TableLaw law(t, false);
  const auto& node = t.sintering[0].nodes[7];
  const auto flow = law.flow({node.density, 1600, 0.65});
  EXPECT_LT((flow.fluidity * full_tensor(node.viscosity) - Mat6::Identity()).norm(), 1e-9);
  EXPECT_NEAR(flow.sintering_stress[2], node.sintering_stress[1], 1e-3);
  const Mat6 stiffness = law.strength({node.density, 1600, 0.65}).stiffness;
  EXPECT_LT((stiffness - 150e9 * full_tensor(node.stiffness)).norm() / stiffness.norm(), 1e-12);
  const auto cooler = law.flow({node.density, 1400, 0.65});
  EXPECT_NEAR(cooler.fluidity(2, 2) / flow.fluidity(2, 2), t.diffusion.effective(1400) / t.diffusion.effective(1600),
              1e-9);
  const double between = 0.675, rho = between * std::pow(0.98 / between, 7 / 20.0);
  EXPECT_NEAR(law.flow({rho, 1600, between}).sintering_stress[2], node.sintering_stress[1], 1e-3);
}

// No state beyond the table without a word; with "clamp" the viscosity grows as 1/porosity, so that no pore closes.
TEST(TableLaw, EndsWithAWord) {
  const TableLaw strict(made_up(), false), clamped(made_up(), true);
  EXPECT_EQ(strict.outside({0.7, 300, 0}), "");
  EXPECT_NE(strict.outside({0.75, 300, 0}).find("from 0.6000 to 0.7400"), std::string::npos);
  EXPECT_NE(strict.outside({0.985, 1600, 0.68}).find("0.9800"), std::string::npos);
  EXPECT_NE(strict.outside({0.8, 1600, 0.6}).find("necks begin"), std::string::npos);
  EXPECT_EQ(clamped.outside({0.985, 1600, 0.68}), "");
  EXPECT_NEAR(clamped.flow({0.99, 1600, 0.68}).fluidity(2, 2) / clamped.flow({0.98, 1600, 0.68}).fluidity(2, 2), 0.5,
              1e-9);
}

TEST(ResponseTable, ReadsBackWhatIsWritten) {
  const auto path = std::filesystem::temp_directory_path() / ("densify_table_" + std::to_string(getpid()) + ".h5");
  const ResponseTable t = made_up();
  write_table(path, t);
  const ResponseTable r = read_table(path);
  std::filesystem::remove(path);
  EXPECT_EQ(r.scene, t.scene);
  EXPECT_EQ(r.cold.size(), t.cold.size());
  EXPECT_EQ(r.sintering[1].birth, 0.7);
  EXPECT_EQ(r.sintering[1].nodes[3].viscosity, t.sintering[1].nodes[3].viscosity);
  EXPECT_EQ(r.youngs_modulus(1000), t.youngs_modulus(1000));
  EXPECT_EQ(r.check.error, 0.002);
  EXPECT_THROW(read_table(path), InputError);
}

// The table that is shipped, along the process of its example, is the volume elements it was made of: beside the path
// that is not among its branches it is off by what it says.
TEST(ResponseTable, ShippedOneKeepsItsWord) {
  const ResponseTable t = read_table(DENSIFY_EXAMPLES "/press_nial_table/nial.h5");
  ASSERT_GT(t.check.time.size(), 20u);
  EXPECT_LT(t.check.error, 0.01);
  const PressScene scene = read_press_scene(DENSIFY_EXAMPLES "/press_nial_table", {});
  ElementPath path;
  path.pressure_factor = t.check.pressure_factor, path.heating_factor = t.check.heating_factor;
  const Schedule schedule = path_schedule(*scene.schedule, path, t.activation_temperature);
  const fem::ViscousSolid material(std::make_shared<TableLaw>(t, true));
  const auto density = drive_point(material, schedule, PathKind::die, t.cold.front().density, t.check.time);
  for (std::size_t k = 0; k < density.size(); ++k)
    EXPECT_NEAR(density[k], t.check.element[k],
                (t.check.temperature[k] < t.activation_temperature ? t.check.loose_error : t.check.error) + 1e-6);
}

// The process up to the end of its highest temperature, changed, then held on; a free element is let go once necks
// hold.
TEST(ElementPath, ScheduleOfAPath) {
  const Schedule process(300, 0, {{"load", 100, 300, 10e6}, {"heat", 1000, 1300, 10e6}, {"cool", 500, 300, 0}});
  const Schedule die = path_schedule(process, {PathKind::die, 2, 4, 0.99, 50}, 800);
  EXPECT_DOUBLE_EQ(die.end(), 100 + 250 + 50);
  EXPECT_DOUBLE_EQ(die.peak_pressure(), 20e6);
  EXPECT_DOUBLE_EQ(die.temperature(die.end()), 1300);
  const Schedule free = path_schedule(process, {PathKind::free, 1, 1, 0.99, 50}, 800);
  EXPECT_DOUBLE_EQ(free.temperature(100 + 520), 820);
  EXPECT_DOUBLE_EQ(free.pressure(100 + 520), 10e6);
  EXPECT_DOUBLE_EQ(free.pressure(100 + 520 + 120), 0);
  EXPECT_THROW(path_schedule(process, {}, 2000), InputError);
}

TEST(ElementPath, NeedsOneMaterialThatSinters) {
  auto scene = read_press_scene(DENSIFY_EXAMPLES "/press_nial_table", {});
  dem::Scene element = *scene.element;
  element.contact.sintering.reset();
  EXPECT_THROW(activation_of(element), InputError);
  element = *scene.element;
  element.materials.push_back(element.materials[0]);
  EXPECT_THROW(activation_of(element), InputError);
}

}  // namespace
}  // namespace densify::coupling
