#pragma once
// Kinematics of a step at a point: strain that a rotation leaves alone, and the force that its stress exerts.

#include "base/tensor.h"

namespace densify::fem {

using Vec10 = Eigen::Matrix<double, 10, 1>;
using Vec9 = Eigen::Matrix<double, 9, 1>;
using Mat9 = Eigen::Matrix<double, 9, 9>;
using Mat10 = Eigen::Matrix<double, 10, 10>;

/// A point's motion over a step.  Axes: x y z, or r theta z.  The volume ratio is that of the element's few modes, not
/// det F, which would lock an element of a nearly incompressible material.
struct PointMotion {
  Mat3 before, after;        ///< deformation gradient from the unloaded body
  double volume_before = 1;  ///< volume over that of the unloaded body
  double volume_after = 1;
  Mat3 turned = Mat3::Identity();  ///< rotation from the frame of the material at the start of the step
};

/// Strain of the step in the frame of the material, engineering shears: the deviator of the gradient of the increment
/// with respect to the middle of the step (Hughes and Winget, 1980), and ln(volume_after/volume_before).
Vec6 step_strain(const PointMotion&);

/// The rotation from the frame of the material at the end of the step.
Mat3 turned_after(const PointMotion&);

/// det F F^-T, the derivative of det F by F, column by column.
Vec9 cofactor_column(const Mat3& f);

/// Its derivative by F, column by column.
Mat9 cofactor_slope(const Mat3& f);

/// The work of a stress on a virtual motion, per unit volume of the unloaded body: T : dF + p d(volume ratio).
struct PointForce {
  Vec10 value;       ///< T = det F dev(sigma) F^-T column by column; p, the mean stress [Pa]
  Mat10 derivative;  ///< by the deformation gradient column by column and the volume ratio, at the end of the step
};

/// `stress` and `tangent` as the material answers to step_strain() [Pa].
PointForce point_force(const PointMotion&, const Vec6& stress, const Mat6& tangent);

}  // namespace densify::fem
