#include "dem/network/multigrid.h"

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

/// Inverse of P^T A P on the directions that are not those of others to rounding.
template <int C>
Eigen::Matrix<double, C, C> inverse_of_directions(const Eigen::Matrix<double, C, C>& a) {
  using Small = Eigen::Matrix<double, C, C>;
  Eigen::Matrix<double, C, 1> scale;
  for (int c = 0; c < C; ++c) scale[c] = a(c, c) > 0 ? 1 / std::sqrt(a(c, c)) : 0.0;
  const Small unit = scale.asDiagonal() * (0.5 * (a + a.transpose())) * scale.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Small> eigen(unit);
  constexpr double rounding = 1e-8;  // below it they are those of others
  Eigen::Matrix<double, C, 1> values;
  for (int c = 0; c < C; ++c) values[c] = eigen.eigenvalues()[c] > rounding ? 1 / eigen.eigenvalues()[c] : 0.0;
  const Small vectors = scale.asDiagonal() * eigen.eigenvectors();
  return vectors * values.asDiagonal() * vectors.transpose();
}

}  // namespace

template <int B>
Multigrid<B>::Multigrid(BlockRows<B> matrix, std::size_t direct_nodes) : matrix_(std::move(matrix)) {
  for (std::size_t n = 0; n < matrix_.nodes(); ++n) {
    const Block<B> root = as_matrix<B>(root_of_inverse<B>(matrix_.diagonal[n], matrix_.scale[n]));
    Eigen::Map<Block<B>>(inverse_.emplace_back().data()) = root.transpose() * root;
  }
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
  constexpr double share = 1e-10, of_scale = 1e-12;
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
    add_product<B, C>(1, inverse_[p], sum, z[p]);
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
    add_product<B, C>(1, inverse_[p], sum, through);
    for (std::size_t k = 0; k < now.size(); ++k) z[p][k] = now[k] + through[k];
  }
}

template <int B>
template <int C>
typename Multigrid<B>::Report Multigrid<B>::solve(const Stack<B, C>& b, Stack<B, C>& x, const Goal<C>& goal) const {
  using Small = Eigen::Matrix<double, C, C>;
  using Node = Eigen::Matrix<double, B, C, Eigen::RowMajor>;
  const std::size_t n = matrix_.nodes();
  auto inner = [n](const Stack<B, C>& u, const Stack<B, C>& v) {
    Small sum = Small::Zero();
    for (std::size_t k = 0; k < n; ++k)
      sum += Eigen::Map<const Node>(u[k].data()).transpose() * Eigen::Map<const Node>(v[k].data());
    return sum;
  };
  auto add = [n](Stack<B, C>& y, const Stack<B, C>& v, const Small& m) {
    for (std::size_t k = 0; k < n; ++k) Eigen::Map<Node>(y[k].data()) += Eigen::Map<const Node>(v[k].data()) * m;
  };
  Report report;
  x.assign(n, {});
  Stack<B, C> r = b, z(n), p(n, Tile<B, C>{}), q(n, Tile<B, C>{});
  Small inverse = Small::Zero();
  std::array<double, std::size_t(C)> first{};
  for (;; ++report.iterations) {
    precondition<C>(r, z);
    const Small squares = inner(r, r), rz = inner(r, z);
    Small open = Small::Zero();  // a column that is down to rounding has no direction to offer
    report.error = 0;
    for (int c = 0; c < C; ++c) {
      const auto column = std::size_t(c);
      if (report.iterations == 0) first[column] = std::abs(rz(c, c));
      if (squares(c, c) <= goal.floor[column] * goal.floor[column]) continue;
      open(c, c) = 1;
      if (first[column] > 0) report.error = std::max(report.error, std::sqrt(std::abs(rz(c, c)) / first[column]));
    }
    report.converged = report.error <= goal.tolerance;
    if (goal.watch) goal.watch(report.error);
    if (report.converged || report.iterations == goal.most_iterations) return report;
    const Small turn = -inverse * inner(q, z) * open;
    for (std::size_t k = 0; k < n; ++k) {
      Eigen::Map<Node> direction(p[k].data());
      direction = (Eigen::Map<const Node>(z[k].data()) * open + direction * turn).eval();
    }
    multiply<B, C>(matrix_, p, q);
    inverse = inverse_of_directions<C>(inner(p, q));
    const Small step = inverse * inner(p, r);
    add(x, p, step);
    add(r, q, -step);
  }
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
template Multigrid<3>::Report Multigrid<3>::solve<7>(const Stack<3, 7>&, Stack<3, 7>&, const Goal<7>&) const;
template Multigrid<6>::Report Multigrid<6>::solve<6>(const Stack<6, 6>&, Stack<6, 6>&, const Goal<6>&) const;
template Multigrid<6>::Report Multigrid<6>::solve<7>(const Stack<6, 7>&, Stack<6, 7>&, const Goal<7>&) const;

}  // namespace densify::dem
