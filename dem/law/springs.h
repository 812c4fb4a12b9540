#pragma once
// Normal springs: force and tangent stiffness of an elastic displacement, negative in compression.

#include <cmath>

namespace densify::dem {

/// Linear spring (4.15), the same for every contact of a bucket.
struct LinearSpring {
  double stiffness;  ///< k_n [N/m]

  /// Force [N], tension positive.
  double force(double u, double /*radius*/) const { return stiffness * u; }
  double tangent(double /*u*/, double /*radius*/) const { return stiffness; }
  double energy(double u, double /*radius*/) const { return 0.5 * stiffness * u * u; }
  /// The displacement that carries a force: inverse of `force`.
  double displacement(double f, double /*radius*/) const { return f / stiffness; }
  /// Stiffness that bounds a contact about to form [N/m].
  double reference_stiffness(double /*radius*/) const { return stiffness; }
};

/// Hertz's spring (4.18, 4.19) in compression; in tension, where Hertz is undefined, linear with the tangent of a small
/// overlap `tension_floor` x radius (4.46 read as physics: (3/2) k sqrt|u| with a floor).
struct HertzSpring {
  double four_thirds_modulus;  ///< (4/3) E* [Pa]
  double tension_floor;        ///< overlap over radius at which the tensile stiffness is taken

  double force(double u, double radius) const {
    return u < 0 ? four_thirds_modulus * u * std::sqrt(-u * radius) : tensile_stiffness(radius) * u;
  }
  double tangent(double u, double radius) const {
    return u < 0 ? 1.5 * four_thirds_modulus * std::sqrt(-u * radius) : tensile_stiffness(radius);
  }
  double energy(double u, double radius) const {
    return u < 0 ? 0.4 * four_thirds_modulus * u * u * std::sqrt(-u * radius) : 0.5 * tensile_stiffness(radius) * u * u;
  }
  double displacement(double f, double radius) const {
    return f < 0 ? -std::pow(-f / (four_thirds_modulus * std::sqrt(radius)), 2.0 / 3) : f / tensile_stiffness(radius);
  }
  double reference_stiffness(double radius) const {
    constexpr double overlap_of_a_light_contact = 0.01;  // of the radius
    return 1.5 * four_thirds_modulus * radius * std::sqrt(overlap_of_a_light_contact);
  }

 private:
  double tensile_stiffness(double radius) const {
    return 1.5 * four_thirds_modulus * radius * std::sqrt(tension_floor);
  }
};

}  // namespace densify::dem
