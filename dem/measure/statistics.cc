#include "dem/measure/statistics.h"

#include <algorithm>
#include <cmath>

namespace densify::dem {

namespace {

/// The least of 1, 2 and 5 times a power of ten that is not below `size`.
double round_up(double size) {
  const double ten = std::pow(10, std::floor(std::log10(size)));
  for (const double factor : {1.0, 2.0, 5.0})
    if (factor * ten >= size) return factor * ten;
  return 10 * ten;
}

}  // namespace

Statistics statistics(std::vector<double> sample) {
  Statistics s;
  s.number = sample.size();
  if (sample.empty()) return s;
  std::sort(sample.begin(), sample.end());
  const std::size_t n = sample.size();
  s.minimum = sample.front();
  s.maximum = sample.back();
  s.median = 0.5 * (sample[(n - 1) / 2] + sample[n / 2]);
  s.mean = 0;
  for (const double x : sample) s.mean += x / double(n);
  if (n == 1) return s;
  double squares = 0;
  for (const double x : sample) squares += (x - s.mean) * (x - s.mean);
  s.standard_deviation = std::sqrt(squares / double(n - 1));
  return s;
}

Bins round_bins(std::vector<double> sample) {
  constexpr std::size_t most = 60, tail = 200;
  Bins bins;
  if (sample.empty()) return bins;
  std::sort(sample.begin(), sample.end());
  const std::size_t cut = sample.size() / tail;
  const double low = sample[cut], high = sample[sample.size() - 1 - cut];
  // Values that are equal but for rounding (zeros, mostly) get bins that show where they are.
  constexpr double rounding = 1e-9;
  const double largest = std::max(std::abs(low), std::abs(high));
  const double size = high - low > rounding * largest ? high - low : largest;
  if (size > 0) bins.width = round_up(size / double(most - 1));  // one more, for it begins at a multiple of its width
  const double first = std::floor(low / bins.width);
  bins.low = first * bins.width;
  bins.number = std::size_t(std::floor(high / bins.width) - first) + 1;
  return bins;
}

std::vector<std::size_t> count_in(const Bins& bins, const std::vector<double>& sample) {
  std::vector<std::size_t> count(bins.number + 2, 0);
  for (const double x : sample) {
    const double place = std::floor((x - bins.low) / bins.width);
    ++count[std::size_t(std::clamp(place, -1.0, double(bins.number)) + 1)];
  }
  return count;
}

}  // namespace densify::dem
