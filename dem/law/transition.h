#pragma once
// Smooth transitions between contact models (4.47-4.54).

#include <cmath>
#include <numbers>

namespace densify::dem {

/// zeta = (1 - cos(pi x))/2 of the progress x clamped to 0..1 (4.48, 4.53).
inline double cosine_step(double progress) {
  if (progress <= 0) return 0;
  if (progress >= 1) return 1;
  return 0.5 * (1 - std::cos(std::numbers::pi * progress));
}

}  // namespace densify::dem
