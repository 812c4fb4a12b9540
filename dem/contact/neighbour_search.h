#pragma once
// Which particles may touch: all pairs closer than the sum of their radii plus a margin.

#include <cstdint>
#include <span>
#include <vector>

#include "dem/state/cell.h"
#include "dem/state/particles.h"

namespace densify::dem {

/// Two particles that may touch; `i <= j`, equal only for a particle and its own periodic image.
struct CandidatePair {
  std::uint32_t i, j;
  std::uint8_t image;  ///< ImageCode of the copy of j that i sees
  auto operator<=>(const CandidatePair&) const = default;
};

/// All pairs with |x_j + shift - x_i| < r_i + r_j + skin, sorted by (i, j, image), in time and memory proportional to
/// their number for any ratio of sizes.
///
/// A pair that touches through several images is reported once for each; of the two opposite images through which a
/// particle touches itself only the code above ImageCode::none is kept.
/// @param bodies  particles; in a periodic cell the positions lie inside the cell (Cell::wrap)
/// @param skin    margin, not negative [m]
/// @param out     overwritten; its memory is reused
/// @throws InputError  when a pair touches through more than one lattice translation: the cell is too small
/// @throws RunError    when a position is not finite
void find_pairs(std::span<const Body> bodies, const Cell& cell, double skin, int threads,
                std::vector<CandidatePair>& out);

}  // namespace densify::dem
