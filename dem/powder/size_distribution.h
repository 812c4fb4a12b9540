#pragma once
// The sizes of a powder: what is asked for, the diameters drawn, and what was achieved.

#include <cstdint>
#include <span>
#include <variant>
#include <vector>

namespace densify::dem {

/// Lognormal cut off at both ends, by the moments of the diameters that remain after the cut.
struct TruncatedLognormal {
  double mean;                ///< [m]
  double standard_deviation;  ///< [m]
  double minimum, maximum;    ///< [m]
};

enum class HistogramWeight { number, volume };

/// Bins of diameter; within a bin the number density is constant.
struct SizeHistogram {
  std::vector<double> edges;    ///< ascending, one more than weights [m]
  std::vector<double> weights;  ///< any positive scale [-]
  HistogramWeight weighted_by;
};

/// Explicit diameters; drawn in the proportions of the list.
struct SizeList {
  std::vector<double> diameters;  ///< [m]
};

using SizeDistribution = std::variant<TruncatedLognormal, SizeHistogram, SizeList>;

/// Parameters of ln(d / m) before the cut.
struct LognormalParameters {
  double mu;     ///< [-]
  double sigma;  ///< [-]
};

/// The lognormal that has the requested moments after the cut.
/// @throws InputError  when minimum, mean, maximum do not ascend or no lognormal is as wide as requested
LognormalParameters solve_lognormal(const TruncatedLognormal& requested);

/// `count` diameters at the quantiles (k + 1/2) / count, in an order shuffled by `seed` [m].
///
/// Of 100 and more lognormal diameters the smallest and largest are the limits of the distribution, and the others are
/// moved slightly so that mean and standard deviation are those requested.
/// @throws InputError  when the distribution is empty or contradicts itself, or count is zero
std::vector<double> draw(const SizeDistribution& distribution, std::size_t count, std::uint64_t seed);

/// The number of particles whose solid volume comes nearest to `solid_volume` [m^3], at least one.
std::size_t count_for_volume(const SizeDistribution& distribution, double solid_volume);

/// What a set of diameters is like.
struct SizeStatistics {
  std::size_t count;
  double mean, standard_deviation;      ///< of the diameters, deviation with 1/count [m]
  double minimum, maximum;              ///< [m]
  double solid_volume;                  ///< sum of pi d^3 / 6 [m^3]
  std::vector<double> edges;            ///< of the bins [m]
  std::vector<double> number_fraction;  ///< part of the number in each bin, lower edge included (of the last both) [-]
  std::vector<double> volume_fraction;  ///< part of the solid volume in each bin [-]
};

SizeStatistics size_statistics(std::span<const double> diameters, std::span<const double> edges);

/// Sum of pi d^3 / 6 [m^3].
double solid_volume(std::span<const double> diameters);

}  // namespace densify::dem
