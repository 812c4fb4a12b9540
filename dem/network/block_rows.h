#pragma once
// Symmetric sparse matrices of small blocks, one row of blocks a node, times several vectors at once: a block that has
// come from memory serves all of them.

#include <Eigen/SparseCore>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "dem/state/particles.h"

namespace densify::dem {

/// A block of a row, or the values of one node in `C` vectors, by rows.
template <int R, int C>
using Tile = std::array<double, std::size_t(R) * C>;

/// `columns` vectors over all nodes.
template <int B, int columns>
using Stack = std::vector<Tile<B, columns>>;

/// All blocks outside the diagonal, both triangles; in each row columns before the node come first.
template <int B>
struct BlockRows {
  std::vector<std::size_t> begin{0}, middle;  ///< of each row; `middle`: the first column behind the node
  std::vector<std::uint32_t> column;
  std::vector<Tile<B, B>> block;
  std::vector<Vec3> branch;          ///< from the row's node to the column's
  std::vector<Tile<B, B>> diagonal;  ///< of each node
  std::vector<double> scale;         ///< of what was summed up in the diagonal: its rounding is this times 1e-16

  std::size_t nodes() const { return diagonal.size(); }
};

/// y = s + a x for one block; `sign` 1 or -1.
template <int B, int C>
inline void add_product(double sign, const Tile<B, B>& a, const Tile<B, C>& x, Tile<B, C>& y) {
  for (int r = 0; r < B; ++r) {
    double sum[C];
    for (int c = 0; c < C; ++c) sum[c] = y[std::size_t(r * C + c)];
    for (int k = 0; k < B; ++k) {
      const double value = sign * a[std::size_t(r * B + k)];
      for (int c = 0; c < C; ++c) sum[c] += value * x[std::size_t(k * C + c)];
    }
    for (int c = 0; c < C; ++c) y[std::size_t(r * C + c)] = sum[c];
  }
}

/// y = A x.
template <int B, int C>
void multiply(const BlockRows<B>& a, const Stack<B, C>& x, Stack<B, C>& y) {
  for (std::size_t n = 0; n < a.nodes(); ++n) {
    Tile<B, C> sum{};
    add_product<B, C>(1, a.diagonal[n], x[n], sum);
    for (std::size_t e = a.begin[n]; e < a.begin[n + 1]; ++e) add_product<B, C>(1, a.block[e], x[a.column[e]], sum);
    y[n] = sum;
  }
}

/// R with R^T R the inverse of a symmetric positive semidefinite block on its range: eigenvalues up to 1e-12 of
/// `scale`, that of what was summed up in it, count as none.
template <int B>
Tile<B, B> root_of_inverse(const Tile<B, B>&, double scale);

/// A as a sparse matrix.
template <int B>
Eigen::SparseMatrix<double> assemble(const BlockRows<B>&);

/// Number of eigenvalues below `share` of the largest diagonal entry, by the inertia of A - shift (Sylvester).
template <int B>
std::size_t count_soft_modes(const BlockRows<B>&, double share);

}  // namespace densify::dem
