#include "dem/network/block_rows.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/SparseCholesky>

namespace densify::dem {

template <int B>
Tile<B, B> root_of_inverse(const Tile<B, B>& tile, double scale) {
  using Block = Eigen::Matrix<double, B, B, Eigen::RowMajor>;
  const Block d = Eigen::Map<const Block>(tile.data());
  Tile<B, B> result;
  Eigen::Map<Block> root(result.data());
  // A body that nothing holds is a difference of large numbers: what is left must not be taken for a resistance.
  constexpr double well_conditioned = 1e-8, rounding = 1e-14;
  const Eigen::LLT<Block> factors(d);
  if (factors.info() == Eigen::Success && factors.matrixLLT().diagonal().array().square().minCoeff() >
                                              well_conditioned * std::max(d.diagonal().maxCoeff(), scale)) {
    root = factors.matrixL().solve(Block::Identity());
    return result;
  }
  const Eigen::SelfAdjointEigenSolver<Block> eigen(d);
  Eigen::Matrix<double, B, 1> values = Eigen::Matrix<double, B, 1>::Zero();
  for (int k = 0; k < B; ++k)
    if (eigen.eigenvalues()[k] > rounding * scale) values[k] = 1 / std::sqrt(eigen.eigenvalues()[k]);
  root = values.asDiagonal() * eigen.eigenvectors().transpose();
  return result;
}

template <int B>
Eigen::SparseMatrix<double> assemble(const BlockRows<B>& a) {
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve((a.block.size() + a.nodes()) * B * B);
  auto add = [&](std::size_t row, std::size_t column, const Tile<B, B>& tile) {
    for (int r = 0; r < B; ++r)
      for (int c = 0; c < B; ++c)
        entries.emplace_back(int(row) * B + r, int(column) * B + c, tile[std::size_t(r * B + c)]);
  };
  for (std::size_t n = 0; n < a.nodes(); ++n) {
    add(n, n, a.diagonal[n]);
    for (std::size_t e = a.begin[n]; e < a.begin[n + 1]; ++e) add(n, a.column[e], a.block[e]);
  }
  Eigen::SparseMatrix<double> matrix(Eigen::Index(a.nodes()) * B, Eigen::Index(a.nodes()) * B);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

template <int B>
std::size_t count_soft_modes(const BlockRows<B>& a, double share) {
  Eigen::SparseMatrix<double> shifted = assemble(a);
  const double largest = a.nodes() > 0 ? Eigen::VectorXd(shifted.diagonal()).maxCoeff() : 0.0;
  if (largest == 0) return std::size_t(shifted.rows());
  Eigen::SparseMatrix<double> identity(shifted.rows(), shifted.rows());
  identity.setIdentity();
  shifted -= share * largest * identity;
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factors(shifted);
  return std::size_t((factors.vectorD().array() < 0).count());
}

template Tile<3, 3> root_of_inverse<3>(const Tile<3, 3>&, double);
template Tile<6, 6> root_of_inverse<6>(const Tile<6, 6>&, double);
template Eigen::SparseMatrix<double> assemble(const BlockRows<3>&);
template Eigen::SparseMatrix<double> assemble(const BlockRows<6>&);
template std::size_t count_soft_modes(const BlockRows<3>&, double);
template std::size_t count_soft_modes(const BlockRows<6>&, double);

}  // namespace densify::dem
