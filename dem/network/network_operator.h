#pragma once
// The sparse symmetric operator of a contact network: y = K x over three translations a particle, never assembled
// unless asked, and its solution by conjugate gradients.

#include <Eigen/SparseCore>
#include <optional>

#include "dem/state/particles.h"

namespace densify::dem {

/// One edge of the operator: force on i = (lateral I + (normal - lateral) n n^T)(x_j - x_i).
struct NetworkLink {
  Vec3 normal;                 ///< from i to j, or to the wall
  double coefficient;          ///< along the normal [N/m or N s/m]
  double lateral;              ///< across it, same unit
  std::uint32_t i = 0, j = 0;  ///< particles; j has no meaning at a wall
  enum class End : std::uint8_t { particle, fixed_wall, guided_wall } end = End::particle;
};

/// Solver settings.
struct ConjugateGradients {
  double residual = 0;      ///< stops when the Euclidean norm of K x - b is at most this
  int most_iterations = 0;  ///< 0: ten a row
};

/// How a solution went.
struct SolverReport {
  int iterations = 0;
  double residual = 0;  ///< norm of b - K x as the iteration carries it
  bool converged = false;
};

/// K = sum over links of B^T C B + what resists a row's own motion, positive semidefinite; one guided wall may add a
/// single unknown, its travel along a given direction, as the last entry of every vector.  A particle without links has
/// zero rows.
class NetworkOperator {
 public:
  NetworkOperator(std::size_t particles, std::optional<Vec3> guide) : particles_(particles), guide_(guide) {}

  void clear() { links_.clear(), own_.resize(0); }
  void reserve(std::size_t links) { links_.reserve(links); }
  void add(const NetworkLink& link) { links_.push_back(link); }
  /// Resistance of every row against its own motion, as of its inertia over a step; >= 0.
  void resist(const Eigen::VectorXd& own) { own_ = own; }
  const std::vector<NetworkLink>& links() const { return links_; }

  Eigen::Index rows() const { return Eigen::Index(3 * particles_ + (guide_ ? 1 : 0)); }
  bool guided() const { return guide_.has_value(); }

  /// y = K x.
  void apply(const Eigen::VectorXd& x, Eigen::VectorXd& y) const;
  /// Adds a force on i, and its reaction on j or on the guided wall, to a vector of resultants.
  void add_force(const NetworkLink& link, const Vec3& force, Eigen::VectorXd& resultant) const;
  /// Relative motion x_j - x_i of the ends of a link.
  Vec3 relative(const NetworkLink& link, const Eigen::VectorXd& x) const;

  /// K x = b by conjugate gradients with the inverse diagonal blocks as preconditioner, from the x that is given.
  /// Components of x that K does not see stay as they are; b must have none.
  SolverReport solve(const Eigen::VectorXd& b, Eigen::VectorXd& x, const ConjugateGradients&) const;
  /// The same for every column of b, to `relative_residual` of its norm.
  std::vector<SolverReport> solve_all(const Eigen::MatrixXd& b, Eigen::MatrixXd& x, double relative_residual) const;

  /// K as a sparse matrix, for direct solvers and small networks.
  Eigen::SparseMatrix<double> assemble() const;

 private:
  std::vector<Mat3> inverse_blocks(double& guide_inverse) const;

  std::size_t particles_;
  std::optional<Vec3> guide_;  // direction of the guided wall
  std::vector<NetworkLink> links_;
  Eigen::VectorXd own_;  // of every row, or empty
};

}  // namespace densify::dem
