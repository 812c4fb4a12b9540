#include "fem/press/press_state.h"

#include "base/check.h"
#include "fem/press/gathered.h"
#include "fem/press/press_body.h"

namespace densify::fem {

namespace {

constexpr std::size_t motion_numbers = 19, wall_numbers = 4;

}  // namespace

template <int dim>
PressState PressBody<dim>::state() const {
  PressState s;
  Dofs dofs(element_.dofs_per_cell);
  for (const auto& cell : dofs_.active_cell_iterators()) {
    cell->get_dof_indices(dofs);
    for (const auto d : dofs) s.displacement.push_back(displacement_[d]), s.before.push_back(before_[d]);
  }
  const std::size_t n = material_->state_size();
  std::vector<double> points, wall;
  for (std::size_t k = 0; k < motion_.size(); ++k) {
    const PointMotion& m = motion_[k];
    points.insert(points.end(), m.before.data(), m.before.data() + 9);
    points.push_back(m.volume_before);
    points.insert(points.end(), m.turned.data(), m.turned.data() + 9);
    points.insert(points.end(), state_.begin() + std::ptrdiff_t(n * k), state_.begin() + std::ptrdiff_t(n * (k + 1)));
  }
  for (std::size_t k = 0; k < friction_.size(); ++k) {
    wall.insert(wall.end(), friction_[k].data(), friction_[k].data() + 3);
    wall.push_back(accepted_closed_[k]);
  }
  s.points = gathered(points, comm_);
  s.wall = gathered(wall, comm_);
  s.temperature = temperature_;
  s.last_step = last_step_;
  s.largest_scale = largest_scale_;
  s.shear = shear_;
  s.punch_closed = accepted_punch_closed_;
  return s;
}

template <int dim>
void PressBody<dim>::restore(const PressState& s) {
  const std::size_t n = material_->state_size(), each = motion_numbers + n;
  Dofs dofs(element_.dofs_per_cell);
  if (s.displacement.size() != mesh_.n_active_cells() * dofs.size() || s.before.size() != s.displacement.size())
    throw InputError("the checkpoint is of another mesh");
  std::size_t k = 0;
  for (const auto& cell : dofs_.active_cell_iterators()) {
    cell->get_dof_indices(dofs);
    for (const auto d : dofs) displacement_[d] = s.displacement[k], before_[d] = s.before[k++];
  }
  tried_ = displacement_;
  const auto all = [&](std::size_t own) { return dealii::Utilities::MPI::sum(own, comm_); };
  if (s.points.size() != each * all(motion_.size()) || s.wall.size() != wall_numbers * all(friction_.size()))
    throw InputError("the checkpoint is of another mesh or material");
  std::size_t first = first_of_rank(motion_.size(), comm_);
  for (std::size_t p = 0; p < motion_.size(); ++p) {
    const double* x = s.points.data() + each * (first + p);
    PointMotion& m = motion_[p];
    m.before = m.after = Eigen::Map<const Mat3>(x);
    m.volume_before = m.volume_after = x[9];
    m.turned = Eigen::Map<const Mat3>(x + 10);
    std::copy(x + motion_numbers, x + each, state_.begin() + std::ptrdiff_t(n * p));
  }
  tried_state_ = state_;
  first = first_of_rank(friction_.size(), comm_);
  for (std::size_t p = 0; p < friction_.size(); ++p) {
    const double* x = s.wall.data() + wall_numbers * (first + p);
    friction_[p] = Vec3(x[0], x[1], x[2]);
    accepted_closed_[p] = x[3] != 0;
  }
  tried_friction_ = friction_;
  closed_ = accepted_closed_;
  temperature_ = s.temperature;
  last_step_ = s.last_step;
  largest_scale_ = s.largest_scale;
  shear_ = s.shear;
  accepted_punch_closed_ = s.punch_closed != 0;
}

template class PressBody<2>;
template class PressBody<3>;

}  // namespace densify::fem
