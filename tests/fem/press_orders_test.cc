// Orders of the body's finite elements: a manufactured solution in space, halved steps in time, a thick-walled tube.

#include <deal.II/base/function.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/numerics/vector_tools.h>
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <array>
#include <cmath>
#include <numbers>

#include "fem/press/axes.h"
#include "fem/press/press_body.h"
#include "fem/press/viscous_solid.h"

namespace densify::fem {
namespace {

constexpr double radius = 6.5e-3, height = 8e-3, density = 0.65, pi = std::numbers::pi;

std::shared_ptr<ViscousSolid> solid(double youngs_modulus, double viscosity = 1e9) {
  SkorohodOlevsky::Parameters p;
  p.viscosity = viscosity, p.youngs_modulus = youngs_modulus, p.poissons_ratio = 0.3;
  p.surface_energy = 1, p.particle_radius = 5e-6;
  return std::make_shared<ViscousSolid>(std::make_shared<SkorohodOlevsky>(p));
}

/// The displacement that is to come out: smooth, no radial one on the axis, strains up to 0.3.
class Manufactured : public dealii::Function<2> {
 public:
  Manufactured() : dealii::Function<2>(2) {}
  double value(const dealii::Point<2>& x, unsigned c) const override {
    const double r = x[0] / radius, z = x[1] / height;
    return c == 0 ? 0.06 * x[0] * (1 - r * r) * std::cos(pi * z)
                  : -0.15 * x[1] + 0.03 * height * std::sin(pi * z) * std::cos(pi * r);
  }
  /// The deformation gradient, axes r theta z.
  Mat3 gradient_of_motion(const dealii::Point<2>& x) const {
    const double r = x[0] / radius, z = x[1] / height;
    Mat3 f = Mat3::Identity();
    f(0, 0) += 0.06 * (1 - 3 * r * r) * std::cos(pi * z);
    f(0, 2) = -0.06 * pi / height * x[0] * (1 - r * r) * std::sin(pi * z);
    f(1, 1) += 0.06 * (1 - r * r) * std::cos(pi * z);
    f(2, 0) = -0.03 * pi * height / radius * std::sin(pi * z) * std::sin(pi * r);
    f(2, 2) += -0.15 + 0.03 * pi * std::cos(pi * z) * std::cos(pi * r);
    return f;
  }
};

constexpr double step = 2;  // [s]: of the strain 4 parts of 5 are inelastic at E = 1e10 Pa

/// The exact motion of a point and what the material answers to it.
std::pair<PointMotion, PointAnswer> exact_point(const ViscousSolid& material, const Mat3& f) {
  PointMotion m;
  m.before = Mat3::Identity(), m.after = f, m.volume_after = f.determinant();
  const PointStep in{step_strain(m), step, 300, 300};
  std::vector<double> before(8), after(8);
  material.begin(density, before);
  PointAnswer out{};
  material.update({&in, 1}, before, after, {&out, 1});
  return {m, out};
}

struct Errors {
  double displacement, densification, stress;  // L2, relative to what is to come out
};

/// Solves for the body under the force per volume whose answer is the manufactured displacement u: its virtual work is
/// that of the first Piola-Kirchhoff stress of u on displacements that are zero on the surface, where u is prescribed.
Errors errors(int degree, int elements) {
  const auto material = solid(1e10);
  PressSettings settings;
  settings.degree = degree;  // no stiffness of the wall: no wall
  PressBody<2> body({radius, height, elements, elements}, material, density, 300, settings, MPI_COMM_WORLD);
  const Manufactured exact;
  const auto& dofs = body.dofs();
  const unsigned n = dofs.n_dofs();
  const auto& element = dofs.get_fe();

  Eigen::VectorXd load = Eigen::VectorXd::Zero(n);
  dealii::FEValues<2> values(
      body.mapping(), element, dealii::QGauss<2>(unsigned(degree) + 3),
      dealii::update_values | dealii::update_gradients | dealii::update_JxW_values | dealii::update_quadrature_points);
  std::vector<dealii::types::global_dof_index> at(element.dofs_per_cell);
  for (const auto& cell : dofs.active_cell_iterators()) {
    values.reinit(cell);
    cell->get_dof_indices(at);
    for (const unsigned q : values.quadrature_point_indices()) {
      const auto x = values.quadrature_point(q);
      const auto [m, answer] = exact_point(*material, exact.gradient_of_motion(x));
      const PointForce force = point_force(m, answer.stress, answer.tangent);
      const Vec9 piola = force.value.head<9>() + force.value[9] * cofactor_column(m.after);
      for (unsigned i = 0; i < at.size(); ++i) {
        const unsigned c = element.system_to_component_index(i).first;
        const auto g = values.shape_grad(i, q);
        double work = piola[axis<2>(int(c))] * g[0] + piola[axis<2>(int(c)) + 6] * g[1];
        if (c == 0) work += piola[4] * values.shape_value(i, q) / x[0];
        load[at[i]] += work * values.JxW(q) * around<2>(x[0]);
      }
    }
  }

  dealii::Vector<double> u(n), forces;
  dealii::VectorTools::interpolate(body.mapping(), dofs, exact, u);
  const dealii::IndexSet surface = dealii::DoFTools::extract_boundary_dofs(dofs);
  PressLoad outside{step, 300, radius, 1, 0.0};
  dealii::FullMatrix<double> tangent;
  double change = 1;
  for (int iteration = 0; iteration < 12 && change > 1e-13 * radius; ++iteration) {
    body.forces_of(outside, u, forces, tangent);
    Eigen::MatrixXd k(n, n);
    Eigen::VectorXd lack(n);
    for (unsigned i = 0; i < n; ++i) {
      const bool fixed = surface.is_element(i);
      for (unsigned j = 0; j < n; ++j) k(i, j) = fixed ? (i == j) : tangent(i, j);
      lack[i] = fixed ? 0 : load[i] - forces[i];
    }
    const Eigen::VectorXd du = k.partialPivLu().solve(lack);
    change = du.lpNorm<Eigen::Infinity>();
    for (unsigned i = 0; i < n; ++i) u[i] += du[i];
  }
  EXPECT_LT(change, 1e-12 * radius);
  body.forces_of(outside, u, forces, tangent);

  double off = 0, size = 0;
  for (const auto& cell : dofs.active_cell_iterators()) {
    values.reinit(cell);
    cell->get_dof_indices(at);
    for (const unsigned q : values.quadrature_point_indices()) {
      const auto x = values.quadrature_point(q);
      std::array<double, 2> found{};
      for (unsigned i = 0; i < at.size(); ++i)
        found[element.system_to_component_index(i).first] += values.shape_value(i, q) * u[at[i]];
      for (unsigned c = 0; c < 2; ++c) {
        off += values.JxW(q) * x[0] * std::pow(found[c] - exact.value(x, c), 2);
        size += values.JxW(q) * x[0] * std::pow(exact.value(x, c), 2);
      }
    }
  }
  Errors e{std::sqrt(off / size), 0, 0};
  double rho_off = 0, rho_size = 0, stress_off = 0, stress_size = 0;
  const auto points = body.points();  // places of the unloaded body, stresses in the frame that has not turned
  const auto densification = body.densification();
  for (std::size_t k = 0; k < points.size(); ++k) {
    const auto [m, answer] = exact_point(*material, exact.gradient_of_motion({points[k].place[0], points[k].place[2]}));
    const double w = body.weights()[k], wanted = std::log(answer.density / density);
    rho_off += w * std::pow(densification[k] - wanted, 2);
    rho_size += w * wanted * wanted;
    const Vec6& s = answer.stress;
    Mat3 stress;
    stress << s[0], s[5], s[4], s[5], s[1], s[3], s[4], s[3], s[2];
    stress_off += w * (points[k].stress - stress).squaredNorm();
    stress_size += w * stress.squaredNorm();
  }
  return {e.displacement, std::sqrt(rho_off / rho_size), std::sqrt(stress_off / stress_size)};
}

// Displacements of degree k are of order k + 1, pressures and with them stress and density of order k.
TEST(PressOrders, ManufacturedSolutionInSpace) {
  for (const int degree : {1, 2}) {
    Errors last{};
    for (int level = 0; level < 3; ++level) {
      const int elements = (degree == 1 ? 4 : 2) << level;
      const Errors now = errors(degree, elements);
      const Errors order{std::log2(last.displacement / now.displacement),
                         std::log2(last.densification / now.densification), std::log2(last.stress / now.stress)};
      if (level == 2) {
        EXPECT_GT(order.displacement, degree + 0.9) << degree;
        EXPECT_GT(order.densification, degree - 0.1) << degree;
        EXPECT_GT(order.stress, degree - 0.1) << degree;
      }
      last = now;
    }
  }
}

/// Mean density after 40 s of a pressure, or of one that grows to it, in `steps` steps, without friction.
double pressed(int steps, bool grows) {
  constexpr double duration = 40, pressure = 30e6;
  PressSettings settings;
  settings.wall_stiffness = 1e16;
  PressBody<2> body({radius, height, 1, 1}, solid(1e13), density, 300, settings, MPI_COMM_WORLD);
  for (int k = 1; k <= steps; ++k) {
    body.try_step({duration / steps, 300, radius, 1, grows ? pressure * k / steps : pressure});
    body.accept();
  }
  return body.densities().mean;
}

// A step answers with the stress at its end: second order where the stress stands still, first where it changes.
TEST(PressOrders, HalvedStepsInTime) {
  for (const bool grows : {false, true}) {
    const double coarse = pressed(20, grows), middle = pressed(40, grows), fine = pressed(80, grows);
    EXPECT_NEAR(std::log2((middle - coarse) / (fine - middle)), grows ? 1 : 2, 0.1) << grows;
  }
}

// A tube of inner radius a under the pressure p of the die, held between its punches (plane strain), elastic: Lame's
//   sigma_r = -P (1 - a^2/r^2), sigma_t = -P (1 + a^2/r^2), sigma_z = -2 nu P, P = p R^2/(R^2 - a^2),
// and the inner radius shrinks by 2 (1 - nu^2) a P/E (Timoshenko and Goodier, Theory of Elasticity, art. 28), E that of
// the porous solid.
TEST(PressOrders, ThickWalledTubeUnderPressure) {
  constexpr double a = 0.4 * radius, nu = 0.3, youngs_modulus = 1e11 * density * density;
  double last = 0;
  for (const int elements : {4, 8, 16}) {
    PressSettings settings;
    settings.wall_stiffness = 1e14;
    PressBody<2> tube({radius, height, elements, 2, a}, solid(1e11, 1e30), density, 300, settings, MPI_COMM_WORLD);
    const PressOutcome found = tube.try_step({1, 300, radius * (1 - 1e-6), 1, {}, 0});
    tube.accept();
    const double p = found.forces.wall_pressure / (2 * pi * radius * height);
    const double P = p * radius * radius / (radius * radius - a * a);
    double off = 0, volume = 0;
    for (const PointRecord& at : tube.points()) {
      const double share = std::pow(a / at.place[0], 2);
      const Vec3 lame = -P * Vec3(1 - share, 1 + share, 2 * nu);
      off += at.volume * (at.stress.diagonal() - lame).squaredNorm();
      volume += at.volume;
    }
    off = std::sqrt(off / volume) / P;
    double inner = 0;
    for (const double u : tube.displacement()) inner = std::min(inner, u);
    EXPECT_NEAR(inner * youngs_modulus / (-2 * (1 - nu * nu) * a * P), 1, 5e-5);  // strains of 1e-6, and the mesh
    if (elements == 16) {
      EXPECT_GT(std::log2(last / off), 1.9);
      EXPECT_LT(off, 1e-3);
    }
    last = off;
  }
}

}  // namespace
}  // namespace densify::fem
