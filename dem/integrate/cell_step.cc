#include "dem/integrate/cell_step.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "dem/simulation.h"

namespace densify::dem {

void CellStep::begin(const State& s, const Setup& setup, double step, double end, double mass) {
  stretched_ = false;
  gradient_ = before_ = s.cell.velocity_gradient;
  free_.clear();
  goal_.clear();
  drawn_.clear();  // what one step found is no guess for the next: it is in no checkpoint
  if (!setup.cell_path) return;
  const Schedule& schedule = setup.schedule;
  const std::size_t stage = schedule.stage_at(s.time);
  // At its very end a stage has already passed to the next.
  const double within = std::min(end, std::nextafter(schedule.next_breakpoint(s.time), 0.0));
  for (std::size_t c = 0; c < 6; ++c) {
    const auto [i, j] = tensor_places[c];
    if (setup.cell_path->stages[stage][c].control == CellControl::rate) {
      gradient_(i, j) = goal(*setup.cell_path, schedule, s.cell_drive, c, s.time + 0.5 * step);
    } else {
      free_.push_back(c);
      goal_.push_back(goal(*setup.cell_path, schedule, s.cell_drive, c, within));
    }
  }
  // As if the mass were spread over a cube: m x^2 on average.
  inertia_ = mass * std::pow(s.cell.volume(), 2.0 / 3) / 12 / step;
}

void CellStep::begin(const State& s, const CellStretch& stretch, double step) {
  stretched_ = true;
  before_ = s.cell.velocity_gradient;
  free_.clear();
  const Eigen::SelfAdjointEigenSolver<Mat3> strain(step * stretch.rate);
  const Vec3 longer = strain.eigenvalues().array().unaryExpr([](double e) { return std::expm1(e); });
  gradient_ = strain.eigenvectors() * longer.asDiagonal() * strain.eigenvectors().transpose() / step;
}

void CellStep::clear(Eigen::Index rows) {
  const auto m = Eigen::Index(free_.size());
  pull_.assign(free_.size(), Eigen::VectorXd::Zero(rows));
  own_ = Eigen::MatrixXd::Zero(m, m);
  resultant_ = Eigen::VectorXd::Zero(m);
  scale_ = 0;
}

void CellStep::add(const NetworkOperator& network, const NetworkLink& link, const Vec3& branch, const Vec3& force) {
  scale_ += std::abs(force.dot(branch)) / 3;
  for (std::size_t d = 0; d < free_.size(); ++d) {
    const auto [i, j] = tensor_places[free_[d]];
    resultant_[Eigen::Index(d)] -= force[i] * branch[j];
    // What a unit rate does: the ends part by e_i b_j.
    Vec3 answer = (link.coefficient - link.lateral) * branch[j] * link.normal[i] * link.normal;
    answer[i] += link.lateral * branch[j];
    network.add_force(link, answer, pull_[d]);
    for (std::size_t c = 0; c < free_.size(); ++c) {
      const auto [k, l] = tensor_places[free_[c]];
      own_(Eigen::Index(c), Eigen::Index(d)) += branch[l] * answer[k];
    }
  }
}

void CellStep::close(double volume) {
  for (std::size_t d = 0; d < free_.size(); ++d) {
    const auto [i, j] = tensor_places[free_[d]];
    resultant_[Eigen::Index(d)] += volume * goal_[d] - inertia_ * (gradient_(i, j) - before_(i, j));
    own_(Eigen::Index(d), Eigen::Index(d)) += inertia_;
    scale_ = std::max(scale_, volume * std::abs(goal_[d]));
  }
}

double CellStep::off() const {
  if (free_.empty()) return 0;
  constexpr double smallest = 1e-300;
  return resultant_.cwiseAbs().maxCoeff() / std::max(scale_, smallest);
}

int CellStep::solve(const NetworkOperator& network, Eigen::VectorXd& change) {
  constexpr double relative_residual = 1e-3;  // enters the small system squared
  int iterations = 0;
  drawn_.resize(free_.size(), Eigen::VectorXd::Zero(change.size()));
  Eigen::MatrixXd small = own_;
  Eigen::VectorXd forces = resultant_;
  for (std::size_t d = 0; d < free_.size(); ++d) {
    if (drawn_[d].size() != change.size()) drawn_[d].setZero(change.size());
    iterations += network.solve(pull_[d], drawn_[d], {relative_residual * pull_[d].norm(), 0}).iterations;
    forces[Eigen::Index(d)] += pull_[d].dot(change);
  }
  for (std::size_t c = 0; c < free_.size(); ++c)
    for (std::size_t d = 0; d < free_.size(); ++d)
      small(Eigen::Index(c), Eigen::Index(d)) -= 0.5 * (pull_[c].dot(drawn_[d]) + pull_[d].dot(drawn_[c]));
  const Eigen::VectorXd rates = small.ldlt().solve(forces);
  gradient_change_.setZero();
  for (std::size_t d = 0; d < free_.size(); ++d) {
    const auto [i, j] = tensor_places[free_[d]];
    gradient_change_(i, j) = rates[Eigen::Index(d)];
    change += rates[Eigen::Index(d)] * drawn_[d];
  }
  return iterations;
}

}  // namespace densify::dem
