#pragma once
// The nodes of a response table as smooth curves.

#include "coupling/response_table.h"
#include "coupling/shape_preserving.h"

namespace densify::coupling {

/// A node as numbers that may be interpolated one by one: logarithms of what is positive and spans decades, and ratios
/// of a tensor to its axial component, which keep it definite.
Eigen::VectorXd curve_values(const ColdNode&);
Eigen::VectorXd curve_values(const SinteringNode&);
/// The nodes back; their densities are not among the numbers.
ColdNode cold_node(const Eigen::VectorXd&);
SinteringNode sintering_node(const Eigen::VectorXd&);

/// What of them a material needs, from the first so many: of loose powder all; of necks their stiffness, or that they
/// flow.
inline constexpr int loose_rows = 8, strength_rows = 5, flow_rows = 12;
struct LooseValues {
  double axial, lateral;  ///< [Pa]
  AxialTensor stiffness;
};
LooseValues loose_values(const Eigen::Matrix<double, loose_rows, 1>&);
AxialTensor stiffness_values(const Eigen::Matrix<double, strength_rows, 1>&);
struct FlowValues {
  AxialTensor viscosity;
  std::array<double, 2> sintering_stress;
};
FlowValues flow_values(const Eigen::Matrix<double, flow_rows, 1>&);

/// Nodes over ln(density).
ShapePreserving cold_curve(const std::vector<ColdNode>&);

/// Nodes over ln(density/birth) as a share of that of the last node: 0 where necks begin, 1 at the end.
ShapePreserving sintering_curve(const std::vector<SinteringNode>&, double birth);

}  // namespace densify::coupling
