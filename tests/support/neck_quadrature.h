#pragma once
// Inertia-free sintering of two spheres as one integral over the neck radius: a reference that shares no code with the
// laws.

#include <cmath>
#include <functional>

namespace densify::test {

/// Simpson's rule over [0, 1] with n (even) intervals.
inline double simpson(const std::function<double(double)>& f, int n) {
  double sum = f(0) + f(1);
  for (int k = 1; k < n; ++k) sum += (k % 2 ? 4 : 2) * f(double(k) / n);
  return sum / (3 * n);
}

/// Two spheres that sinter without inertia and elasticity.
struct NeckQuadrature {
  double radius;       ///< of the sintering law [m]
  double diffusivity;  ///< D_eff [m^5/(N s)]
  double gamma;        ///< [J/m^2]
  double dihedral;     ///< Psi [rad]
  double force;        ///< external compression [N]

  double driving(double a) const {
    return M_PI * gamma * (4 * radius * (1 - std::cos(0.5 * dihedral)) + a * std::sin(0.5 * dihedral)) + force;
  }

  /// Time [s] in which `neck(u)` runs from approach 0 to u [m]: dt = eta(a) du / driving(a), eta = pi a^4/(8 D).  The
  /// integrand goes as u^2 for a ~ sqrt(u), so that Simpson's rule with 2000 intervals is good to 1e-10.
  double time(double approach, const std::function<double(double)>& neck) const {
    return approach * simpson(
                          [&](double s) {
                            const double a = neck(s * approach);
                            return M_PI * std::pow(a, 4) / (8 * diffusivity) / driving(a);
                          },
                          2000);
  }

  /// Approach [m] after a time, by bisection below `largest`.
  double approach(double t, double largest, const std::function<double(double)>& neck) const {
    double low = 0, high = largest;
    for (int k = 0; k < 100; ++k) {
      const double mid = 0.5 * (low + high);
      (time(mid, neck) < t ? low : high) = mid;
    }
    return 0.5 * (low + high);
  }

  /// a = sqrt(2 r u), the integral of (4.31) from nothing.
  std::function<double(double)> integrated() const {
    return [r = radius](double u) { return std::sqrt(2 * r * u); };
  }

  /// a = 1.43 sqrt(r^2 - (r - u/2)^2).
  std::function<double(double)> of_overlap() const {
    return [r = radius](double u) { return 1.43 * std::sqrt(r * u - 0.25 * u * u); };
  }
};

}  // namespace densify::test
