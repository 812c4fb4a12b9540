#pragma once
// Vectors and tensors of three dimensions, and Voigt's notation of symmetric ones.

#include <Eigen/Core>

namespace densify {

using Vec3 = Eigen::Vector3d;
using Mat3 = Eigen::Matrix3d;
using Vec6 = Eigen::Matrix<double, 6, 1>;
using Mat6 = Eigen::Matrix<double, 6, 6>;  ///< rows and columns xx yy zz yz xz xy, shear rates as engineering shears

}  // namespace densify
