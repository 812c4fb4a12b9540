#pragma once
// A running mean that follows a steady rate and a steady acceleration without offset: what a damper measures vibration
// against, so that it costs a driven boundary no force in steady motion.

namespace densify::dem {

/// e = v - mean, mean' = slope + 2 e/T, slope' = e/T^2 with the memory T [s]; implicit in the filter, so that it is
/// stable for any step.
inline void follow(double value, double memory, double step, double& mean, double& slope) {
  const double x = step / memory;
  const double e = (value - mean - step * slope) / (1 + 2 * x + x * x);
  slope += x * e / memory;
  mean += step * slope + 2 * x * e;
}

}  // namespace densify::dem
