// Elements and wall of the body in the die: from displacements to forces and their derivative.

#include <deal.II/fe/fe_values.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "fem/press/axes.h"
#include "fem/press/press_body.h"
#include "fem/press/step_refused.h"

namespace densify::fem {

namespace {

/// Deformation gradients of an element's points for changes of its degrees of freedom: 9 rows (column by column) each.
template <int dim>
class Gradients {
 public:
  Gradients(const dealii::FEValues<dim>& values) : n_(values.dofs_per_cell) {
    const auto& element = values.get_fe();
    for (const unsigned q : values.quadrature_point_indices()) {
      Eigen::MatrixXd b = Eigen::MatrixXd::Zero(9, n_);
      for (unsigned i = 0; i < n_; ++i) {
        const int c = int(element.system_to_component_index(i).first);
        const auto gradient = values.shape_grad(i, q);
        for (int j = 0; j < dim; ++j) b(axis<dim>(c) + 3 * axis<dim>(j), i) = gradient[unsigned(j)];
        if (dim == 2 && c == 0) b(4, i) = values.shape_value(i, q) / values.quadrature_point(q)[0];
      }
      b_.push_back(std::move(b));
    }
  }

  const Eigen::MatrixXd& operator[](std::size_t q) const { return b_[q]; }

  Mat3 gradient(std::size_t q, const Eigen::VectorXd& u) const {
    const Eigen::Matrix<double, 9, 1> f = b_[q] * u;
    return Mat3::Identity() + Eigen::Map<const Mat3>(f.data());
  }

