#pragma once
// Conjugate gradients for contact networks with several right-hand sides, which share their directions of search
// (O'Leary, 1980), so that stiffnesses from them are symmetric, preconditioned by multigrid: neighbouring
// particles are gathered to bodies that move rigidly (plain aggregation; the six motions of each are what a network
// resists least), a sweep of block Gauss-Seidel goes before and after, and the smallest network is factorised.

#include <Eigen/SparseCholesky>
#include <functional>
#include <memory>

#include "dem/network/block_rows.h"

namespace densify::dem {

template <int B>
class Multigrid {
 public:
  /// A matrix of at most `direct_nodes` nodes is factorised; a larger one gets coarser ones, which are factorised when
  /// they have at most `largest_coarse` of them, too.
  Multigrid(BlockRows<B> matrix, std::size_t direct_nodes);
  static constexpr std::size_t largest_coarse = 250;

  /// When a column is solved: the norm of its residual r is at most `floor`, or sqrt(r M r) with the preconditioner M,
  /// about the energy norm of the error, has fallen by `tolerance`.
  template <int C>
  struct Goal {
    double tolerance;
    std::array<double, std::size_t(C)> floor;
    int most_iterations;
    std::function<void(double)> watch = {};  ///< called before every iteration with Report::error
  };
  /// How a solution went.
  struct Report {
    int iterations = 0;
    double error = 0;  ///< largest fall of sqrt(r M r) over the columns
    bool converged = false;
  };
  /// A x = b in every column from x = 0.  Components that A does not see stay 0 to rounding; b must have none.
  template <int C>
  Report solve(const Stack<B, C>& b, Stack<B, C>& x, const Goal<C>&) const;

  const BlockRows<B>& matrix() const { return matrix_; }
  std::size_t bytes() const;

 private:
  template <int>
  friend class Multigrid;
  template <int C>
  void precondition(const Stack<B, C>& r, Stack<B, C>& z) const;
  void factorise();
  void coarsen(std::size_t direct_nodes);

  static constexpr std::uint32_t alone = 0xffffffff;  // held by nothing, in no aggregate
  BlockRows<B> matrix_;
  std::vector<Tile<B, B>> inverse_;       // of the diagonal blocks
  std::vector<std::uint32_t> aggregate_;  // of each node
  std::vector<Vec3> offset_;              // of each node from the centre of its aggregate
  std::unique_ptr<Multigrid<6>> coarse_;
  std::unique_ptr<Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>>> factors_;
};

}  // namespace densify::dem
