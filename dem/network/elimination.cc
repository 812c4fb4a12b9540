#include "dem/network/elimination.h"

#include <Eigen/Core>
#include <algorithm>

namespace densify::dem {

namespace {

template <int B>
using Block = Eigen::Matrix<double, B, B, Eigen::RowMajor>;

template <int B>
Eigen::Map<const Block<B>> view(const Tile<B, B>& tile) {
  return Eigen::Map<const Block<B>>(tile.data());
}
template <int B>
Eigen::Map<Block<B>> view(Tile<B, B>& tile) {
  return Eigen::Map<Block<B>>(tile.data());
}

template <int B>
struct Neighbour {
  std::uint32_t column;
  Tile<B, B> block;
  Vec3 branch;
};

template <int B>
using Row = std::vector<Neighbour<B>>;

template <int B>
Neighbour<B>* find(Row<B>& row, std::uint32_t column) {
  for (auto& n : row)
    if (n.column == column) return &n;
  return nullptr;
}

template <int B>
void subtract(Row<B>& row, std::uint32_t column, const Block<B>& change, const Vec3& branch) {
  Neighbour<B>* to = find<B>(row, column);
  if (!to) to = &row.emplace_back(Neighbour<B>{column, {}, branch});
  view<B>(to->block) -= change;
}

/// Rows whose columns differ: several contacts between two particles, through several images, are added up.
template <int B>
std::vector<Row<B>> rows_of(const BlockRows<B>& a) {
  std::vector<Row<B>> rows(a.nodes());
  for (std::size_t n = 0; n < a.nodes(); ++n)
    for (std::size_t e = a.begin[n]; e < a.begin[n + 1]; ++e) {
      if (auto* const same = find<B>(rows[n], a.column[e]))
        view<B>(same->block) += view<B>(a.block[e]);
      else
        rows[n].push_back({a.column[e], a.block[e], a.branch[e]});
    }
  return rows;
}

}  // namespace

template <int B>
Elimination<B>::Elimination(BlockRows<B> a, std::size_t most_neighbours) {
  const std::size_t n = a.nodes();
  std::vector<Row<B>> rows = rows_of(a);
  std::vector<Tile<B, B>> diagonal = std::move(a.diagonal);
  const std::vector<double> scale = std::move(a.scale);
  a = {};
  // Nodes by number of neighbours; an entry counts while the number is still true.
  std::vector<std::vector<std::uint32_t>> open(most_neighbours + 1);
  auto queue = [&](std::uint32_t p) {
    if (rows[p].size() <= most_neighbours) open[rows[p].size()].push_back(p);
  };
  for (std::uint32_t p = std::uint32_t(n); p-- > 0;) queue(p);
  std::vector<bool> gone(n, false);
  for (std::size_t d = 0; d <= most_neighbours;) {
    if (open[d].empty()) {
      ++d;
      continue;
    }
    const std::uint32_t p = open[d].back();
    open[d].pop_back();
    if (gone[p] || rows[p].size() != d) continue;
    gone[p] = true;
    Row<B> row = std::move(rows[p]);
    rows[p] = {};
    const std::size_t begin = column_.size();
    steps_.push_back({p, begin, root_of_inverse<B>(diagonal[p], scale[p])});
    for (const auto& q : row) {
      column_.push_back(q.column);
      view<B>(block_.emplace_back()) = view<B>(steps_.back().root) * view<B>(q.block);
      Row<B>& other = rows[q.column];
      *find<B>(other, p) = other.back();
      other.pop_back();
    }
    for (std::size_t k = 0; k < row.size(); ++k) {
      const std::uint32_t q = row[k].column;
      const Block<B> half = view<B>(block_[begin + k]).transpose();
      view<B>(diagonal[q]) -= half * half.transpose();
      for (std::size_t m = 0; m < k; ++m) {
        const std::uint32_t s = row[m].column;
        const Block<B> change = half * view<B>(block_[begin + m]);
        subtract<B>(rows[q], s, change, row[m].branch - row[k].branch);
        subtract<B>(rows[s], q, change.transpose(), row[k].branch - row[m].branch);
      }
    }
    for (const auto& q : row) {
      d = std::min(d, rows[q.column].size());
      queue(q.column);
    }
  }
  std::vector<std::uint32_t> place(n, 0);
  for (std::uint32_t p = 0; p < n; ++p)
    if (!gone[p]) place[p] = std::uint32_t(kept_.size()), kept_.push_back(p);
  for (const std::uint32_t p : kept_) {
    Row<B> row = std::move(rows[p]);
    std::sort(row.begin(), row.end(), [](const auto& x, const auto& y) { return x.column < y.column; });
    std::size_t before = 0;
    for (const auto& q : row) {
      before += q.column < p;
      core_.column.push_back(place[q.column]), core_.block.push_back(q.block), core_.branch.push_back(q.branch);
    }
    core_.middle.push_back(core_.begin.back() + before);
    core_.begin.push_back(core_.column.size());
    core_.diagonal.push_back(diagonal[p]);
    core_.scale.push_back(scale[p]);
  }
}

template <int B>
template <int C>
Stack<B, C> Elimination<B>::forward(Stack<B, C>& b) const {
  for (std::size_t s = 0; s < steps_.size(); ++s) {
    Tile<B, C> own{};  // R b
    add_product<B, C>(1, steps_[s].root, b[steps_[s].node], own);
    b[steps_[s].node] = own;
    for (std::size_t e = steps_[s].begin; e < end_of(s); ++e) {
      Tile<B, B> transposed;
      view<B>(transposed) = view<B>(block_[e]).transpose();
      add_product<B, C>(-1, transposed, own, b[column_[e]]);
    }
  }
  Stack<B, C> core;
  core.reserve(kept_.size());
  for (const std::uint32_t p : kept_) core.push_back(b[p]);
  return core;
}

template <int B>
template <int C>
void Elimination<B>::back(const Stack<B, C>& b, const Stack<B, C>& core, Stack<B, C>& x) const {
  x.assign(b.size(), {});
  for (std::size_t k = 0; k < kept_.size(); ++k) x[kept_[k]] = core[k];
  for (std::size_t s = steps_.size(); s-- > 0;) {
    Tile<B, C> rest = b[steps_[s].node];
    for (std::size_t e = steps_[s].begin; e < end_of(s); ++e) add_product<B, C>(-1, block_[e], x[column_[e]], rest);
    Tile<B, B> transposed;
    view<B>(transposed) = view<B>(steps_[s].root).transpose();
    add_product<B, C>(1, transposed, rest, x[steps_[s].node]);
  }
}

template <int B>
std::size_t Elimination<B>::bytes() const {
  return steps_.size() * sizeof(Step) + block_.size() * (sizeof(Tile<B, B>) + 4);
}

template class Elimination<3>;
template class Elimination<6>;
#define DENSIFY_COLUMNS(B, C)                                          \
  template Stack<B, C> Elimination<B>::forward<C>(Stack<B, C>&) const; \
  template void Elimination<B>::back<C>(const Stack<B, C>&, const Stack<B, C>&, Stack<B, C>&) const;
DENSIFY_COLUMNS(3, 6) DENSIFY_COLUMNS(3, 7) DENSIFY_COLUMNS(6, 6) DENSIFY_COLUMNS(6, 7)

}  // namespace densify::dem
