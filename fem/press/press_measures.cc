// What is measured of the body in the die.

#include <deal.II/fe/fe_values.h>

#include <cmath>

#include "fem/press/press_body.h"

namespace densify::fem {

namespace {

double sum(double value, MPI_Comm comm) {
  return dealii::Utilities::MPI::sum(value, comm);
}

}  // namespace

template <int dim>
Densities PressBody<dim>::densities_of(const std::vector<double>& state, const std::vector<double>& volume) const {
  const std::size_t n = material_->state_size();
  double solid = 0, all = 0, least = 1e300, most = -1e300;
  for (std::size_t k = 0; k < weight_.size(); ++k) {
    const double density = material_->density(std::span(state).subspan(n * k, n));
    solid += weight_[k] * volume[k] * density;
    all += weight_[k] * volume[k];
    least = std::min(least, density);
    most = std::max(most, density);
  }
  return {sum(solid, comm_) / sum(all, comm_), dealii::Utilities::MPI::min(least, comm_),
          dealii::Utilities::MPI::max(most, comm_)};
}

template <int dim>
Densities PressBody<dim>::densities() const {
  std::vector<double> volume;
  for (const PointMotion& m : motion_) volume.push_back(m.volume_before);
  return densities_of(state_, volume);
}

template <int dim>
std::vector<double> PressBody<dim>::densification() const {
  const std::size_t n = material_->state_size();
  std::vector<double> change;
  for (std::size_t k = 0; k < weight_.size(); ++k)
    change.push_back(std::log(material_->density(std::span(tried_state_).subspan(n * k, n)) /
                              material_->density(std::span(state_).subspan(n * k, n))));
  return change;
}

template <int dim>
std::vector<PointRecord> PressBody<dim>::points() const {
  const std::size_t n = material_->state_size();
  dealii::FEValues<dim> values(mapping_, element_, points_of_cell_,
                               dealii::update_values | dealii::update_quadrature_points);
  Dofs dofs(element_.dofs_per_cell);
  std::vector<PointRecord> all;
  for (const auto& cell : dofs_.active_cell_iterators()) {
    if (!cell->is_locally_owned()) continue;
    values.reinit(cell);
    cell->get_dof_indices(dofs);
    for (const unsigned q : values.quadrature_point_indices()) {
      const std::size_t k = all.size();
      dealii::Point<dim> x = values.quadrature_point(q);
      for (unsigned i = 0; i < dofs.size(); ++i)
        x[element_.system_to_component_index(i).first] += values.shape_value(i, q) * displacement_[dofs[i]];
      const Vec6& s = answer_[k].stress;
      Mat3 stress;
      stress << s[0], s[5], s[4], s[5], s[1], s[3], s[4], s[3], s[2];
      all.push_back({dim == 2 ? Vec3(x[0], 0, x[1]) : Vec3(x[0], x[1], x[dim - 1]),
                     weight_[k] * motion_[k].volume_before, material_->density(std::span(state_).subspan(n * k, n)),
                     motion_[k].turned * stress * motion_[k].turned.transpose()});
    }
  }
  return all;
}

template <int dim>
double PressBody<dim>::mass() const {
  const std::size_t n = material_->state_size();
  double solid = 0;
  for (std::size_t k = 0; k < weight_.size(); ++k) {
    const auto state = std::span(state_).subspan(n * k, n);
    solid += weight_[k] * motion_[k].volume_before * material_->density(state) /
             material_->solid_volume(state, start_temperature_, temperature_);
  }
  return sum(solid, comm_);
}

template <int dim>
double PressBody<dim>::volume() const {
  double all = 0;
  for (std::size_t k = 0; k < weight_.size(); ++k) all += weight_[k] * motion_[k].volume_before;
  return sum(all, comm_);
}

template <int dim>
double PressBody<dim>::height() const {
  return height_ + displacement_[top_.front()] - displacement_[bottom_.front()];
}

template <int dim>
double PressBody<dim>::lower_rise() const {
  return displacement_[bottom_.front()];
}

template class PressBody<2>;
template class PressBody<3>;

}  // namespace densify::fem
