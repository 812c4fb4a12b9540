#include "dem/powder/size_distribution.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <numeric>

#include "dem/powder/lognormal_table.h"
#include "dem/powder/random.h"
#include "dem/powder/refuse.h"

namespace densify::dem {
namespace {

struct Moments {
  double mean, standard_deviation;
};

Moments moments(std::span<const double> d) {
  const double mean = std::accumulate(d.begin(), d.end(), 0.0) / double(d.size());
  double square = 0;
  for (double x : d) square += (x - mean) * (x - mean);
  return {mean, std::sqrt(square / double(d.size()))};
}

/// Moves the inner diameters by (alpha + beta (d - mean)) (d - minimum)(maximum - d), which keeps them inside the
/// limits, until mean and standard deviation of the sample are those requested.
void correct_moments(std::vector<double>& d, const TruncatedLognormal& requested) {
  const double range = requested.maximum - requested.minimum;
  for (int iteration = 0; iteration < 8; ++iteration) {
    const Moments m = moments(d);
    double w0 = 0, w1 = 0, w2 = 0;  // mean of weight x (d - mean)^k
    const auto weight = [&](double x) { return (x - requested.minimum) * (requested.maximum - x) / (range * range); };
    for (double x : d) {
      const double w = weight(x) / double(d.size()), t = x - m.mean;
      w0 += w;
      w1 += w * t;
      w2 += w * t * t;
    }
    // Linearised: d(mean) = alpha w0 + beta w1; d(variance) / 2 = alpha w1 + beta w2.
    const double mean_gap = requested.mean - m.mean;
    const double variance_gap = (std::pow(requested.standard_deviation, 2) - std::pow(m.standard_deviation, 2)) / 2;
    const double determinant = w0 * w2 - w1 * w1;
    const double alpha = (mean_gap * w2 - variance_gap * w1) / determinant;
    const double beta = (variance_gap * w0 - mean_gap * w1) / determinant;
    for (double& x : d) x += (alpha + beta * (x - m.mean)) * weight(x);
  }
}

using Quantile = std::function<double(double q)>;  // diameter below which the part q of the particles lies

Quantile quantile_function(const TruncatedLognormal& requested) {
  return [table = LognormalTable(requested)](double q) { return table.quantile(q); };
}

Quantile quantile_function(const SizeHistogram& h) {
  if (h.weights.empty() || h.edges.size() != h.weights.size() + 1)
    refuse("a size histogram needs one edge more than weights; it has ", h.edges.size(), " edges and ",
           h.weights.size(), " weights");
  if (!(h.edges[0] > 0)) refuse("the edges of a size histogram are diameters and must be above zero");
  std::vector<double> end(h.weights.size() + 1, 0);
  for (std::size_t k = 0; k < h.weights.size(); ++k) {
    const double a = h.edges[k], b = h.edges[k + 1], weight = h.weights[k];
    if (!(b > a && std::isfinite(b))) refuse("the edges of a size histogram must ascend; ", b, " m follows ", a, " m");
    if (!(weight >= 0 && std::isfinite(weight)))
      refuse("the weights of a size histogram must not be negative; bin ", k + 1, " has ", weight);
    const double mean_cube = (a + b) * (a * a + b * b) / 4;  // of a uniform density from a to b
    end[k + 1] = end[k] + (h.weighted_by == HistogramWeight::number ? weight : weight / mean_cube);
  }
  if (!(end.back() > 0)) refuse("the size histogram is empty: all its weights are zero");
  return [edges = h.edges, end](double q) {
    const double target = q * end.back();
    const auto bin = std::upper_bound(end.begin(), end.end() - 1, target) - end.begin() - 1;
    return edges[bin] + (edges[bin + 1] - edges[bin]) * (target - end[bin]) / (end[bin + 1] - end[bin]);
  };
}

Quantile quantile_function(const SizeList& list) {
  if (list.diameters.empty()) refuse("the list of diameters is empty");
  for (double d : list.diameters) {
    if (!(d > 0 && std::isfinite(d))) refuse("diameters must be above zero and finite; the list has ", d, " m");
  }
  std::vector<double> sorted = list.diameters;
  std::sort(sorted.begin(), sorted.end());
  return [sorted](double q) { return sorted[std::size_t(q * double(sorted.size()))]; };
}

/// Prepared once, then asked for samples of any size, ascending.
class Sampler {
 public:
  explicit Sampler(const SizeDistribution& distribution)
      : lognormal_(std::get_if<TruncatedLognormal>(&distribution)),
        quantile_(std::visit([](const auto& d) { return quantile_function(d); }, distribution)) {}

