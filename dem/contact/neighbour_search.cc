#include "dem/contact/neighbour_search.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <exception>
#include <sstream>

#include "base/check.h"
#include "dem/parallel.h"

namespace densify::dem {
namespace {

using Vec3i = std::array<std::int32_t, 3>;

constexpr int max_levels = 32;
constexpr double max_cells_per_direction = 1 << 30;
// Rounding of fractional coordinates, in parts of the domain: more than the rounding, less than any cell.
constexpr double fraction_slack = 1e-12;

/// Without SSE 4.1 std::floor is a call.
inline double floor_of(double x) {
  const double cut = double(std::int64_t(x));
  return cut > x ? cut - 1 : cut;
}

/// The grid of one class of sizes: particles with radii between r_max / 2 and r_max of the class.
struct Level {
  double r_max = 0;         // [m]
  std::uint32_t count = 0;  // particles
  Vec3i cells = {1, 1, 1};  // along each direction
  std::uint64_t stride_y = 0, stride_z = 0;
  std::uint64_t mask = 0;  // all ones when every cell has a bucket of its own
  std::uint32_t first_bucket = 0, buckets = 0;

  bool dense() const { return mask == ~std::uint64_t(0); }
  std::uint32_t bucket(const Vec3i& c) const {
    return first_bucket +
           std::uint32_t((std::uint64_t(c[0]) + stride_y * std::uint64_t(c[1]) + stride_z * std::uint64_t(c[2])) &
                         mask);
  }
};

/// One particle in the order of the grid.
struct Entry {
  Vec3 x;
  double r;
  std::uint32_t index;
  Vec3i cell;
};

/// The parallelepiped that the grids divide: the periodic cell, or the box around a free specimen.
struct Domain {
  bool periodic;
  Mat3 h, to_fraction;
  Vec3 origin, widths;
};

Domain make_domain(std::span<const Body> bodies, const Cell& cell, double largest_reach) {
  if (cell.periodic) return {true, cell.h, cell.h.inverse(), cell.origin, cell.widths()};
  Vec3 lower = bodies[0].position, upper = lower;
  for (const Body& b : bodies) {
    lower = lower.cwiseMin(b.position);
    upper = upper.cwiseMax(b.position);
  }
  const Vec3 span = (upper - lower).cwiseMax(largest_reach);
  return {false, span.asDiagonal(), span.cwiseInverse().asDiagonal(), lower, span};
}

void size_grid(Level& level, const Domain& domain, double skin) {
  const double size = 2 * level.r_max + skin;
  double cells = 1;
  for (int k = 0; k < 3; ++k) {
    level.cells[k] = std::int32_t(std::clamp(std::floor(domain.widths[k] / size), 1.0, max_cells_per_direction));
    cells *= level.cells[k];
  }
  if (cells <= 4.0 * level.count + 64) {
    level.buckets = std::uint32_t(cells);
    level.mask = ~std::uint64_t(0);
    level.stride_y = std::uint64_t(level.cells[0]);
    level.stride_z = level.stride_y * std::uint64_t(level.cells[1]);
  } else {  // sparse: cells share buckets, and an entry says which cell it is in
    level.buckets = std::bit_ceil(2 * level.count);
    level.mask = level.buckets - 1;
    level.stride_y = 0x9E3779B97F4A7C15u;
    level.stride_z = 0xC2B2AE3D27D4EB4Fu;
  }
}

class Search {
 public:
  Search(std::span<const Body> bodies, const Cell& cell, double skin);
  void run(int threads, std::vector<CandidatePair>& out) const;

 private:
  void fill_grids(std::span<const Body> bodies);
  void search_slots(std::uint32_t begin, std::uint32_t end, std::vector<CandidatePair>& out) const;
  void search_level(std::uint32_t slot, int own, int other, std::vector<CandidatePair>& out) const;
  template <class Inside>
  void search_run(const Entry& a, std::uint32_t begin, std::uint32_t end, const std::array<int, 3>& image,
                  std::vector<CandidatePair>& out, Inside&& inside) const;
  [[noreturn]] void refuse_cell(const std::array<int, 3>& image, double reach) const;
  int level_of(double r) const { return std::min(std::ilogb(largest_radius_ / r), max_levels - 1); }

