#pragma once
// The particles of one RVE: plain data, one owner (Simulation).

#include <cstdint>
#include <vector>

#include "base/tensor.h"

namespace densify::dem {

/// What the contact pass reads of a particle, in one cache line.
struct alignas(64) Body {
  Vec3 position;        ///< [m]; in a periodic cell not wrapped between rebuilds of the neighbour list
  double radius;        ///< r(T) (4.17) [m]
  Vec3 velocity;        ///< v^{n-1/2} [m/s]; in a deforming periodic cell relative to the affine flow
  double inverse_mass;  ///< 1 / (mass scaling x real mass) [1/kg]
};
static_assert(sizeof(Body) == 64);

/// Structure of the particle state; index = place in memory, `id` = the number the user knows.
struct Particles {
  std::vector<Body> body;
  std::vector<double> reference_radius;  ///< r at the reference temperature [m]
  std::vector<std::uint8_t> material;    ///< index into the scene's materials
  std::vector<std::uint32_t> id;         ///< place in the list as created or imported, unchanged by sorting
  std::vector<Vec3> force;               ///< resultant [N]

  // Only with friction:
  std::vector<Vec3> angular_velocity;  ///< w^{n-1/2} [rad/s]
  std::vector<Vec3> torque;            ///< resultant about the centre [N m]

  std::size_t size() const { return body.size(); }
};

}  // namespace densify::dem
