#include "fem/press/wall_contact.h"

#include <cmath>
#include <unsupported/Eigen/AutoDiff>

namespace densify::fem {

WallTraction wall_traction(const DieWall& die, bool closed, const Vec3& before, const Vec3& after,
                           const Vec3& friction_before) {
  using Active = Eigen::AutoDiffScalar<Vec3>;
  using ActiveVec = Eigen::Matrix<Active, 3, 1>;
  WallTraction t{Vec3::Zero(), Mat3::Zero(), Vec3::Zero(), 0, std::hypot(after[0], after[1]) - die.radius};
  if (!closed) return t;
  const Vec3 outward = Vec3(after[0], after[1], 0).normalized(), way = after - before - Vec3(0, 0, die.rise);
  t.slip = (way - way.dot(outward) * outward).norm();

  ActiveVec x;
  for (int k = 0; k < 3; ++k) x[k] = Active(after[k], Vec3(Vec3::Unit(k)));
  using std::sqrt;
  const Active r = sqrt(Active(x[0] * x[0] + x[1] * x[1]));
  const ActiveVec n{Active(x[0] / r), Active(x[1] / r), Active(0.0)};
  const Active pressure = die.stiffness * (r - die.radius);
  ActiveVec shear;
  for (int k = 0; k < 3; ++k) shear[k] = friction_before[k] - die.shear * (x[k] - before[k]);
  shear[2] = shear[2] + die.shear * die.rise;
  const Active along = shear[0] * n[0] + shear[1] * n[1];
  for (int k = 0; k < 2; ++k) shear[k] = shear[k] - along * n[k];
  const Active size = sqrt(Active(shear[0] * shear[0] + shear[1] * shear[1] + shear[2] * shear[2] + 1e-300));
  if (pressure <= 0.0 || size > die.friction * pressure) {
    const Active share = pressure <= 0.0 ? Active(0.0) : Active(die.friction * pressure / size);
    for (int k = 0; k < 3; ++k) shear[k] = shear[k] * share;
  }
  for (int k = 0; k < 3; ++k) {
    const Active total = shear[k] - pressure * n[k];
    t.value[k] = total.value();
    t.derivative.row(k) = total.derivatives().transpose();
    t.friction[k] = shear[k].value();
  }
  return t;
}

}  // namespace densify::fem
