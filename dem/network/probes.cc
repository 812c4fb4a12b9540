#include "dem/network/probes.h"

#include <array>

#include "base/check.h"

namespace densify::dem {

namespace {

constexpr int row_of[6] = {0, 1, 2, 1, 0, 0}, column_of[6] = {0, 1, 2, 2, 2, 1};

Mat3 unit_rate(int k) {
  Mat3 rate = Mat3::Zero();
  rate(row_of[k], column_of[k]) += 0.5;
  rate(column_of[k], row_of[k]) += 0.5;
  return rate;
}

void add_stress(Vec6& sum, const Vec3& force, const Vec3& branch) {
  for (int k = 0; k < 6; ++k)
    sum[k] += 0.5 * (force[row_of[k]] * branch[column_of[k]] + force[column_of[k]] * branch[row_of[k]]);
}

}  // namespace

CellResponse probe_cell(const Network& network, const std::function<EdgeLaw(const NetworkEdge&)>& law, double volume,
                        double relative_residual) {
  constexpr int cases = 7;  // six rates, then none
  NetworkOperator k(network.particles, std::nullopt);
  std::vector<double> at_rest;
  k.reserve(network.edges.size());
  for (const NetworkEdge& e : network.edges) {
    if (e.at_wall) throw RunError("a probe of a cell met a wall; only periodic networks have a cell");
    const EdgeLaw l = law(e);
    k.add({e.normal, l.coefficient, l.lateral, e.i, e.j});
    at_rest.push_back(l.force);
  }
  std::array<Mat3, 6> rate;
  for (int c = 0; c < 6; ++c) rate[std::size_t(c)] = unit_rate(c);
  auto force = [&](std::size_t e, int c, const Vec3& moved) -> Vec3 {
    const NetworkLink& l = k.links()[e];
    const Vec3 v = c < 6 ? Vec3(rate[std::size_t(c)] * network.edges[e].branch + moved) : moved;
    const Vec3 f = l.lateral * v + ((l.coefficient - l.lateral) * l.normal.dot(v)) * l.normal;
    return c < 6 ? f : Vec3(f + at_rest[e] * l.normal);
  };
  Eigen::MatrixXd resultant = Eigen::MatrixXd::Zero(k.rows(), cases), motion = resultant;
  CellResponse response;
  std::array<double, cases> forces{};  // squares, of all edges
  for (int c = 0; c < cases; ++c) {
    Eigen::VectorXd sum = Eigen::VectorXd::Zero(k.rows());
    Vec6 stress = Vec6::Zero();
    for (std::size_t e = 0; e < network.edges.size(); ++e) {
      const Vec3 f = force(e, c, Vec3::Zero());
      k.add_force(k.links()[e], f, sum);
      add_stress(stress, f, network.edges[e].branch);
      forces[std::size_t(c)] += f.squaredNorm();
    }
    resultant.col(c) = sum;
    if (c < 6)
      response.affine.col(c) = stress / volume;
    else
      response.affine_active = stress / volume;
  }
  for (int c = 0; c < cases; ++c) {
    Eigen::VectorXd x = Eigen::VectorXd::Zero(k.rows());
    // In a lattice the resultants are rounding; they need no relaxing.
    constexpr double rounding = 1e-13;
    const double size = resultant.col(c).norm();
    const double goal = std::max(relative_residual * size, rounding * std::sqrt(forces[std::size_t(c)]));
    const SolverReport report = k.solve(resultant.col(c), x, {goal, 0});
    response.iterations += report.iterations;
    constexpr double usable = 1e-3;
    if (!report.converged && report.residual > usable * size)
      throw RunError("the network's forces could not be balanced (residual " + std::to_string(report.residual / size) +
                     "); it may have parts that nothing holds");
    motion.col(c) = x;
  }
  for (int c = 0; c < cases; ++c) {
    Vec6 stress = Vec6::Zero();
    double power = 0;
    const Eigen::VectorXd x = motion.col(c);
    for (std::size_t e = 0; e < network.edges.size(); ++e) {
      const Vec3 moved = k.relative(k.links()[e], x), f = force(e, c, moved);
      add_stress(stress, f, network.edges[e].branch);
      if (c < 6) power += f.dot(rate[std::size_t(c)] * network.edges[e].branch + moved);
    }
    if (c == 6) {
      response.relaxed_active = stress / volume;
      break;
    }
    response.relaxed.col(c) = stress / volume;
    if (power > 0) response.power_mismatch = std::max(response.power_mismatch, std::abs(power - stress[c]) / power);
  }
  const double largest = response.relaxed.cwiseAbs().maxCoeff();
  if (largest > 0)
    response.asymmetry = (response.relaxed - response.relaxed.transpose()).cwiseAbs().maxCoeff() / largest;
  return response;
}

}  // namespace densify::dem
