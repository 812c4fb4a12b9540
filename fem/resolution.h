#pragma once
// What a value would be on infinitely fine voxels, from the values on some.

#include <span>

namespace densify::fem {

struct Extrapolated {
  double value;  ///< NaN without any
  double error;  ///< estimated; NaN for a single resolution
};

/// Of values at n voxels along the edge, n ascending: stairs for surfaces make an error of first order in 1/n.  Three
/// and more: the parabola in 1/n through the last three, its distance from the line through the last two as the error.
/// Two: the line, with half of its step.  One: the value itself.
Extrapolated extrapolate(std::span<const int> n, std::span<const double> value);

}  // namespace densify::fem
