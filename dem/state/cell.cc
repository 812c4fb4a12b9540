#include "dem/state/cell.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>

namespace densify::dem {

Vec3 Cell::wrap(const Vec3& x) const {
  Vec3 s = to_fraction(x);
  for (int k = 0; k < 3; ++k) s[k] = std::floor(s[k]);
  return x - h * s;
}

Eigen::Matrix3i Cell::reduce() {
  // Beyond a half the other side is nearer; what comes back from there must not be turned over again at once.
  constexpr double leaning = 0.6;
  Eigen::Matrix3i change = Eigen::Matrix3i::Identity();
  bool again = true;
  for (int sweep = 0; again && sweep < 100; ++sweep) {
    again = false;
    for (int k = 0; k < 3; ++k)
      for (int l = 0; l < 3; ++l) {
        if (k == l || h.col(l).norm() > h.col(k).norm()) continue;  // along the shorter of the two
        const double lean = h.col(k).dot(h.col(l)) / h.col(l).squaredNorm();
        if (!(std::abs(lean) > leaning)) continue;
        const int turns = int(std::round(lean));
        h.col(k) -= turns * h.col(l);  // h_k n_k + h_l n_l = h'_k n_k + h_l (n_l + turns n_k)
        change.row(l) += turns * change.row(k);
        again = true;
      }
  }
  return change;
}

Vec3 Cell::widths() const {
  Vec3 w;
  for (int k = 0; k < 3; ++k) w[k] = volume() / h.col((k + 1) % 3).cross(h.col((k + 2) % 3)).norm();
  return w;
}

}  // namespace densify::dem
