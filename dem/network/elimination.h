#pragma once
// Gaussian elimination of the nodes of a network that have few neighbours.  What they leave behind is a smaller
// network, as rigid motions see it; clusters of small particles that next to nothing holds, on which iterations stall,
// are gone.

#include "dem/network/block_rows.h"

namespace densify::dem {

template <int B>
class Elimination {
 public:
  /// Eliminates, fewest neighbours first, until every node that is left has more than `most_neighbours`.  A direction
  /// in which a node is resisted by nothing stays at rest.
  Elimination(BlockRows<B> matrix, std::size_t most_neighbours);

  /// Takes the matrix of the nodes that are left.
  BlockRows<B> take_core() { return std::move(core_); }
  std::size_t eliminated() const { return steps_.size(); }
  std::size_t bytes() const;

  /// Right-hand side of the core; `b` becomes what `back` needs.
  template <int C>
  Stack<B, C> forward(Stack<B, C>& b) const;
  /// Solution on all nodes from that of the core.
  template <int C>
  void back(const Stack<B, C>& b, const Stack<B, C>& core, Stack<B, C>& x) const;

 private:
  struct Step {
    std::uint32_t node;
    std::size_t begin;  // of its neighbours in `column_`; they end where the next step's begin
    Tile<B, B> root;    // R of its diagonal block, R^T R the inverse
  };
  std::size_t end_of(std::size_t s) const { return s + 1 < steps_.size() ? steps_[s + 1].begin : column_.size(); }

  std::vector<Step> steps_;
  std::vector<std::uint32_t> column_;
  std::vector<Tile<B, B>> block_;    // R A of the step's row: no inverse of something soft meets what is stiff
  std::vector<std::uint32_t> kept_;  // nodes of the core
  BlockRows<B> core_;
};

}  // namespace densify::dem