 private:
  unsigned n_;
  std::vector<Eigen::MatrixXd> b_;
};

/// L2 projection on the polynomials of degree - 1 of an element: values at points from values at points.
template <int dim>
Eigen::MatrixXd projection(const dealii::Quadrature<dim>& points, int degree, const Eigen::VectorXd& weight) {
  const Eigen::Index n = Eigen::Index(points.size());
  Eigen::MatrixXd modes = Eigen::MatrixXd::Ones(n, degree == 1 ? 1 : dim + 1);
  if (degree > 1)
    for (Eigen::Index q = 0; q < n; ++q)
      for (int j = 0; j < dim; ++j) modes(q, j + 1) = points.point(unsigned(q))[unsigned(j)] - 0.5;
  const Eigen::MatrixXd weighted = weight.asDiagonal() * modes;
  const Eigen::MatrixXd gram = modes.transpose() * weighted;
  return modes * gram.ldlt().solve(weighted.transpose());
}

const auto element_needs =
    dealii::update_values | dealii::update_gradients | dealii::update_JxW_values | dealii::update_quadrature_points;

}  // namespace

template <int dim>
void PressBody<dim>::strain_points(const PressLoad& load, const dealii::Vector<double>& tried) {
  dealii::FEValues<dim> values(mapping_, element_, points_of_cell_, element_needs);
  const unsigned n = element_.dofs_per_cell, points = points_of_cell_.size();
  Dofs dofs(n);
  Eigen::VectorXd u(n), volume(points);
  std::size_t first = 0;
  for (const auto& cell : dofs_.active_cell_iterators()) {
    if (!cell->is_locally_owned()) continue;
    values.reinit(cell);
    const Gradients<dim> b(values);
    cell->get_dof_indices(dofs);
    for (unsigned i = 0; i < n; ++i) u[i] = tried[dofs[i]];
    for (unsigned q = 0; q < points; ++q) {
      motion_[first + q].after = b.gradient(q, u);
      volume[q] = motion_[first + q].after.determinant();
      if (!(volume[q] > 0)) throw StepRefused("an element is turned inside out");
    }
    const Eigen::VectorXd few =
        projection(points_of_cell_, settings_.degree, Eigen::Map<const Eigen::VectorXd>(&weight_[first], points)) *
        volume;
    for (unsigned q = 0; q < points; ++q) {
      PointMotion& m = motion_[first + q];
      m.volume_after = few[q];
      if (!(m.volume_after > 0)) throw StepRefused("an element has lost its volume at a point");
      step_[first + q] = {step_strain(m), load.step, temperature_, load.temperature,
                          weight_[first + q] * m.volume_before};
    }
    first += points;
  }
}

template <int dim>
void PressBody<dim>::move_points(const PressLoad& load, const dealii::Vector<double>& tried) {
  strain_points(load, tried);
  material_->update(step_, state_, tried_state_, answer_);
}

template <int dim>
void PressBody<dim>::visit_elements(PressForces& forces, double& within, const Sink& sink) {
  dealii::FEValues<dim> values(mapping_, element_, points_of_cell_, element_needs);
  const unsigned n = element_.dofs_per_cell, points = points_of_cell_.size();
  Dofs dofs(n);
  dealii::FullMatrix<double> stiffness(n, n);
  dealii::Vector<double> force(n);
  Eigen::MatrixXd k(n, n), cofactor_rows(points, n);
  Eigen::VectorXd f(n), pressure(points);
  std::size_t first = 0;
  for (const auto& cell : dofs_.active_cell_iterators()) {
    if (!cell->is_locally_owned()) continue;
    values.reinit(cell);
    const Gradients<dim> b(values);
    cell->get_dof_indices(dofs);
    const Eigen::Map<const Eigen::VectorXd> weight(&weight_[first], points);
    const Eigen::MatrixXd to_few = projection(points_of_cell_, settings_.degree, weight);
    for (unsigned q = 0; q < points; ++q)
      cofactor_rows.row(q) = cofactor_column(motion_[first + q].after).transpose() * b[q];
    const Eigen::MatrixXd few_rows = to_few * cofactor_rows;  // d(volume ratio)/du
    k.setZero(), f.setZero();
    for (unsigned q = 0; q < points; ++q) {
      const PointForce p = point_force(motion_[first + q], answer_[first + q].stress, answer_[first + q].tangent);
      const auto volume = few_rows.row(q).transpose();
      pressure[q] = p.value[9];
      f += weight[q] * (b[q].transpose() * p.value.template head<9>() + p.value[9] * volume);
      const Eigen::MatrixXd db =
          p.derivative.template leftCols<9>() * b[q] + p.derivative.col(9) * volume.transpose();  // d(T, p)/du
      k += weight[q] * (b[q].transpose() * db.template topRows<9>() + volume * db.row(9));
    }
    const Eigen::VectorXd few_pressure = to_few * pressure;  // the projection is its own adjoint in the weights
    for (unsigned q = 0; q < points; ++q)
      k += weight[q] * few_pressure[q] * (b[q].transpose() * cofactor_slope(motion_[first + q].after) * b[q]);
    for (unsigned i = 0; i < n; ++i) {
      force[i] = f[i];
      for (unsigned j = 0; j < n; ++j) stiffness(i, j) = k(i, j);
      if (punch_[dofs[i]] == 1) forces.punch -= f[i];
      if (punch_[dofs[i]] == 2) forces.bottom += f[i];
    }
    within += f.squaredNorm();
    sink(stiffness, force, dofs);
    first += points;
  }
}

template <int dim>
void PressBody<dim>::visit_wall(const PressLoad& load, const dealii::Vector<double>& tried, PressOutcome& outcome,
                                const Sink& sink) {
  dealii::FEFaceValues<dim> values(
      mapping_, element_, points_of_face_,
      dealii::update_values | dealii::update_JxW_values | dealii::update_quadrature_points);
  DieWall die{load.die_radius, settings_.wall_stiffness, shear_, settings_.friction, load.die_rise};
  const unsigned n = element_.dofs_per_cell;
  Dofs dofs(n);
  dealii::FullMatrix<double> stiffness(n, n);
  dealii::Vector<double> force(n);
  std::size_t point = 0;
  for (const auto& cell : dofs_.active_cell_iterators()) {
    if (!cell->is_locally_owned()) continue;
    for (const unsigned face : cell->face_indices()) {
      if (!cell->face(face)->at_boundary() || cell->face(face)->boundary_id() != wall) continue;
      values.reinit(cell, face);
      cell->get_dof_indices(dofs);
      stiffness = 0, force = 0;
      for (const unsigned q : values.quadrature_point_indices()) {
        const auto& x = values.quadrature_point(q);
        Vec3 before = Vec3::Zero();
        for (int c = 0; c < dim; ++c) before[axis<dim>(c)] = x[unsigned(c)];
        Vec3 after = before;
        // The mesh's facets stand for the cylinder: each of their points touches the bore when the cylinder would.
        die.radius = load.die_radius + Vec3(before[0], before[1], 0).norm() - radius_;
        for (unsigned i = 0; i < n; ++i) {
          const int a = axis<dim>(int(element_.system_to_component_index(i).first));
          before[a] += values.shape_value(i, q) * displacement_[dofs[i]];
          after[a] += values.shape_value(i, q) * tried[dofs[i]];
        }
        const WallTraction t = wall_traction(die, closed_[point], before, after, friction_[point]);
        tried_friction_[point] = t.friction;
        depth_[point] = t.depth;
        outcome.largest_slip = std::max(outcome.largest_slip, t.slip);
        covered_[point] = after[2] <= load.die_top + tried[bottom_.front()];
        if (!closed_[point++]) continue;
        const double w = values.JxW(q) * around<dim>(x[0]);
        const Vec3 normal = Vec3(after[0], after[1], 0).normalized();
        outcome.forces.wall_pressure -= w * t.value.dot(normal);
        outcome.forces.wall_friction += w * t.friction[2];
        outcome.slid -= w * t.friction.dot(after - before - Vec3(0, 0, load.die_rise));
        for (unsigned i = 0; i < n; ++i) {
          const int a = axis<dim>(int(element_.system_to_component_index(i).first));
          const double share = w * values.shape_value(i, q);
          force[i] -= share * t.value[a];
          for (unsigned j = 0; j < n; ++j)
            stiffness(i, j) -= share * values.shape_value(j, q) *
                               t.derivative(a, axis<dim>(int(element_.system_to_component_index(j).first)));
        }
      }
      for (unsigned i = 0; i < n; ++i) {
        if (punch_[dofs[i]] == 1) outcome.forces.punch -= force[i];
        if (punch_[dofs[i]] == 2) outcome.forces.bottom += force[i];
      }
      sink(stiffness, force, dofs);
    }
  }
}

template class PressBody<2>;
template class PressBody<3>;

}  // namespace densify::fem