  double skin_;
  double largest_radius_ = 0;
  Domain domain_;
  std::array<Level, max_levels> levels_;
  std::vector<std::uint32_t> start_;  // first entry of each bucket, all levels one after another
  std::vector<Entry> entries_;
};

Search::Search(std::span<const Body> bodies, const Cell& cell, double skin) : skin_(skin) {
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    if (!bodies[i].position.allFinite() || !std::isfinite(bodies[i].radius))
      throw RunError("particle " + std::to_string(i) + " has a position or radius that is not finite");
    largest_radius_ = std::max(largest_radius_, bodies[i].radius);
  }
  const double reach = 2 * largest_radius_ + skin;
  domain_ = make_domain(bodies, cell, reach);
  if (domain_.periodic) {
    for (int k = 0; k < 3; ++k) {
      if (2 * domain_.widths[k] < reach) refuse_cell({k == 0, k == 1, k == 2}, reach);
    }
  }
  fill_grids(bodies);
}

void Search::refuse_cell(const std::array<int, 3>& image, double reach) const {
  int k = 0;
  for (int m = 0; m < 3; ++m) {
    if (std::abs(image[m]) > std::abs(image[k])) k = m;
  }
  std::ostringstream s;
  s << "the periodic cell is too small for its particles: it is " << domain_.widths[k] << " m wide along "
    << "abc"[k] << " (particles touch beyond the next image); make it at least " << reach
    << " m wide, the largest sum of radii plus the search margin";
  throw InputError(s.str());
}

void Search::fill_grids(std::span<const Body> bodies) {
  for (const Body& b : bodies) {
    Level& level = levels_[level_of(b.radius)];
    level.r_max = std::max(level.r_max, b.radius);
    ++level.count;
  }
  std::uint32_t buckets = 0;
  for (Level& level : levels_) {
    if (level.count == 0) continue;
    size_grid(level, domain_, skin_);
    level.first_bucket = buckets;
    buckets += level.buckets;
  }

  std::vector<std::uint32_t> bucket_of(bodies.size());
  start_.assign(buckets + 1, 0);
  const auto cell_of = [&](const Body& b, const Level& level) {
    const Vec3 s = domain_.to_fraction * (b.position - domain_.origin);
    Vec3i c;
    for (int k = 0; k < 3; ++k) {
      DENSIFY_EXPECT(s[k] > -1e-9 && s[k] < 1 + 1e-9);
      c[k] = std::int32_t(std::clamp(floor_of(s[k] * level.cells[k]), 0.0, level.cells[k] - 1.0));
    }
    return c;
  };
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const Level& level = levels_[level_of(bodies[i].radius)];
    bucket_of[i] = level.bucket(cell_of(bodies[i], level));
    ++start_[bucket_of[i] + 1];
  }
  for (std::size_t b = 0; b < buckets; ++b) start_[b + 1] += start_[b];
  entries_.resize(bodies.size());
  for (std::size_t i = bodies.size(); i-- > 0;) {  // backwards: the ends become the starts, entries ascend
    const Body& b = bodies[i];
    entries_[--start_[bucket_of[i] + 1]] = {b.position, b.radius, std::uint32_t(i),
                                            cell_of(b, levels_[level_of(b.radius)])};
  }
  for (std::size_t b = 0; b < buckets; ++b) start_[b] = start_[b + 1];
  start_[buckets] = std::uint32_t(bodies.size());
}

void Search::run(int threads, std::vector<CandidatePair>& out) const {
  const std::uint32_t n = std::uint32_t(entries_.size());
  if (threads == 1) return search_slots(0, n, out);
  const std::size_t parts = std::size_t(threads);
  std::vector<std::vector<CandidatePair>> found(parts);
  std::vector<std::exception_ptr> thrown(parts);  // none may leave its thread
  in_parts(parts, threads, [&](std::size_t t, std::size_t) {
    try {
      search_slots(std::uint32_t(detail::part(n, int(t), threads)), std::uint32_t(detail::part(n, int(t) + 1, threads)),
                   found[t]);
    } catch (...) {
      thrown[t] = std::current_exception();
    }
  });
  for (const auto& e : thrown)
    if (e) std::rethrow_exception(e);
  for (const auto& f : found) out.insert(out.end(), f.begin(), f.end());
}

void Search::search_slots(std::uint32_t first, std::uint32_t last, std::vector<CandidatePair>& out) const {
  for (int own = 0; own < max_levels; ++own) {
    const Level& level = levels_[own];
    if (level.count == 0) continue;
    const std::uint32_t begin = start_[level.first_bucket];
    for (std::uint32_t slot = std::max(begin, first); slot < std::min(begin + level.count, last); ++slot) {
      for (int other = 0; other <= own; ++other) {
        if (levels_[other].count > 0) search_level(slot, own, other, out);
      }
    }
  }
}

