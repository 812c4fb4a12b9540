#include "coupling/shape_preserving.h"

#include <math.h>  // the isnan of the global namespace, which Boost 1.74's pchip needs before it

#include <boost/math/interpolators/pchip.hpp>

#include "base/check.h"

namespace densify::coupling {

ShapePreserving::ShapePreserving(std::vector<double> x, Eigen::MatrixXd values)
    : x_(std::move(x)), values_(std::move(values)), slopes_(Eigen::MatrixXd::Zero(values_.rows(), values_.cols())) {
  const std::size_t n = x_.size();
  if (n < 2 || std::size_t(values_.cols()) != n || !values_.allFinite())
    throw InputError("a curve needs at least two nodes, and finite values at all of them");
  for (std::size_t k = 1; k < n; ++k)
    if (!(x_[k] > x_[k - 1])) throw InputError("the nodes of a curve do not increase");
  for (Eigen::Index q = 0; q < values_.rows(); ++q) {
    std::vector<double> y(n);
    for (std::size_t k = 0; k < n; ++k) y[k] = values_(q, Eigen::Index(k));
    if (n < 4) {  // too few for the library: chords
      for (std::size_t k = 0; k < n; ++k) {
        const std::size_t a = std::min(k, n - 2);
        slopes_(q, Eigen::Index(k)) = (y[a + 1] - y[a]) / (x_[a + 1] - x_[a]);
      }
      continue;
    }
    const boost::math::interpolators::pchip<std::vector<double>> curve(std::vector<double>(x_), std::move(y));
    for (std::size_t k = 0; k < n; ++k) slopes_(q, Eigen::Index(k)) = curve.prime(x_[k]);
  }
}

}  // namespace densify::coupling
