#include "fem/resolution.h"

#include <cmath>
#include <limits>

#include "base/check.h"

namespace densify::fem {

Extrapolated extrapolate(std::span<const int> n, std::span<const double> value) {
  DENSIFY_EXPECT(n.size() == value.size());
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  const std::size_t last = n.size();
  if (last == 0) return {none, none};
  if (last == 1) return {value[0], none};
  // Lagrange's polynomial in 1/n at 0.
  auto weight = [&](std::size_t k, std::size_t first) {
    double w = 1;
    for (std::size_t j = first; j < last; ++j)
      if (j != k) w *= double(n[k]) / double(n[k] - n[j]);
    return w;
  };
  auto at_zero = [&](std::size_t first) {
    double sum = 0;
    for (std::size_t k = first; k < last; ++k) sum += weight(k, first) * value[k];
    return sum;
  };
  const double line = at_zero(last - 2);
  if (last == 2) return {line, 0.5 * std::abs(line - value[1])};
  const double parabola = at_zero(last - 3);
  return {parabola, std::abs(parabola - line)};
}

}  // namespace densify::fem
