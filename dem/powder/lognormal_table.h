#pragma once
// The truncated lognormal as numbers: its parameters from its moments, and its quantiles.

#include <vector>

#include "dem/powder/size_distribution.h"

namespace densify::dem {

/// Density exp(lambda u - kappa u^2 / 2) over u = ln(d / minimum) / ln(maximum / minimum), tabulated where it is not
/// negligible; this form has no cancellation far out in the tails, where a difference of normal integrals loses all.
class LognormalTable {
 public:
  /// Solves for lambda and kappa.  @throws InputError  as solve_lognormal
  explicit LognormalTable(const TruncatedLognormal& requested);

  LognormalParameters parameters() const;

  /// Diameter below which the part q (0..1) of the particles lies [m].
  double quantile(double q) const;

 private:
  struct Moments {
    double mean, standard_deviation;
  };
  void tabulate(double lambda, double kappa);
  Moments moments() const;
  Moments moments_at_mean(double kappa);
  double diameter(double u) const;

  TruncatedLognormal requested_;
  double width_;  // ln(maximum / minimum)
  double lambda_ = 0, kappa_ = 0;
  double u_first_ = 0, u_step_ = 0;
  std::vector<double> density_, cumulative_;
};

}  // namespace densify::dem