/// Every copy of a cell that may hold a partner has one place c in the lattice of all cells, and one image of the
/// domain, floor(c / cells): walking over c meets each image once, however narrow the domain is.
void Search::search_level(std::uint32_t slot, int own, int other, std::vector<CandidatePair>& out) const {
  const Entry& e = entries_[slot];
  const Level& level = levels_[other];
  const double reach = e.r + level.r_max + skin_;
  const Vec3 s = domain_.to_fraction * (e.x - domain_.origin);
  Vec3i lower, upper;
  for (int k = 0; k < 3; ++k) {
    const double n = level.cells[k], d = reach / domain_.widths[k] + fraction_slack;
    double lo = floor_of((s[k] - d) * n), hi = floor_of((s[k] + d) * n);
    if (!domain_.periodic) {
      lo = std::clamp(lo, 0.0, n - 1);
      hi = std::clamp(hi, 0.0, n - 1);
    }
    lower[k] = std::int32_t(lo);
    upper[k] = std::int32_t(hi);
  }
  // Within a level each pair is met from one side only: from the cell that comes first in the order (z, y, x).
  const bool half = own == other;
  const bool periodic = domain_.periodic;
  const auto image_of = [periodic](std::int32_t c, std::int32_t n) {
    if (!periodic) return 0;  // the division costs more than the visit of an empty cell
    return c >= 0 ? c / n : -((n - 1 - c) / n);
  };
  for (std::int32_t z = half ? e.cell[2] : lower[2]; z <= upper[2]; ++z) {
    const int iz = image_of(z, level.cells[2]);
    const bool same_z = half && z == e.cell[2];
    for (std::int32_t y = same_z ? e.cell[1] : lower[1]; y <= upper[1]; ++y) {
      const int iy = image_of(y, level.cells[1]);
      const bool same_row = same_z && y == e.cell[1];
      // Where every cell has its own bucket, the cells of a row follow each other and are one run for each image.
      for (std::int32_t x = same_row ? e.cell[0] : lower[0], next; x <= upper[0]; x = next) {
        const std::int32_t ix = image_of(x, level.cells[0]), origin = ix * level.cells[0];
        next = level.dense() ? std::min(upper[0] + 1, origin + level.cells[0]) : x + 1;
        const Vec3i cell{x - origin, y - iy * level.cells[1], z - iz * level.cells[2]};
        const std::uint32_t bucket = level.bucket(cell);
        const std::uint32_t first = same_row && x == e.cell[0] ? slot + 1 : 0;
        search_run(e, std::max(start_[bucket], first), start_[bucket + std::uint32_t(next - x)], {ix, iy, iz}, out,
                   [&](const Entry& b) { return level.dense() || b.cell == cell; });
      }
    }
  }
}

template <class Inside>
void Search::search_run(const Entry& a, std::uint32_t begin, std::uint32_t end, const std::array<int, 3>& image,
                        std::vector<CandidatePair>& out, Inside&& inside) const {
  if (begin >= end) return;
  const bool here = image == std::array{0, 0, 0};
  const Vec3 shift = here ? Vec3(Vec3::Zero()) : Vec3(domain_.h * Vec3(image[0], image[1], image[2]));
  for (std::uint32_t n = begin; n < end; ++n) {
    const Entry& b = entries_[n];
    const Vec3 d = (b.x - a.x) + shift;  // the same to the last bit when i and j change places
    const double reach = a.r + b.r + skin_;
    if (!(d.squaredNorm() < reach * reach) || !inside(b)) continue;
    for (int k = 0; k < 3; ++k) {
      if (std::abs(image[k]) > 1) refuse_cell(image, reach);
    }
    const std::uint8_t code = ImageCode::of(image[0], image[1], image[2]);
    const std::uint8_t opposite = 2 * ImageCode::none - code;
    if (a.index < b.index)
      out.push_back({a.index, b.index, code});
    else if (a.index > b.index)
      out.push_back({b.index, a.index, opposite});
    else
      out.push_back({a.index, a.index, std::max(code, opposite)});
  }
}

/// By a counting sort over i, then the few of each i by j and image.
void sort_pairs(std::vector<CandidatePair>& pairs, std::size_t particles) {
  std::vector<std::size_t> end(particles + 1, 0);
  for (const CandidatePair& p : pairs) ++end[p.i + 1];
  for (std::size_t i = 0; i < particles; ++i) end[i + 1] += end[i];
  std::vector<std::size_t> next(end.begin(), end.end() - 1);
  // In place it would go round cycles in which every move waits for the last.
  std::vector<CandidatePair> sorted(pairs.size());
  for (const CandidatePair& p : pairs) sorted[next[p.i]++] = p;
  pairs.swap(sorted);
  for (std::size_t i = 0; i < particles; ++i) std::sort(pairs.begin() + end[i], pairs.begin() + end[i + 1]);
}

}  // namespace

void find_pairs(std::span<const Body> bodies, const Cell& cell, double skin, int threads,
                std::vector<CandidatePair>& out) {
  out.clear();
  if (bodies.empty()) return;
  DENSIFY_EXPECT(skin >= 0);
  Search(bodies, cell, skin).run(threads, out);
  sort_pairs(out, bodies.size());
}

}  // namespace densify::dem
