#pragma once
// Several quantities over one variable, by cubics that pass no value between two nodes.

#include <Eigen/Core>
#include <algorithm>
#include <vector>

namespace densify::coupling {

/// Piecewise cubic Hermite interpolation with the slopes of Fritsch and Butland (SIAM J. Sci. Stat. Comput. 5, 1984):
/// no maximum or minimum that the nodes do not have.  Constant beyond the ends.
class ShapePreserving {
 public:
  ShapePreserving() = default;
  /// `x` strictly increasing; a row of `values` a quantity, a column a node.
  ShapePreserving(std::vector<double> x, Eigen::MatrixXd values);

  Eigen::VectorXd operator()(double x) const { return at<Eigen::Dynamic>(x, values_.rows()); }
  /// The first N quantities, without memory of their own.
  template <int N>
  Eigen::Matrix<double, N, 1> at(double x, Eigen::Index rows = N) const {
    const auto part = [&](const Eigen::MatrixXd& m, Eigen::Index k) { return m.col(k).template head<N>(rows); };
    if (x <= x_.front()) return part(values_, 0);
    if (x >= x_.back()) return part(values_, values_.cols() - 1);
    const auto k = Eigen::Index(std::upper_bound(x_.begin(), x_.end(), x) - x_.begin()) - 1;
    const double h = x_[std::size_t(k + 1)] - x_[std::size_t(k)], t = (x - x_[std::size_t(k)]) / h, u = 1 - t;
    return u * u * (1 + 2 * t) * part(values_, k) + t * t * (3 - 2 * t) * part(values_, k + 1) +
           h * (t * u * u * part(slopes_, k) - t * t * u * part(slopes_, k + 1));
  }
  double lowest() const { return x_.front(); }
  double highest() const { return x_.back(); }
  const std::vector<double>& x() const { return x_; }
  const Eigen::MatrixXd& values() const { return values_; }

 private:
  std::vector<double> x_;
  Eigen::MatrixXd values_, slopes_;
};

}  // namespace densify::coupling
