#pragma once
// A property that depends on one variable, by linear interpolation in a table.

#include <vector>

namespace densify {

/// y(x) through sorted knots, linear between them, constant beyond the ends.
class PiecewiseLinear {
 public:
  struct Knot {
    double x = 0.0;  ///< where
    double y = 0.0;  ///< value there

    friend bool operator==(const Knot&, const Knot&) = default;
  };

  /// A property that nobody has set: NaN everywhere.
  PiecewiseLinear();

  /// The same value everywhere.
  explicit PiecewiseLinear(double constant);

  /// At least one knot, finite, x strictly increasing; throws InputError otherwise.
  explicit PiecewiseLinear(std::vector<Knot> knots);

  /// The value at `x`; at a knot the knot's value bit for bit.
  double operator()(double x) const;

  /// dy/dx to the right of `x`: at a knot the slope of the next piece, zero from the last knot on.
  double slope(double x) const;

  const std::vector<Knot>& knots() const { return knots_; }

  /// Whether there is only one value, whatever the variable.
  bool is_constant() const { return knots_.size() == 1; }

 private:
  std::vector<Knot> knots_;
};

}  // namespace densify