  std::vector<double> sample(std::size_t count) const {
    std::vector<double> d(count);
    for (std::size_t k = 0; k < count; ++k) d[k] = quantile_((double(k) + 0.5) / double(count));
    if (lognormal_ && count >= 100) {  // fewer cannot have both the limits and the moments
      d.front() = lognormal_->minimum;
      d.back() = lognormal_->maximum;
      correct_moments(d, *lognormal_);
    }
    return d;
  }

 private:
  const TruncatedLognormal* lognormal_;
  Quantile quantile_;
};

}  // namespace

std::vector<double> draw(const SizeDistribution& distribution, std::size_t count, std::uint64_t seed) {
  if (count == 0) refuse("the powder is empty: the number of particles is zero");
  std::vector<double> d = Sampler(distribution).sample(count);
  Random(seed).shuffle(d);
  return d;
}

std::size_t count_for_volume(const SizeDistribution& distribution, double volume) {
  if (!(volume > 0)) refuse("the solid volume of the powder must be above zero; it is ", volume, " m^3");
  const Sampler sampler(distribution);
  const auto volume_of = [&](std::size_t n) { return solid_volume(sampler.sample(n)); };
  const double guess = 1000 * volume / volume_of(1000);
  if (!(guess < 1e9)) refuse("the powder would have more than 1e9 particles; reduce its solid volume");
  std::size_t low = 0, high = std::size_t(guess) + 1;
  double volume_low = 0, volume_high = volume_of(high);
  for (; volume_high < volume; volume_high = volume_of(high)) {
    low = high;
    volume_low = volume_high;
    high += 1 + high / 16;
  }
  // The volume is nearly proportional to the number: interpolate, and halve every other time in case it is not.
  for (bool halve = false; high - low > 1; halve = !halve) {
    const double part = halve ? 0.5 : (volume - volume_low) / (volume_high - volume_low);
    const std::size_t n = std::clamp(low + std::size_t(part * double(high - low)), low + 1, high - 1);
    const double v = volume_of(n);
    (v < volume ? low : high) = n;
    (v < volume ? volume_low : volume_high) = v;
  }
  return low > 0 && volume - volume_low < volume_high - volume ? low : high;
}

double solid_volume(std::span<const double> diameters) {
  double sum = 0;
  for (double d : diameters) sum += d * d * d;
  return sum * std::numbers::pi / 6;
}

SizeStatistics size_statistics(std::span<const double> diameters, std::span<const double> edges) {
  SizeStatistics s{};
  s.count = diameters.size();
  s.edges.assign(edges.begin(), edges.end());
  const std::size_t bins = edges.size() > 1 ? edges.size() - 1 : 0;
  s.number_fraction.assign(bins, 0);
  s.volume_fraction.assign(bins, 0);
  if (diameters.empty()) return s;
  const Moments m = moments(diameters);
  s.mean = m.mean;
  s.standard_deviation = m.standard_deviation;
  const auto [low, high] = std::minmax_element(diameters.begin(), diameters.end());
  s.minimum = *low;
  s.maximum = *high;
  s.solid_volume = solid_volume(diameters);
  for (double d : diameters) {
    if (bins == 0 || d < edges.front() || d > edges.back()) continue;
    const auto above = std::size_t(std::upper_bound(edges.begin(), edges.end(), d) - edges.begin());
    const std::size_t bin = std::min(above - 1, bins - 1);
    s.number_fraction[bin] += 1 / double(s.count);
    s.volume_fraction[bin] += std::numbers::pi / 6 * d * d * d / s.solid_volume;
  }
  return s;
}

}  // namespace densify::dem
