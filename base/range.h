#pragma once
// The values a scene key may take.

#include <limits>
#include <string>

#include "base/dimension.h"

namespace densify {

enum class Bound { inclusive, exclusive };

/// An interval of SI values; never holds NaN.
struct Range {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  Bound low_bound = Bound::inclusive;
  Bound high_bound = Bound::inclusive;

  static constexpr Range any() { return {}; }
  static constexpr Range above(double low) { return {low, any().high, Bound::exclusive, Bound::inclusive}; }
  static constexpr Range at_least(double low) { return {low, any().high, Bound::inclusive, Bound::inclusive}; }
  static constexpr Range below(double high) { return {any().low, high, Bound::inclusive, Bound::exclusive}; }
  static constexpr Range between(double low, double high) { return {low, high, Bound::inclusive, Bound::inclusive}; }
  static constexpr Range inside(double low, double high) { return {low, high, Bound::exclusive, Bound::exclusive}; }
  static constexpr Range positive() { return above(0.0); }
  static constexpr Range non_negative() { return at_least(0.0); }
  static constexpr Range unit_interval() { return between(0.0, 1.0); }

  constexpr bool contains(double value) const {
    return (low_bound == Bound::inclusive ? value >= low : value > low) &&
           (high_bound == Bound::inclusive ? value <= high : value < high);
  }

  /// "> 0 Pa", ">= 0 and < 0.5", or nothing for any().
  std::string text(Dimension dimension) const;
};

}  // namespace densify
