#include "base/piecewise_linear.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "base/check.h"

namespace densify {
namespace {

// The first knot to the right of x.
auto right_of(const std::vector<PiecewiseLinear::Knot>& knots, double x) {
  return std::upper_bound(knots.begin(), knots.end(), x,
                          [](double value, const PiecewiseLinear::Knot& knot) { return value < knot.x; });
}

}  // namespace

PiecewiseLinear::PiecewiseLinear() : knots_{{0.0, std::numeric_limits<double>::quiet_NaN()}} {}

PiecewiseLinear::PiecewiseLinear(double constant) : knots_{{0.0, constant}} {}

PiecewiseLinear::PiecewiseLinear(std::vector<Knot> knots) : knots_(std::move(knots)) {
  if (knots_.empty()) throw InputError("the table is empty; give at least one pair");
  for (std::size_t i = 0; i < knots_.size(); ++i) {
    if (!std::isfinite(knots_[i].x) || !std::isfinite(knots_[i].y)) {
      throw InputError("pair " + std::to_string(i + 1) + " of the table is not finite");
    }
    if (i > 0 && knots_[i].x <= knots_[i - 1].x) {
      throw InputError("the first column must increase, and pair " + std::to_string(i + 1) +
                       " does not; sort the table");
    }
  }
}

double PiecewiseLinear::operator()(double x) const {
  const auto right = right_of(knots_, x);
  if (right == knots_.begin()) return knots_.front().y;
  const Knot& a = *std::prev(right);
  if (right == knots_.end()) return a.y;
  return a.y + (right->y - a.y) * ((x - a.x) / (right->x - a.x));
}

double PiecewiseLinear::slope(double x) const {
  const auto right = right_of(knots_, x);
  if (right == knots_.begin() || right == knots_.end()) return 0.0;
  const Knot& a = *std::prev(right);
  return (right->y - a.y) / (right->x - a.x);
}

}  // namespace densify
