#pragma once
// What the next step has to resist at each particle: the matrix sum of its contacts' stiffness.

#include <algorithm>
#include <cmath>

#include "dem/state/particles.h"

namespace densify::dem {

/// Symmetric sum over the contacts of one particle, `along` n n^T + `across` (1 - n n^T) each.
struct SymmetricSum {
  double xx = 0, yy = 0, zz = 0, xy = 0, xz = 0, yz = 0;

  void add(double along, double across, const Vec3& n) {
    const Vec3 m = (along - across) * n;
    xx += across + m[0] * n[0];
    yy += across + m[1] * n[1];
    zz += across + m[2] * n[2];
    xy += m[0] * n[1];
    xz += m[0] * n[2];
    yz += m[1] * n[2];
  }

  void add(const SymmetricSum& o, double factor) {
    xx += factor * o.xx, yy += factor * o.yy, zz += factor * o.zz;
    xy += factor * o.xy, xz += factor * o.xz, yz += factor * o.yz;
  }
  void operator+=(const SymmetricSum& o) { xx += o.xx, yy += o.yy, zz += o.zz, xy += o.xy, xz += o.xz, yz += o.yz; }

  /// Upper bound of the largest eigenvalue from trace and Frobenius norm, mean + sqrt(2) x standard deviation of the
  /// eigenvalues (Wolkowicz and Styan, Linear Algebra Appl. 29 (1980) 471, n = 3); independent of the axes, exact for
  /// one contact and for an isotropic sum.
  double largest_eigenvalue() const {
    const double mean = (xx + yy + zz) * (1.0 / 3), x = xx - mean, y = yy - mean, z = zz - mean;
    return mean + std::sqrt(2.0 / 3 * (x * x + y * y + z * z + 2 * (xy * xy + xz * xz + yz * yz)));
  }
};

/// Sum of stiffness [N/m].
struct alignas(64) StiffnessSum : SymmetricSum {
  double force = 0;  ///< sum of the normal forces' magnitudes [N]
};

/// Sums of stiffness [N/m] and damping [N s/m].
struct NodeSums {
  SymmetricSum stiffness, damping;

  void operator+=(const NodeSums& o) {
    stiffness += o.stiffness;
    damping += o.damping;
  }
};

/// What the sums of its two particles need of one pair.
struct StiffnessShare {
  Vec3 normal;
  double along, across;  ///< [N/m]
  double force;          ///< [N]
};

/// Asked of a pass: the sums of k_step over the contacts of each particle, where a contact's k_step is that constant
/// stiffness at which a step of `next_step` is as near to instability as with its spring, damper and dashpot,
/// (k + 2 c/dt)/(1 + (theta - 1/2) k dt/eta).
struct StepStiffness {
  double next_step = 0;          ///< dt of the step that follows the pass [s]
  std::vector<StiffnessSum> of;  ///< of each particle, in a fixed order of summation
};

}  // namespace densify::dem
