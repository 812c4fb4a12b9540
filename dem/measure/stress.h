#pragma once
// A stress as six numbers, and what one reads of it.

#include <array>
#include <cmath>

#include "dem/state/particles.h"

namespace densify::dem {

/// A symmetric tensor: xx yy zz yz xz xy; tension positive.
using Stress = std::array<double, 6>;

/// Adds the symmetric part of arm (x) force (6.6).
inline void add_symmetric(Stress& sum, const Vec3& arm, const Vec3& force) {
  constexpr int row[6] = {0, 1, 2, 1, 0, 0}, column[6] = {0, 1, 2, 2, 2, 1};
  for (std::size_t c = 0; c < 6; ++c) sum[c] += 0.5 * (arm[row[c]] * force[column[c]] + arm[column[c]] * force[row[c]]);
}

/// Mean stress (6.8), negative under pressure.
inline double mean_stress(const Stress& s) {
  return (s[0] + s[1] + s[2]) / 3;
}

/// Deviatoric stress (6.7).
inline Stress deviator(const Stress& s) {
  const double mean = mean_stress(s);
  return {s[0] - mean, s[1] - mean, s[2] - mean, s[3], s[4], s[5]};
}

/// Von Mises stress sqrt(3/2 s:s) of the deviator s.
inline double von_mises_stress(const Stress& s) {
  const double xy = s[0] - s[1], yz = s[1] - s[2], zx = s[2] - s[0];
  return std::sqrt(0.5 * (xy * xy + yz * yz + zx * zx) + 3 * (s[3] * s[3] + s[4] * s[4] + s[5] * s[5]));
}

}  // namespace densify::dem
