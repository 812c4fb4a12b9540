#pragma once
// Normal springs: force and tangent stiffness of an elastic displacement, negative in compression.

#include "dem/law/scalar.h"

namespace densify::dem {

/// Linear spring (4.15), the same for every contact of a bucket.
struct LinearSpring {
  double stiffness;  ///< k_n [N/m]

  /// Force [N], tension positive.
  template <class T>
  T force(const T& u, const T& /*radius*/) const {
    return stiffness * u;
  }
  template <class T>
  T tangent(const T& /*u*/, const T& /*radius*/) const {
    return stiffness;
  }
  template <class T>
  T energy(const T& u, const T& /*radius*/) const {
    return 0.5 * stiffness * u * u;
  }
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

  template <class T>
  T force(const T& u, const T& radius) const {
    return select(u < 0, four_thirds_modulus * u * root(-u * radius), tensile_stiffness(radius) * u);
  }
  template <class T>
  T tangent(const T& u, const T& radius) const {
    return select(u < 0, 1.5 * four_thirds_modulus * root(-u * radius), tensile_stiffness(radius));
  }
  template <class T>
  T energy(const T& u, const T& radius) const {
    return select(u < 0, 0.4 * four_thirds_modulus * u * u * root(-u * radius),
                  0.5 * tensile_stiffness(radius) * u * u);
  }
  double displacement(double f, double radius) const {
    return f < 0 ? -std::pow(-f / (four_thirds_modulus * std::sqrt(radius)), 2.0 / 3) : f / tensile_stiffness(radius);
  }
  double reference_stiffness(double radius) const {
    constexpr double overlap_of_a_light_contact = 0.01;  // of the radius
    return 1.5 * four_thirds_modulus * radius * std::sqrt(overlap_of_a_light_contact);
  }

 private:
  template <class T>
  T tensile_stiffness(const T& radius) const {
    return 1.5 * four_thirds_modulus * std::sqrt(tension_floor) * radius;
  }
};

}  // namespace densify::dem
