#include "dem/powder/placement.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>
#include <optional>
#include <unordered_map>

#include "dem/powder/random.h"
#include "dem/powder/refuse.h"
#include "dem/powder/size_distribution.h"

namespace densify::dem {
namespace {

constexpr double densest_trial = 0.30;  // solid fraction at which the container starts to grow
constexpr double growth = 1.03;         // of its volume from trial to trial
constexpr int trials = 400;             // down to a solid fraction of 2e-6
constexpr int cell_tries = 300;         // per particle, before a trial is given up
constexpr double cell_width = 1.03;     // least side of the coarsest cells in units of d_max
constexpr double gap = 1e-9;            // kept between neighbours and to walls, in units of the diameter
constexpr int max_levels = 14;          // sizes down to d_max / 8192; smaller ones use the finest grid

/// One attempt in a container of given size.
class Trial {
 public:
  Trial(std::span<const double> diameters, const Vec3& extent, const PlacementContainer& container, std::uint64_t seed);
  /// Places `order` one after the other; false when one finds no place.
  bool place(std::span<const std::uint32_t> order);
  std::vector<Vec3> position;

 private:
  using Cell3 = std::array<std::uint64_t, 3>;

  int level_of(double d) const;
  bool place_one(std::uint32_t particle);
  bool meets_larger(std::uint32_t particle, const Vec3& x, const Cell3& cell, int level) const;
  std::uint64_t key(const Cell3& c, int level) const {
    return (c[2] * (cells_[1] << level) + c[1]) * (cells_[0] << level) + c[0];
  }

  std::span<const double> diameters_;
  double cylinder_radius_;  // infinite for boxes
  Vec3 lower_, side_;       // of the coarsest grid
  Cell3 cells_;
  std::array<std::unordered_map<std::uint64_t, std::uint32_t>, max_levels> occupant_;
  Random random_;
};

Trial::Trial(std::span<const double> diameters, const Vec3& extent, const PlacementContainer& container,
             std::uint64_t seed)
    : position(diameters.size()), diameters_(diameters), cylinder_radius_(HUGE_VAL), random_(seed) {
  const double d_max = *std::max_element(diameters.begin(), diameters.end());
  lower_ = Vec3::Zero();
  if (std::holds_alternative<CylinderContainer>(container)) {
    cylinder_radius_ = extent[0] / 2;
    lower_ = {-cylinder_radius_, -cylinder_radius_, 0};
  }
  for (int k = 0; k < 3; ++k) {
    cells_[k] = std::uint64_t(std::max(1.0, std::floor(extent[k] / (cell_width * d_max))));
    side_[k] = extent[k] / double(cells_[k]);
  }
}

int Trial::level_of(double d) const {
  int level = 0;
  while (level + 1 < max_levels && d * (1 + gap) <= side_.minCoeff() / double(2 << level)) ++level;
  return level;
}

bool Trial::place(std::span<const std::uint32_t> order) {
  return std::all_of(order.begin(), order.end(), [&](std::uint32_t particle) { return place_one(particle); });
}

bool Trial::place_one(std::uint32_t particle) {
  const double d = diameters_[particle] * (1 + gap);
  const int level = level_of(diameters_[particle]);
  const Vec3 side = side_ / double(1 << level);
  for (int attempt = 0; attempt < cell_tries; ++attempt) {
    Cell3 cell;
    for (int k = 0; k < 3; ++k) cell[k] = random_.below(cells_[k] << level);
    if (occupant_[level].contains(key(cell, level))) continue;
    Vec3 x;
    for (int k = 0; k < 3; ++k)
      x[k] = lower_[k] + double(cell[k]) * side[k] + d / 2 + random_.uniform() * std::max(0.0, side[k] - d);
    if (std::hypot(x[0], x[1]) > cylinder_radius_ - d / 2 || meets_larger(particle, x, cell, level)) continue;
    position[particle] = x;
    occupant_[level].emplace(key(cell, level), particle);
    return true;
  }
  return false;
}

/// The grids are nested and every particle lies in its own cell: only those in the coarser cells around this one can
/// be met, one a level.
bool Trial::meets_larger(std::uint32_t particle, const Vec3& x, const Cell3& cell, int level) const {
  for (int coarser = 0; coarser < level; ++coarser) {
    const int up = level - coarser;
    const auto found = occupant_[coarser].find(key({cell[0] >> up, cell[1] >> up, cell[2] >> up}, coarser));
    if (found == occupant_[coarser].end()) continue;
    const double reach = (diameters_[particle] + diameters_[found->second]) / 2 * (1 + gap);
    if ((x - position[found->second]).squaredNorm() < reach * reach) return true;
  }
  return false;
}

/// Part of the box around the container that the container fills [-].
double filling(const PlacementContainer& container) {
  return std::holds_alternative<CylinderContainer>(container) ? std::numbers::pi / 4 : 1;
}

/// The box around a container of the given volume; no edge is shorter than the largest particle needs [m].
Vec3 extent_of(const PlacementContainer& container, double volume, double d_max) {
  if (const auto* periodic = std::get_if<PeriodicContainer>(&container)) {
    const Vec3& p = periodic->proportions;
    return p * std::max(std::cbrt(volume / p.prod()), cell_width * d_max / p.minCoeff());
  }
  const auto* cylinder = std::get_if<CylinderContainer>(&container);
  const auto* box = std::get_if<BoxContainer>(&container);
  const double x = cylinder ? cylinder->diameter : box->width_x, y = cylinder ? cylinder->diameter : box->width_y;
  return {x, y, std::max(volume / (x * y * filling(container)), cell_width * d_max)};
}

void check(std::span<const double> diameters, const PlacementContainer& container) {
  if (diameters.empty()) refuse("the powder is empty: there is no particle to place");
  for (double d : diameters) {
    if (!(d > 0 && std::isfinite(d))) refuse("particle diameters must be above zero and finite; one is ", d, " m");
  }
  if (const auto* periodic = std::get_if<PeriodicContainer>(&container)) {
    const Vec3& p = periodic->proportions;
    if (!(p.allFinite() && (p.array() > 0).all())) refuse("the edges of a periodic box must be above zero");
    return;
  }
  const double d_max = *std::max_element(diameters.begin(), diameters.end());
  const Vec3 extent = extent_of(container, 0, d_max);
  const double width = std::min(extent[0], extent[1]);
  if (!(width > d_max * (1 + 2 * gap)))
    refuse("the largest particle does not fit: its diameter is ", d_max, " m, the container is ", width,
           " m wide; widen the container or cut the distribution at a smaller maximum");
}

}  // namespace

Placement place_loosely(std::span<const double> diameters, const PlacementContainer& container, std::uint64_t seed) {
  check(diameters, container);
  std::vector<std::uint32_t> order(diameters.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](auto a, auto b) { return diameters[a] > diameters[b]; });
  const double solid = solid_volume(diameters);
  double volume = solid / densest_trial;
  for (int n = 0; n < trials; ++n, volume *= growth) {
    const Vec3 extent = extent_of(container, volume, diameters[order[0]]);
    Trial trial(diameters, extent, container, seed);
    if (trial.place(order)) return {std::move(trial.position), extent, solid / (extent.prod() * filling(container))};
  }
  refuse("no loose arrangement of the powder was found in the container; widen it");
}

}  // namespace densify::dem
