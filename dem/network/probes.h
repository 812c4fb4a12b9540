#pragma once
// What a periodic network answers to six unit rates of its cell and to none: with springs in the links an elastic
// stiffness, with dashpots a viscosity, with the steps of a Maxwell network the affine law of one step (thesis 6.10).

#include <functional>

#include "dem/network/network.h"
#include "dem/network/network_operator.h"

namespace densify::dem {

using Vec6 = Eigen::Matrix<double, 6, 1>;
using Mat6 = Eigen::Matrix<double, 6, 6>;  ///< rows and columns xx yy zz yz xz xy, shear rates as engineering shears

/// Stress of a cell as an affine function of its rate: stress = active + matrix x rate; unit that of the links over
/// m^2.
struct CellResponse {
  Mat6 affine = Mat6::Zero();          ///< every particle moves with the cell: an upper bound
  Mat6 relaxed = Mat6::Zero();         ///< forces in balance
  Vec6 affine_active = Vec6::Zero();   ///< stress at no rate, particles at rest [Pa]
  Vec6 relaxed_active = Vec6::Zero();  ///< the same with forces in balance [Pa]
  double asymmetry = 0;                ///< largest |C - C^T| over the largest entry of the relaxed matrix
  double power_mismatch = 0;  ///< largest |sum of f.v - V stress.rate| over the six rates, relative (Hill-Mandel)
  int iterations = 0;         ///< of all solutions
};

/// Normal and lateral coefficient of an edge, and the force it has at no rate (tension positive) [N].
struct EdgeLaw {
  double coefficient, lateral, force;
};

/// Probes the network in a periodic cell of the given volume [m^3]; `law(edge)` gives each edge's EdgeLaw.  Edges to
/// walls must not be there.  Throws RunError when the solver does not get to `relative_residual`.
CellResponse probe_cell(const Network&, const std::function<EdgeLaw(const NetworkEdge&)>& law, double volume,
                        double relative_residual);

}  // namespace densify::dem
