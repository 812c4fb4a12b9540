#include "coupling/table_curves.h"

#include <cmath>

namespace densify::coupling {

namespace {

void put(Eigen::VectorXd& v, Eigen::Index first, const AxialTensor& c) {
  v.segment<5>(first) << std::log(c[1]), c[0] / c[1], c[2] / c[1], c[3] / c[1], c[4] / c[1];
}

template <class Values>
AxialTensor take(const Values& v, Eigen::Index first) {
  const double axial = std::exp(v[first]);
  return {axial * v[first + 1], axial, axial * v[first + 2], axial * v[first + 3], axial * v[first + 4]};
}

}  // namespace

Eigen::VectorXd curve_values(const ColdNode& n) {
  Eigen::VectorXd v(8);
  v.head<3>() << std::log(n.axial), n.lateral / n.axial, n.density_scatter;
  put(v, 3, n.stiffness);
  return v;
}

ColdNode cold_node(const Eigen::VectorXd& v) {
  const LooseValues n = loose_values(v.head<loose_rows>());
  return {0, n.axial, n.lateral, v[2], n.stiffness};
}

Eigen::VectorXd curve_values(const SinteringNode& n) {
  Eigen::VectorXd v(16);
  put(v, 0, n.stiffness);
  put(v, strength_rows, n.viscosity);
  v.tail<6>() << n.sintering_stress[0], n.sintering_stress[1], n.viscosity_scatter, n.sintering_stress_scatter,
      n.neck_state, n.at_equilibrium;
  return v;
}

SinteringNode sintering_node(const Eigen::VectorXd& v) {
  const FlowValues n = flow_values(v.head<flow_rows>());
  return {0, n.viscosity, stiffness_values(v.head<strength_rows>()), n.sintering_stress, v[12], v[13], v[14], v[15]};
}

LooseValues loose_values(const Eigen::Matrix<double, loose_rows, 1>& v) {
  const double axial = std::exp(v[0]);
  return {axial, axial * v[1], take(v, 3)};
}

AxialTensor stiffness_values(const Eigen::Matrix<double, strength_rows, 1>& v) {
  return take(v, 0);
}

FlowValues flow_values(const Eigen::Matrix<double, flow_rows, 1>& v) {
  return {take(v, strength_rows), {v[10], v[11]}};
}

ShapePreserving cold_curve(const std::vector<ColdNode>& nodes) {
  std::vector<double> x;
  Eigen::MatrixXd values(8, Eigen::Index(nodes.size()));
  for (const ColdNode& n : nodes) {
    values.col(Eigen::Index(x.size())) = curve_values(n);
    x.push_back(std::log(n.density));
  }
  return {std::move(x), std::move(values)};
}

ShapePreserving sintering_curve(const std::vector<SinteringNode>& nodes, double birth) {
  std::vector<double> x;
  Eigen::MatrixXd values(16, Eigen::Index(nodes.size()));
  const double whole = nodes.empty() ? 1 : std::log(nodes.back().density / birth);
  for (const SinteringNode& n : nodes) {
    values.col(Eigen::Index(x.size())) = curve_values(n);
    x.push_back(std::log(n.density / birth) / whole);
  }
  return {std::move(x), std::move(values)};
}

}  // namespace densify::coupling
