#pragma once
// A sample in a few numbers, and in bins.

#include <cstddef>
#include <limits>
#include <vector>

namespace densify::dem {

/// NaN where a sample has too few values.
struct Statistics {
  std::size_t number = 0;
  double mean = std::numeric_limits<double>::quiet_NaN();
  double standard_deviation = std::numeric_limits<double>::quiet_NaN();  ///< sqrt(sum (x - mean)^2 / (n - 1))
  double minimum = std::numeric_limits<double>::quiet_NaN();
  double maximum = std::numeric_limits<double>::quiet_NaN();
  double median = std::numeric_limits<double>::quiet_NaN();
};
Statistics statistics(std::vector<double> sample);

/// Bins of equal width from `low` on; [low + k width, low + (k + 1) width).
struct Bins {
  double low = 0, width = 1;
  std::size_t number = 1;
};

/// At most 60 bins of a round width (1, 2 or 5 times a power of ten) for all but one value in 200 at either end: tails
/// reach so far that bins for the whole sample would show one bar.
Bins round_bins(std::vector<double> sample);

/// Values in each bin, after those below the first; last, those above.
std::vector<std::size_t> count_in(const Bins&, const std::vector<double>& sample);

}  // namespace densify::dem
