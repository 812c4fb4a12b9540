#pragma once
// Moduli of packings by several routes beside curves, bounds, measurements and each other: tables and deviations.

#include <limits>
#include <string>
#include <vector>

#include "app/result_table.h"
#include "base/bounds.h"
#include "base/specimen_tests.h"

namespace densify::app {

/// What one route says of a body at one density; NaN where it says nothing.
struct ModuliPoint {
  static constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
  double relative_density = unknown;
  double youngs = unknown, poisson = unknown;              ///< E [Pa], nu
  double youngs_error = unknown, poisson_error = unknown;  ///< of the numerical method, estimated
  double strength = unknown;                               ///< measured [Pa]
  double time = unknown;                                   ///< of the process [s]
  double voxels_across_neck = unknown;                     ///< at the coarsest resolution
};

/// A route along the densification of one result, in ascending order of density.
struct Route {
  std::string result, name;
  std::vector<ModuliPoint> points;
};

/// What the curves of a comparison start from.
struct DenseBody {
  std::vector<Phase> phases;                            ///< without pores
  double strength = ModuliPoint::unknown;               ///< sigma_0 of (3.9) [Pa]
  double strength_exponent = thesis_strength_exponent;  ///< q of (3.9)
  IsotropicModuli solid() const { return dense_solid(phases); }
};

/// Curves and bounds of a porous body at one density.
struct Curves {
  double solid_spheres, spherical_pores;                  ///< E by (3.7) [Pa]
  double solid_spheres_poisson, spherical_pores_poisson;  ///< nu by (3.8)
  double hashin_shtrikman;                                ///< upper bound of E, the lower being zero [Pa]
  double voigt;                                           ///< the same of Voigt
  double strength_ratio;                                  ///< strength over that of the dense body (3.9)
};
Curves curves_at(const DenseBody&, double relative_density);

/// How far a route is from a reference over their common densities: mean, root of mean square, and largest of
/// E/E_reference - 1, mean and root of mean square of nu - nu_reference.  NaN where nothing is common.
struct Deviation {
  std::string result, route, reference;
  int number = 0;
  double mean = ModuliPoint::unknown, rms = ModuliPoint::unknown;
  double worst = ModuliPoint::unknown, worst_density = ModuliPoint::unknown;
  double poisson_mean = ModuliPoint::unknown, poisson_rms = ModuliPoint::unknown;
};

/// From the curves at every point of the route: of solid spheres, of spherical pores.
std::vector<Deviation> deviations_from_curves(const Route&, const DenseBody&);
/// From another route, at those of its densities that this one's points enclose, linear between them.
Deviation deviation_from(const Route&, const Route& reference);

/// comparison.csv: a row a result, density and route, with the curves there and the deviations from them.
void add_comparison(ResultTable&, const Route&, const DenseBody&);
/// curves.csv: curves and bounds of a result at densities from 0.5 to 1.
void add_curves(ResultTable&, const std::string& result, const DenseBody&);
/// deviations.csv.
void add_deviation(ResultTable&, const Deviation&);

}  // namespace densify::app
