#pragma once
// Particles in an order that follows their places.

#include <cstdint>
#include <vector>

#include "dem/state/particles.h"

namespace densify::dem {

/// Order of the particles along a Morton curve through cells of about one particle, so that neighbours are near in
/// memory and a range of particles is compact in space.
std::vector<std::uint32_t> spatial_order(const Particles&);

/// Puts values into an order; leaves an empty vector as it is.
template <class T>
void permute(std::vector<T>& values, const std::vector<std::uint32_t>& order) {
  if (values.empty()) return;
  std::vector<T> sorted(values.size());
  for (std::size_t p = 0; p < order.size(); ++p) sorted[p] = values[order[p]];
  values = std::move(sorted);
}

}  // namespace densify::dem
