#include "dem/network/multigrid.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>

namespace densify::dem {

namespace {

template <int B>
using Block = Eigen::Matrix<double, B, B, Eigen::RowMajor>;
template <int B>
using Rigid = Eigen::Matrix<double, B, 6>;  // the six motions of an aggregate at a node

template <int B>
Block<B> as_matrix(const Tile<B, B>& tile) {
  return Eigen::Map<const Block<B>>(tile.data());
}

Mat3 cross_matrix(const Vec3& d) {
  Mat3 m;
  m << 0, -d[2], d[1], d[2], 0, -d[0], -d[1], d[0], 0;
  return m;
}

/// Translation t + w x d, and rotation w where nodes rotate.
template <int B>
Rigid<B> rigid_motions(const Vec3& d) {
  Rigid<B> p = Rigid<B>::Zero();
  p.template topLeftCorner<3, 3>().setIdentity();
  p.template topRightCorner<3, 3>() = -cross_matrix(d);
  if constexpr (B == 6) p.template bottomRightCorner<3, 3>().setIdentity();
  return p;
}

template <int B>
double norm(const Tile<B, B>& t) {
  double sum = 0;
  for (const double v : t) sum += v * v;
  return std::sqrt(sum);
}

}  // namespace

template <int B>
void invert_diagonal(BlockRows<B>& a) {
  a.inverse.resize(a.nodes());
  for (std::size_t n = 0; n < a.nodes(); ++n) {
    const Block<B> d = as_matrix<B>(a.diagonal[n]);
    Eigen::Map<Block<B>> inverse(a.inverse[n].data());
    // A body that nothing holds is a difference of large numbers: what is left must not be taken for a resistance.
    constexpr double well_conditioned = 1e-8, rounding = 1e-12;
    const Eigen::LLT<Block<B>> factors(d);
    if (factors.info() == Eigen::Success && factors.matrixLLT().diagonal().array().square().minCoeff() >
                                                well_conditioned * std::max(d.diagonal().maxCoeff(), a.scale[n])) {
      inverse = factors.solve(Block<B>::Identity());
      continue;
    }
    const Eigen::SelfAdjointEigenSolver<Block<B>> eigen(d);
    Eigen::Matrix<double, B, 1> values = Eigen::Matrix<double, B, 1>::Zero();
    for (int k = 0; k < B; ++k)
      if (eigen.eigenvalues()[k] > rounding * a.scale[n]) values[k] = 1 / eigen.eigenvalues()[k];
    inverse = eigen.eigenvectors() * values.asDiagonal() * eigen.eigenvectors().transpose();
  }
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

template <int B>
Multigrid<B>::Multigrid(BlockRows<B> matrix, std::size_t direct_nodes) : matrix_(std::move(matrix)) {
  invert_diagonal(matrix_);
  if (matrix_.nodes() <= direct_nodes)
    factorise();
  else
    coarsen(std::min(direct_nodes, largest_coarse));
}

// What nothing holds (rigid motions, floppy modes) makes the matrix singular; a share of the diagonal makes it
// one that can be factorised, and conjugate gradients make up for it.
template <int B>
void Multigrid<B>::factorise() {
  Eigen::SparseMatrix<double> a = assemble(matrix_);
  constexpr double share = 1e-6, of_scale = 1e-10;
  Eigen::SparseMatrix<double> held(a.rows(), a.rows());
  held.setIdentity();
  for (Eigen::Index k = 0; k < a.rows(); ++k) {
    const double scale = matrix_.scale[std::size_t(k / B)];
    held.coeffRef(k, k) = scale > 0 ? std::max(share * a.coeff(k, k), of_scale * scale) : 1.0;
  }
  a += held;
  factors_ = std::make_unique<Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>>>(a);
}

template <int B>
void Multigrid<B>::coarsen(std::size_t direct_nodes) {
  const std::size_t n = matrix_.nodes();
  constexpr std::uint32_t open = alone - 1;
  aggregate_.assign(n, open);
  offset_.assign(n, Vec3::Zero());
  std::vector<double> size(n);
  for (std::size_t p = 0; p < n; ++p) {
    size[p] = norm<B>(matrix_.diagonal[p]);
    constexpr double rounding = 1e-13;
    if (size[p] <= rounding * matrix_.scale[p]) aggregate_[p] = alone;
  }
  constexpr double weak = 0.02;
  auto strong = [&](std::size_t p, std::size_t e) {
    const std::uint32_t q = matrix_.column[e];
    return q != p && aggregate_[q] != alone && norm<B>(matrix_.block[e]) > weak * std::sqrt(size[p] * size[q]);
  };
  // A node whose neighbours are all free becomes the centre of a body of all of them; who is left joins a body next
  // to it, and a rest without one makes its own.
  std::uint32_t bodies = 0;
  for (std::size_t p = 0; p < n; ++p) {
    if (aggregate_[p] != open) continue;
    bool free = true, any = false;
    for (std::size_t e = matrix_.begin[p]; e < matrix_.begin[p + 1]; ++e)
      if (strong(p, e)) any = true, free = free && aggregate_[matrix_.column[e]] == open;
    if (!free || !any) continue;
    aggregate_[p] = bodies;
    for (std::size_t e = matrix_.begin[p]; e < matrix_.begin[p + 1]; ++e)
      if (strong(p, e) && aggregate_[matrix_.column[e]] == open)
        aggregate_[matrix_.column[e]] = bodies, offset_[matrix_.column[e]] = matrix_.branch[e];
    ++bodies;
  }
  const std::vector<std::uint32_t> first = aggregate_;
  for (std::size_t p = 0; p < n; ++p) {
    if (first[p] != open) continue;
    double best = 0;
    for (std::size_t e = matrix_.begin[p]; e < matrix_.begin[p + 1]; ++e) {
      const std::uint32_t q = matrix_.column[e];
      const double link = norm<B>(matrix_.block[e]);
      if (!strong(p, e) || first[q] >= open || link <= best) continue;
      best = link;
      aggregate_[p] = first[q];
      offset_[p] = offset_[q] - matrix_.branch[e];
    }
    if (best == 0) aggregate_[p] = bodies++;
  }
  if (10 * std::size_t(bodies) > 8 * n) return factorise();

  // A_c = sum of P_i^T A_ij P_j.
  std::vector<std::size_t> begin(bodies + 1, 0);
  for (const auto a : aggregate_)
    if (a != alone) ++begin[a + 1];
  for (std::size_t b = 0; b < bodies; ++b) begin[b + 1] += begin[b];
  std::vector<std::uint32_t> member(begin.back());
  std::vector<std::size_t> next(begin.begin(), begin.end() - 1);
  for (std::size_t p = 0; p < n; ++p)
    if (aggregate_[p] != alone) member[next[aggregate_[p]]++] = std::uint32_t(p);
  BlockRows<6> coarse;
  coarse.diagonal.resize(bodies);
  coarse.scale.assign(bodies, 0);
  std::vector<std::int64_t> place(bodies, -1);
  struct Entry {
    std::uint32_t column;
    Block<6> block;
    Vec3 branch;
  };
  std::vector<Entry> row;
  for (std::uint32_t b = 0; b < bodies; ++b) {
    row.clear();
    Block<6> diagonal = Block<6>::Zero();
    for (std::size_t m = begin[b]; m < begin[b + 1]; ++m) {
      const std::uint32_t p = member[m];
      const Rigid<B> own = rigid_motions<B>(offset_[p]);
      diagonal += own.transpose() * as_matrix<B>(matrix_.diagonal[p]) * own;
      coarse.scale[b] += matrix_.scale[p] * (1 + offset_[p].squaredNorm());
      for (std::size_t e = matrix_.begin[p]; e < matrix_.begin[p + 1]; ++e) {
        const std::uint32_t q = matrix_.column[e], other = aggregate_[q];
        if (other == alone) continue;
        const Block<6> part = own.transpose() * as_matrix<B>(matrix_.block[e]) * rigid_motions<B>(offset_[q]);
        if (other == b) {
          diagonal += part;
        } else if (place[other] < 0) {
          place[other] = std::int64_t(row.size());
          row.push_back({other, part, offset_[p] + matrix_.branch[e] - offset_[q]});
        } else {
          row[std::size_t(place[other])].block += part;
        }
      }
    }
    std::sort(row.begin(), row.end(), [](const Entry& x, const Entry& y) { return x.column < y.column; });
    for (const Entry& e : row) {
      if (coarse.middle.size() == b && e.column > b) coarse.middle.push_back(coarse.column.size());
      place[e.column] = -1;
      coarse.column.push_back(e.column);
      Eigen::Map<Block<6>>(coarse.block.emplace_back().data()) = e.block;
      coarse.branch.push_back(e.branch);
    }
    if (coarse.middle.size() == b) coarse.middle.push_back(coarse.column.size());
    coarse.begin.push_back(coarse.column.size());
    Eigen::Map<Block<6>>(coarse.diagonal[b].data()) = diagonal;
  }
  coarse_ = std::make_unique<Multigrid<6>>(std::move(coarse), direct_nodes);
}

template <int B>
template <int C>
void Multigrid<B>::precondition(const Stack<B, C>& r, Stack<B, C>& z) const {
  const std::size_t n = matrix_.nodes();
  if (factors_) {
    Eigen::Matrix<double, Eigen::Dynamic, C> b(Eigen::Index(n) * B, C);
    for (std::size_t p = 0; p < n; ++p)
      for (int k = 0; k < B; ++k)
        for (int c = 0; c < C; ++c) b(Eigen::Index(p) * B + k, c) = r[p][std::size_t(k * C + c)];
    const Eigen::Matrix<double, Eigen::Dynamic, C> x = factors_->solve(b);
    for (std::size_t p = 0; p < n; ++p)
      for (int k = 0; k < B; ++k)
        for (int c = 0; c < C; ++c) z[p][std::size_t(k * C + c)] = x(Eigen::Index(p) * B + k, c);
    return;
  }
  const BlockRows<B>& a = matrix_;
  for (std::size_t p = 0; p < n; ++p) {  // (L + D) z = r
    Tile<B, C> sum = r[p];
    for (std::size_t e = a.begin[p]; e < a.middle[p]; ++e) add_product<B, C>(-1, a.block[e], z[a.column[e]], sum);
    z[p] = {};
    add_product<B, C>(1, a.inverse[p], sum, z[p]);
  }
  Stack<6, C> gathered(coarse_->matrix_.nodes(), Tile<6, C>{}), motion(gathered.size());
  for (std::size_t p = 0; p < n; ++p) {
    if (aggregate_[p] == alone) continue;
    Tile<B, C> rest{};  // r - A z = -U z
    for (std::size_t e = a.middle[p]; e < a.begin[p + 1]; ++e) add_product<B, C>(-1, a.block[e], z[a.column[e]], rest);
    Tile<6, C>& sum = gathered[aggregate_[p]];
    const Vec3& d = offset_[p];
    for (int k = 0; k < B; ++k)
      for (int c = 0; c < C; ++c) sum[std::size_t(k * C + c)] += rest[std::size_t(k * C + c)];
    for (int c = 0; c < C; ++c) {
      const double x = rest[std::size_t(c)], y = rest[std::size_t(C + c)], w = rest[std::size_t(2 * C + c)];
      sum[std::size_t(3 * C + c)] += d[1] * w - d[2] * y;
      sum[std::size_t(4 * C + c)] += d[2] * x - d[0] * w;
      sum[std::size_t(5 * C + c)] += d[0] * y - d[1] * x;
    }
  }
  coarse_->template precondition<C>(gathered, motion);
  if (coarse_->coarse_) {  // once more: a W cycle
    Stack<6, C> rest(gathered.size()), more(gathered.size());
    multiply<6, C>(coarse_->matrix_, motion, rest);
    for (std::size_t b = 0; b < rest.size(); ++b)
      for (std::size_t k = 0; k < rest[b].size(); ++k) rest[b][k] = gathered[b][k] - rest[b][k];
    coarse_->template precondition<C>(rest, more);
    for (std::size_t b = 0; b < rest.size(); ++b)
      for (std::size_t k = 0; k < rest[b].size(); ++k) motion[b][k] += more[b][k];
  }
  for (std::size_t p = 0; p < n; ++p) {
    if (aggregate_[p] == alone) continue;
    const Tile<6, C>& m = motion[aggregate_[p]];
    const Vec3& d = offset_[p];
    for (int k = 0; k < B; ++k)
      for (int c = 0; c < C; ++c) z[p][std::size_t(k * C + c)] += m[std::size_t(k * C + c)];
    for (int c = 0; c < C; ++c) {
      const double x = m[std::size_t(3 * C + c)], y = m[std::size_t(4 * C + c)], w = m[std::size_t(5 * C + c)];
      z[p][std::size_t(c)] += y * d[2] - w * d[1];
      z[p][std::size_t(C + c)] += w * d[0] - x * d[2];
      z[p][std::size_t(2 * C + c)] += x * d[1] - y * d[0];
    }
  }
  for (std::size_t p = n; p-- > 0;) {  // backwards over all
    Tile<B, C> sum = r[p];
    for (std::size_t e = a.begin[p]; e < a.begin[p + 1]; ++e) add_product<B, C>(-1, a.block[e], z[a.column[e]], sum);
    // On the range of D alone: elsewhere z keeps what the coarse motion gave it.
    Tile<B, C> through{}, now = z[p];
    add_product<B, C>(-1, a.diagonal[p], now, sum);
    add_product<B, C>(1, a.inverse[p], sum, through);
    for (std::size_t k = 0; k < now.size(); ++k) z[p][k] = now[k] + through[k];
  }
}

template <int B>
template <int C>
typename Multigrid<B>::Report Multigrid<B>::solve(const Stack<B, C>& b, Stack<B, C>& x, const Goal<C>& goal) const {
  using Sums = std::array<double, std::size_t(C)>;
  const std::size_t n = matrix_.nodes();
  auto dot = [n](const Stack<B, C>& u, const Stack<B, C>& v) {
    Sums sum{};
    for (std::size_t p = 0; p < n; ++p)
      for (int k = 0; k < B; ++k)
        for (int c = 0; c < C; ++c) sum[std::size_t(c)] += u[p][std::size_t(k * C + c)] * v[p][std::size_t(k * C + c)];
    return sum;
  };
  auto add = [n](Stack<B, C>& y, const Sums& factor, const Stack<B, C>& v) {
    for (std::size_t p = 0; p < n; ++p)
      for (int k = 0; k < B; ++k)
        for (int c = 0; c < C; ++c)
          y[p][std::size_t(k * C + c)] += factor[std::size_t(c)] * v[p][std::size_t(k * C + c)];
  };
  Report report;
  x.assign(n, {});
  Stack<B, C> r = b, z(n), q(n);
  precondition<C>(r, z);
  Stack<B, C> p = z;
  Sums rz = dot(r, z);
  const Sums first = rz;
  std::array<bool, std::size_t(C)> done{};
  auto finished = [&] {
    const Sums squares = dot(r, r);
    report.converged = true;
    report.error = 0;
    for (std::size_t c = 0; c < std::size_t(C); ++c) {
      const bool small = squares[c] <= goal.floor[c] * goal.floor[c];
      const double fall = first[c] > 0 ? std::sqrt(std::abs(rz[c] / first[c])) : 0.0;
      done[c] = done[c] || small || fall <= goal.tolerance;
      if (done[c]) continue;
      report.converged = false;
      report.error = std::max(report.error, fall);
    }
    return report.converged;
  };
  while (!finished() && report.iterations < goal.most_iterations) {
    multiply<B, C>(matrix_, p, q);
    const Sums curvature = dot(p, q), before = rz;
    Sums step{}, back{};
    for (std::size_t c = 0; c < std::size_t(C); ++c) {
      if (!(curvature[c] > 0)) done[c] = true;  // nothing is left but what the matrix does not see
      if (!done[c]) step[c] = rz[c] / curvature[c], back[c] = -step[c];
    }
    add(x, step, p);
    add(r, back, q);
    ++report.iterations;
    precondition<C>(r, z);
    rz = dot(r, z);
    for (std::size_t m = 0; m < n; ++m)
      for (int k = 0; k < B; ++k)
        for (int c = 0; c < C; ++c) {
          const auto at = std::size_t(k * C + c);
          const double turn = done[std::size_t(c)] ? 0.0 : rz[std::size_t(c)] / before[std::size_t(c)];
          p[m][at] = z[m][at] + turn * p[m][at];
        }
  }
  return report;
}

template <int B>
std::size_t Multigrid<B>::bytes() const {
  const std::size_t own = matrix_.block.capacity() * (sizeof(Tile<B, B>) + sizeof(Vec3) + 4) +
                          matrix_.nodes() * (2 * sizeof(Tile<B, B>) + sizeof(Vec3) + 20);
  return own + (coarse_ ? coarse_->bytes() : 0);
}

template class Multigrid<3>;
template class Multigrid<6>;
template Multigrid<3>::Report Multigrid<3>::solve<6>(const Stack<3, 6>&, Stack<3, 6>&, const Goal<6>&) const;
template Multigrid<3>::Report Multigrid<3>::solve<1>(const Stack<3, 1>&, Stack<3, 1>&, const Goal<1>&) const;
template Multigrid<6>::Report Multigrid<6>::solve<6>(const Stack<6, 6>&, Stack<6, 6>&, const Goal<6>&) const;
template Multigrid<6>::Report Multigrid<6>::solve<1>(const Stack<6, 1>&, Stack<6, 1>&, const Goal<1>&) const;
template std::size_t count_soft_modes(const BlockRows<3>&, double);
template std::size_t count_soft_modes(const BlockRows<6>&, double);

}  // namespace densify::dem
