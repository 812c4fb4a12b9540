#include "dem/integrate/cell_answer.h"

#include <array>
#include <cmath>

#include "dem/measure/stress.h"

namespace densify::dem {

namespace {

constexpr double relative_residual = 1e-3;  // of solutions; the tangent errs with its square

constexpr int row_of[6] = {0, 1, 2, 1, 0, 0}, column_of[6] = {0, 1, 2, 2, 2, 1};

/// How the ends of a branch part by a unit rate, a shear rate as half of it on either side.
Vec3 parting(int component, const Vec3& branch) {
  Vec3 apart = Vec3::Zero();
  apart[row_of[component]] += 0.5 * branch[column_of[component]];
  apart[column_of[component]] += 0.5 * branch[row_of[component]];
  return apart;
}

}  // namespace

CellAnswer cell_answer(const NetworkOperator& network, const std::vector<LinkForce>& forces, const Mat3& gradient,
                       const Eigen::VectorXd& velocity, double volume) {
  Stress stress{};
  CellAnswer a;
  for (std::size_t k = 0; k < forces.size(); ++k) {
    const auto& [branch, force] = forces[k];
    add_symmetric(stress, branch, force);
    const double against_cell = force.dot(network.relative(network.links()[k], velocity));
    a.mismatch += against_cell;
    a.power += std::abs(against_cell + force.dot(gradient * branch));
  }
  a.mismatch = std::abs(a.mismatch);
  a.stress = Eigen::Map<const Vec6>(stress.data()) / volume;
  return a;
}

CellTangent cell_tangent(const NetworkOperator& network, const std::vector<LinkForce>& forces, double volume) {
  Mat6 own = Mat6::Zero();
  std::array<Eigen::VectorXd, 6> pull;  // forces on the particles by unit rates
  pull.fill(Eigen::VectorXd::Zero(network.rows()));
  for (std::size_t k = 0; k < forces.size(); ++k) {
    const NetworkLink& link = network.links()[k];
    std::array<Vec3, 6> apart;
    for (int d = 0; d < 6; ++d) {
      const Vec3 a = apart[std::size_t(d)] = parting(d, forces[k].branch);
      const Vec3 answer = link.lateral * a + (link.coefficient - link.lateral) * link.normal.dot(a) * link.normal;
      network.add_force(link, answer, pull[std::size_t(d)]);
      for (int c = 0; c <= d; ++c) own(c, d) += apart[std::size_t(c)].dot(answer);
    }
  }
  CellTangent t{Mat6::Zero(), Eigen::MatrixXd::Zero(network.rows(), 6)};
  for (int d = 0; d < 6; ++d) {
    Eigen::VectorXd moved = Eigen::VectorXd::Zero(network.rows());
    network.solve(pull[std::size_t(d)], moved, {relative_residual * pull[std::size_t(d)].norm(), 0});
    t.motion.col(d) = moved;
  }
  for (int d = 0; d < 6; ++d)
    for (int c = 0; c <= d; ++c) {
      const double relaxed =
          0.5 * (pull[std::size_t(c)].dot(t.motion.col(d)) + pull[std::size_t(d)].dot(t.motion.col(c)));
      t.stress(c, d) = t.stress(d, c) = (own(c, d) - relaxed) / volume;
    }
  return t;
}

}  // namespace densify::dem
