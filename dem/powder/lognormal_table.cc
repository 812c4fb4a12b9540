#include "dem/powder/lognormal_table.h"

#include <algorithm>
#include <cmath>

#include "dem/powder/refuse.h"

namespace densify::dem {
namespace {

constexpr int panels = 1024;           // even; the integrals are then exact to about 1e-10
constexpr double negligible = 40;      // densities below exp(-40) of the largest are left out
constexpr double relative_gap = 1e-9;  // at which the moments count as met

}  // namespace

LognormalTable::LognormalTable(const TruncatedLognormal& requested) : requested_(requested) {
  const auto& [mean, deviation, minimum, maximum] = requested_;
  if (!(minimum > 0 && mean > minimum && maximum > mean && std::isfinite(maximum)))
    refuse("a truncated lognormal needs 0 < minimum < mean < maximum; they are ", minimum, ", ", mean, " and ", maximum,
           " m");
  if (!(deviation > 0)) refuse("the standard deviation of the diameters must be above zero; it is ", deviation, " m");
  width_ = std::log(maximum / minimum);

  // At the mean requested the deviation falls with kappa; at kappa = 0 the lognormal is infinitely wide before the cut.
  const double widest = moments_at_mean(0).standard_deviation;
  if (deviation >= widest)
    refuse("no lognormal between ", minimum, " and ", maximum, " m with mean ", mean, " m has a standard deviation of ",
           deviation, " m; it must be below ", widest, " m");
  double low = 0, high = 1;
  while (moments_at_mean(high).standard_deviation > deviation) {
    low = high;
    high *= 2;
  }
  while (high - low > relative_gap * high) {
    const double middle = (low + high) / 2;
    (moments_at_mean(middle).standard_deviation > deviation ? low : high) = middle;
  }
  // Trapezoids: their error is far below the spacing of any sample.
  cumulative_.assign(panels + 1, 0);
  for (int k = 0; k < panels; ++k) cumulative_[k + 1] = cumulative_[k] + (density_[k] + density_[k + 1]) / 2;
}

LognormalTable::Moments LognormalTable::moments_at_mean(double kappa) {
  // The mean grows with lambda; start where the mode is the mean.
  const double start = kappa * std::log(requested_.mean / requested_.minimum) / width_;
  const auto mean_at = [&](double lambda) {
    tabulate(lambda, kappa);
    return moments().mean;
  };
  double step = 1 + std::sqrt(kappa), low = start - step, high = start + step;
  for (; mean_at(low) > requested_.mean; step *= 2) low -= step;
  for (; mean_at(high) < requested_.mean; step *= 2) high += step;
  while (high - low > relative_gap * (1 + std::abs(start))) {
    const double middle = (low + high) / 2;
    (mean_at(middle) < requested_.mean ? low : high) = middle;
  }
  tabulate((low + high) / 2, kappa);
  return moments();
}

void LognormalTable::tabulate(double lambda, double kappa) {
  lambda_ = lambda;
  kappa_ = kappa;
  const double top = kappa > 0 ? std::clamp(lambda / kappa, 0.0, 1.0) : (lambda > 0 ? 1.0 : 0.0);
  const double slope = std::abs(lambda - kappa * top);
  // Distance from the top at which slope t + kappa t^2 / 2 = negligible.
  const double reach = 2 * negligible / (slope + std::sqrt(slope * slope + 2 * kappa * negligible));
  u_first_ = std::max(0.0, top - reach);
  u_step_ = (std::min(1.0, top + reach) - u_first_) / panels;
  density_.resize(panels + 1);
  for (int k = 0; k <= panels; ++k) {
    const double t = u_first_ + k * u_step_ - top;
    density_[k] = std::exp((lambda - kappa * top) * t - kappa * t * t / 2);
  }
}

LognormalTable::Moments LognormalTable::moments() const {
  double sum = 0, first = 0, second = 0;
  const double centre = requested_.mean;
  for (int k = 0; k <= panels; ++k) {
    const double simpson = k == 0 || k == panels ? 1 : k % 2 ? 4 : 2;
    const double w = simpson * density_[k], d = diameter(u_first_ + k * u_step_) - centre;
    sum += w;
    first += w * d;
    second += w * d * d;
  }
  const double mean = first / sum;
  return {centre + mean, std::sqrt(std::max(0.0, second / sum - mean * mean))};
}

double LognormalTable::diameter(double u) const {
  return requested_.minimum * std::exp(width_ * u);
}

LognormalParameters LognormalTable::parameters() const {
  return {std::log(requested_.minimum) + width_ * lambda_ / kappa_, width_ / std::sqrt(kappa_)};
}

double LognormalTable::quantile(double q) const {
  const double target = q * cumulative_.back();
  const auto above = std::upper_bound(cumulative_.begin(), cumulative_.end(), target) - cumulative_.begin();
  const auto k = std::clamp<std::ptrdiff_t>(above - 1, 0, panels - 1);
  // Within a panel: a t + (b - a) t^2 / 2 = rest, solved without cancellation.
  const double a = density_[k], b = density_[k + 1], rest = target - cumulative_[k];
  const double root = std::sqrt(std::max(0.0, a * a + 2 * (b - a) * rest));
  const double t = a + root > 0 ? std::clamp(2 * rest / (a + root), 0.0, 1.0) : 0;
  return std::clamp(diameter(u_first_ + (double(k) + t) * u_step_), requested_.minimum, requested_.maximum);
}

LognormalParameters solve_lognormal(const TruncatedLognormal& requested) {
  return LognormalTable(requested).parameters();
}

}  // namespace densify::dem
