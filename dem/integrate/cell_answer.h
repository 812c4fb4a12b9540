#pragma once
// What a periodic cell answers to an owner who strains it: its stress at the end of a step without inertia, and how
// that changes with the rate.

#include "dem/network/network_operator.h"

namespace densify::dem {

/// How an owner strains a cell, in a frame that turns with it.
struct CellStretch {
  Mat3 rate;   ///< of logarithmic strain, symmetric, constant up to `end`: the volume goes as exp(tr rate x time) [1/s]
  double end;  ///< process time that is met exactly [s]
  /// Velocities of the particles against the cell with which the search for those of a single step begins, or null.
  const Eigen::VectorXd* guess = nullptr;
};

/// Components xx yy zz yz xz xy.
struct CellAnswer {
  Vec6 stress = Vec6::Zero();  ///< Cauchy, at the end [Pa]
  double mismatch =
      0;  ///< |sum F.v over the contacts - V stress:rate| at the end: of forces off balance (Hill-Mandel) [W]
  double power = 0;  ///< sum |F.v| then [W]
  double error = 0;  ///< sum of the steps' estimates: approach of a contact over the mean radius
  int steps = 0;     ///< that it took
};

/// A link of a network as the end of a step has it.
struct LinkForce {
  Vec3 branch;  ///< [m]
  Vec3 force;   ///< on i [N]
};

/// The answer of a cell of the given volume [m^3] that moves with `gradient` [1/s], particles with `velocity` against
/// it [m/s].
CellAnswer cell_answer(const NetworkOperator&, const std::vector<LinkForce>&, const Mat3& gradient,
                       const Eigen::VectorXd& velocity, double volume);

/// How the answer changes with a rate that is constant over all the steps.
struct CellTangent {
  Mat6 stress;             ///< d stress/d rate, without what a step's strain does to branches and volume [Pa s]
  Eigen::MatrixXd motion;  ///< d velocity/d rate of the particles, a column a component [m]
};

/// Six solutions of the network.
CellTangent cell_tangent(const NetworkOperator&, const std::vector<LinkForce>&, double volume);

}  // namespace densify::dem
