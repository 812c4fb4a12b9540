#pragma once
// What of a stiffness or viscosity tensor is isotropic, and how far the rest is.

#include "base/tensor.h"

namespace densify {

/// Of a stiffness: moduli [Pa]; of a viscosity: bulk and shear viscosity [Pa s].
struct IsotropicPart {
  double bulk, shear, youngs, poisson;
  double distance;   ///< |C - C_iso| / |C| in the Frobenius norm of the tensor: 0 isotropic, below 1
  double universal;  ///< 5 G_V/G_R + K_V/K_R - 6 of Ranganathan and Ostoja-Starzewski (2008); infinite if C is singular
};

/// The isotropic tensor nearest to C: K = C_iijj/9, G = (3 C_ijij - C_iijj)/30.
IsotropicPart isotropic_part(const Mat6&);

/// C in Mandel's basis, shear rows and columns times sqrt(2) each: norms and eigenvalues are those of the tensor.
Mat6 mandel(const Mat6&);

/// C of a body turned by the rotation q.
Mat6 rotated(const Mat6&, const Mat3& q);

/// The rate at which stress + C rate vanishes [unit of stress over that of C]; directions that C does not resist get
/// none.  Shear rates as engineering shears.
Vec6 free_rate(const Mat6& c, const Vec6& stress);

}  // namespace densify
