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

Vec3 Cell::widths() const {
  Vec3 w;
  for (int k = 0; k < 3; ++k) w[k] = volume() / h.col((k + 1) % 3).cross(h.col((k + 2) % 3)).norm();
  return w;
}

}  // namespace densify::dem
