#pragma once
// From the histories of a ladder to errors, Pareto front and order of convergence.

#include <cmath>
#include <optional>

#include "app/trade_ladder.h"
#include "dem/ensemble_history.h"

namespace densify::app {

/// One finished run of a rung.
struct TradeRun {
  dem::History history;
  double wall = 0;  ///< without the packing [s]
  double cpu = 0;   ///< [s]
  double steps = 0;
  double bytes = 0;
  std::string failure;  ///< why it ended early; empty: it did not
};

/// Mean over realisations with its standard error.
struct Estimate {
  double mean = dem::unset;
  double standard_error = dem::unset;
};

/// Mean and standard error sqrt(sum (x - mean)^2 / (n (n - 1))) of a sample; the error of one value is nan.
Estimate estimate(const std::vector<double>& sample);

/// What a rung costs and how far it is from the converged one.
struct TradeRow {
  std::size_t rung = 0;
  std::size_t realisations = 0;
  double wall = 0, cpu = 0, steps = 0, bytes = 0;  ///< of one realisation, mean
  std::vector<Estimate> density;                   ///< at the points
  std::vector<Estimate> density_error;             ///< against the converged rung, realisation by realisation
  std::size_t worst = 0;                           ///< point of the largest error
  double spread = 0;                               ///< standard deviation of one realisation at the worst point
  Estimate stress_error;                           ///< of the final stress in the direction of pressing [Pa]
  Estimate peak_stress_error;                      ///< of that stress at the last full pressure, relative
  Estimate coordination_error;                     ///< of the final coordination number
  double estimated_error = dem::unset;  ///< the runs' own estimate of their numerical error, largest of points
  std::string failure;                  ///< not empty: no errors

  double error() const { return std::abs(density_error[worst].mean); }
  double standard_error() const { return density_error[worst].standard_error; }
};

/// Rows of all rungs.  runs[r][k] is realisation k of rung r; `times` are the points.  Differences are taken between
/// runs of the same number, so that what both have in common drops out; the last pressed point is `pressed`.
std::vector<TradeRow> trade_rows(const Ladder&, const std::vector<std::vector<TradeRun>>& runs,
                                 const std::vector<double>& times, double pressed);

/// Indices of the rows that no other beats in both processor time and error, the fastest first.
std::vector<std::size_t> pareto_front(const std::vector<TradeRow>&);

/// The fastest row whose error and two standard errors together stay below `target`; nothing when none does.
std::optional<std::size_t> cheapest_for(const std::vector<TradeRow>&, double target);

/// Root mean square error of the mean of n realisations: sqrt(error^2 + spread^2 / n).
double error_of_mean(const TradeRow&, int n);

/// What the three smallest sizes of a family say of its order.
struct Order {
  std::string family;
  std::string point;
  bool seen = false;  ///< differences above twice their standard error, of one sign and falling, order at least 0.4
  double order = dem::unset;     ///< p of error ~ size^p
  double limit = dem::unset;     ///< Richardson's value at size 0
  double smallest = dem::unset;  ///< value of the smallest size
};

/// The order of each family with three sizes of one ratio, at each point.
std::vector<Order> orders(const Ladder&, const std::vector<TradeRow>&, const std::vector<std::string>& points);

/// trade.csv: one row a rung.
std::string trade_csv(const Ladder&, const std::vector<TradeRow>&, const std::vector<std::string>& points);

}  // namespace densify::app
