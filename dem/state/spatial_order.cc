#include "dem/state/spatial_order.h"

#include <algorithm>
#include <utility>

namespace densify::dem {

namespace {

/// The lowest 21 bits of x, each followed by two zeros.
std::uint64_t spread(std::uint64_t x) {
  x &= 0x1fffff;
  x = (x | x << 32) & 0x1f00000000ffff;
  x = (x | x << 16) & 0x1f0000ff0000ff;
  x = (x | x << 8) & 0x100f00f00f00f00f;
  x = (x | x << 4) & 0x10c30c30c30c30c3;
  return (x | x << 2) & 0x1249249249249249;
}

}  // namespace

std::vector<std::uint32_t> spatial_order(const Particles& particles) {
  Vec3 low = Vec3::Constant(1e300), high = Vec3::Constant(-1e300);
  double mean = 0;
  for (std::size_t p = 0; p < particles.size(); ++p) {
    low = low.cwiseMin(particles.body[p].position);
    high = high.cwiseMax(particles.body[p].position);
    mean += particles.reference_radius[p] / double(particles.size());
  }
  const Vec3 span = (high - low).cwiseMax(mean);
  const double edge = std::max(2 * mean, span.maxCoeff() / 1e6);
  auto cell_of = [&](std::uint32_t p) {
    const Vec3 s = (particles.body[p].position - low) / edge;
    return spread(std::uint64_t(s[2])) << 2 | spread(std::uint64_t(s[1])) << 1 | spread(std::uint64_t(s[0]));
  };
  std::vector<std::pair<std::uint64_t, std::uint32_t>> keyed(particles.size());
  for (std::uint32_t p = 0; p < keyed.size(); ++p) keyed[p] = {cell_of(p), p};
  std::sort(keyed.begin(), keyed.end());
  std::vector<std::uint32_t> order(keyed.size());
  for (std::size_t p = 0; p < order.size(); ++p) order[p] = keyed[p].second;
  return order;
}

}  // namespace densify::dem
