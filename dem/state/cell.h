#pragma once
// The periodic cell: any parallelepiped, deformed by a velocity gradient.

#include <Eigen/LU>
#include <cmath>

#include "dem/state/particles.h"

namespace densify::dem {

/// A lattice translation as three small integers packed into one code 0..26 (each of -1, 0, 1).
struct ImageCode {
  static constexpr std::uint8_t none = 13;
  static constexpr std::uint8_t of(int a, int b, int c) { return std::uint8_t((a + 1) * 9 + (b + 1) * 3 + (c + 1)); }
  static Eigen::Vector3i unpack(std::uint8_t code) { return {code / 9 - 1, (code / 3) % 3 - 1, code % 3 - 1}; }
};

/// Periodic cell with edge vectors in the columns of `h` [m]; not periodic when `periodic` is false.
struct Cell {
  bool periodic = false;
  Mat3 h = Mat3::Zero();                  ///< edge vectors in columns [m]
  Vec3 origin = Vec3::Zero();             ///< lower corner [m]
  Mat3 velocity_gradient = Mat3::Zero();  ///< L, dh/dt = L h [1/s]

  double volume() const { return std::abs(h.determinant()); }  ///< [m^3]

  /// Fractional coordinates of a point, 0..1 inside the cell.
  Vec3 to_fraction(const Vec3& x) const { return h.inverse() * (x - origin); }
  Vec3 from_fraction(const Vec3& s) const { return origin + h * s; }

  /// The image of `x` that lies in the cell.
  Vec3 wrap(const Vec3& x) const;
  /// Translation h n of an image code [m].
  Vec3 shift(std::uint8_t code) const { return h * ImageCode::unpack(code).cast<double>(); }
  /// Replaces edges that lean far over by shorter ones of the same lattice, so that a sheared cell stays compact.
  /// Returns the whole numbers n' = M n of a translation with the new edges for n with the old; the unit matrix where
  /// nothing leans.
  Eigen::Matrix3i reduce();
  /// Distance between opposite faces along each of the three directions [m].
  Vec3 widths() const;
};

}  // namespace densify::dem
