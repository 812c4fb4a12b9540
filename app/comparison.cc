#include "app/comparison.h"

#include <algorithm>
#include <cmath>

#include "base/roberts_garboczi.h"

namespace densify::app {

namespace {

using Cells = std::vector<ResultTable::Cell>;

/// A point of a route and what the reference has there.
struct Pair {
  double density, youngs, poisson, reference_youngs, reference_poisson;
};

Deviation deviation(const Route& route, const std::string& reference, const std::vector<Pair>& pairs) {
  Deviation d{route.result, route.name, reference};
  double sum = 0, squares = 0, poisson_sum = 0, poisson_squares = 0;
  int with_poisson = 0;
  for (const Pair& p : pairs) {
    const double youngs = p.youngs / p.reference_youngs - 1, poisson = p.poisson - p.reference_poisson;
    if (std::isfinite(youngs)) {
      ++d.number;
      sum += youngs, squares += youngs * youngs;
      if (!(std::abs(youngs) <= std::abs(d.worst))) d.worst = youngs, d.worst_density = p.density;
    }
    if (std::isfinite(poisson)) {
      ++with_poisson;
      poisson_sum += poisson, poisson_squares += poisson * poisson;
    }
  }
  if (d.number > 0) d.mean = sum / d.number, d.rms = std::sqrt(squares / d.number);
  if (with_poisson > 0)
    d.poisson_mean = poisson_sum / with_poisson, d.poisson_rms = std::sqrt(poisson_squares / with_poisson);
  return d;
}

/// The route at a density between two of its points; NaN beyond its ends.
ModuliPoint between(const Route& route, double density) {
  ModuliPoint p;
  const auto& all = route.points;
  const auto above = std::find_if(all.begin(), all.end(), [&](const auto& q) { return q.relative_density >= density; });
  if (above == all.end() || (above == all.begin() && above->relative_density > density)) return p;
  p.relative_density = density;
  if (above->relative_density == density) {
    p.youngs = above->youngs, p.poisson = above->poisson;
    return p;
  }
  const auto below = above - 1;
  const double t = (density - below->relative_density) / (above->relative_density - below->relative_density);
  p.youngs = std::lerp(below->youngs, above->youngs, t);
  p.poisson = std::lerp(below->poisson, above->poisson, t);
  return p;
}

Cells curve_cells(const Curves& c, double dense_strength) {
  return {{"solid_spheres_youngs_modulus", "Pa", c.solid_spheres},
          {"spherical_pores_youngs_modulus", "Pa", c.spherical_pores},
          {"solid_spheres_poissons_ratio", "", c.solid_spheres_poisson},
          {"spherical_pores_poissons_ratio", "", c.spherical_pores_poisson},
          {"hashin_shtrikman_upper_youngs_modulus", "Pa", c.hashin_shtrikman},
          {"voigt_youngs_modulus", "Pa", c.voigt},
          {"ryshkewitch_strength_ratio", "", c.strength_ratio},
          {"ryshkewitch_strength", "Pa", dense_strength * c.strength_ratio}};
}

}  // namespace

Curves curves_at(const DenseBody& body, double density) {
  const IsotropicModuli solid = body.solid();
  const double e = solid.youngs(), nu = solid.poisson();
  const auto porous = with_pores(body.phases, density);
  return {e * overlapping_solid_spheres.youngs_ratio(density),
          e * overlapping_spherical_pores.youngs_ratio(density),
          overlapping_solid_spheres.poissons_ratio(density, nu),
          overlapping_spherical_pores.poissons_ratio(density, nu),
          hashin_shtrikman(porous).upper.youngs(),
          reuss_voigt(porous).upper,
          ryshkewitch_strength_ratio(density, body.strength_exponent)};
}

std::vector<Deviation> deviations_from_curves(const Route& route, const DenseBody& body) {
  std::vector<Pair> spheres, pores;
  for (const ModuliPoint& p : route.points) {
    const Curves c = curves_at(body, p.relative_density);
    spheres.push_back({p.relative_density, p.youngs, p.poisson, c.solid_spheres, c.solid_spheres_poisson});
    pores.push_back({p.relative_density, p.youngs, p.poisson, c.spherical_pores, c.spherical_pores_poisson});
  }
  return {deviation(route, "solid_spheres", spheres), deviation(route, "spherical_pores", pores)};
}

Deviation deviation_from(const Route& route, const Route& reference) {
  std::vector<Pair> pairs;
  for (const ModuliPoint& r : reference.points) {
    const ModuliPoint p = between(route, r.relative_density);
    pairs.push_back({r.relative_density, p.youngs, p.poisson, r.youngs, r.poisson});
  }
  return deviation(route, reference.name, pairs);
}

void add_comparison(ResultTable& table, const Route& route, const DenseBody& body) {
  const IsotropicModuli solid = body.solid();
  for (const ModuliPoint& p : route.points) {
    const Curves c = curves_at(body, p.relative_density);
    Cells cells{{"time", "s", p.time},
                {"relative_density", "", p.relative_density},
                {"youngs_modulus", "Pa", p.youngs},
                {"youngs_modulus_error", "Pa", p.youngs_error},
                {"poissons_ratio", "", p.poisson},
                {"poissons_ratio_error", "", p.poisson_error},
                {"strength", "Pa", p.strength},
                {"coarsest_voxels_across_neck", "", p.voxels_across_neck},
                {"solid_youngs_modulus", "Pa", solid.youngs()},
                {"solid_poissons_ratio", "", solid.poisson()}};
    const Cells curves = curve_cells(c, body.strength);
    cells.insert(cells.end(), curves.begin(), curves.end());
    cells.insert(cells.end(), {{"from_solid_spheres", "", p.youngs / c.solid_spheres - 1},
                               {"from_spherical_pores", "", p.youngs / c.spherical_pores - 1},
                               {"from_hashin_shtrikman_upper", "", p.youngs / c.hashin_shtrikman - 1},
                               {"poissons_ratio_from_solid_spheres", "", p.poisson - c.solid_spheres_poisson},
                               {"poissons_ratio_from_spherical_pores", "", p.poisson - c.spherical_pores_poisson}});
    table.add_row({route.result, route.name}, cells);
  }
}

void add_curves(ResultTable& table, const std::string& result, const DenseBody& body) {
  const YoungsBounds means = reuss_voigt(body.phases), hs = hashin_shtrikman(body.phases).youngs();
  constexpr int first = 100, last = 200;
  for (int k = first; k <= last; ++k) {
    const double density = double(k) / last;
    Cells cells{{"relative_density", "", density}};
    const Cells curves = curve_cells(curves_at(body, density), body.strength);
    cells.insert(cells.end(), curves.begin(), curves.end());
    cells.insert(cells.end(), {{"dense_reuss_youngs_modulus", "Pa", means.lower},
                               {"dense_voigt_youngs_modulus", "Pa", means.upper},
                               {"dense_hashin_shtrikman_lower_youngs_modulus", "Pa", hs.lower},
                               {"dense_hashin_shtrikman_upper_youngs_modulus", "Pa", hs.upper}});
    table.add_row({result}, cells);
  }
}

void add_deviation(ResultTable& table, const Deviation& d) {
  table.add_row({d.result, d.route, d.reference}, {{"points", "", double(d.number)},
                                                   {"youngs_modulus_mean", "", d.mean},
                                                   {"youngs_modulus_rms", "", d.rms},
                                                   {"youngs_modulus_worst", "", d.worst},
                                                   {"at_relative_density", "", d.worst_density},
                                                   {"poissons_ratio_mean", "", d.poisson_mean},
                                                   {"poissons_ratio_rms", "", d.poisson_rms}});
}

}  // namespace densify::app
