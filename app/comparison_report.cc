#include "app/comparison_report.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace densify::app {

namespace {

void print_dense(const std::string& name, const DenseBody& body) {
  const IsotropicModuli solid = body.solid();
  constexpr double giga = 1e-9;
  fmt::print("\n{}: dense E {:.4g} GPa, nu {:.4f}", name, giga * solid.youngs(), solid.poisson());
  if (body.phases.size() > 1) {
    const YoungsBounds means = reuss_voigt(body.phases), hs = hashin_shtrikman(body.phases).youngs();
    fmt::print(" of {} materials (Reuss and Voigt {:.1f} to {:.1f} GPa, Hashin and Shtrikman {:.1f} to {:.1f} GPa)",
               body.phases.size(), giga * means.lower, giga * means.upper, giga * hs.lower, giga * hs.upper);
  }
  fmt::print("\n");
}

/// E [GPa] and nu, a line a density, a column a route.
void print_routes(const std::vector<Route>& routes, const DenseBody& body) {
  fmt::print("{:<9s}", "density");
  for (const Route& route : routes) fmt::print("{:>18s}", route.name);
  fmt::print("{:>18s}{:>18s}\n", "solid spheres", "spherical pores");
  auto cell = [](double e, double nu) { return fmt::format("{:.4g} ({:.3f})", 1e-9 * e, nu); };
  std::set<double> densities;
  for (const Route& route : routes)
    for (const ModuliPoint& p : route.points) densities.insert(p.relative_density);
  for (const double density : densities) {
    fmt::print("{:<9.4f}", density);
    for (const Route& route : routes) {
      const auto p = std::find_if(route.points.begin(), route.points.end(),
                                  [&](const auto& q) { return q.relative_density == density; });
      fmt::print("{:>18s}", p == route.points.end() ? "" : cell(p->youngs, p->poisson));
    }
    const Curves c = curves_at(body, density);
    fmt::print("{:>18s}{:>18s}\n", cell(c.solid_spheres, c.solid_spheres_poisson),
               cell(c.spherical_pores, c.spherical_pores_poisson));
  }
  for (const Route& route : routes) {
    const auto above = std::count_if(route.points.begin(), route.points.end(), [&](const ModuliPoint& p) {
      return p.youngs > curves_at(body, p.relative_density).hashin_shtrikman;
    });
    if (above > 0)
      fmt::print("warning: {} is stiffer than any isotropic body of that density (Hashin and Shtrikman) at {} of {}\n",
                 route.name, above, route.points.size());
  }
}

}  // namespace

void print_comparison(const std::string& name, const DenseBody& body, const std::vector<Route>& routes) {
  print_dense(name, body);
  print_routes(routes, body);
}

void print_deviations(const std::vector<Deviation>& all) {
  fmt::print("\n{:<20s}{:<16s}{:<17s}{:>7s}{:>10s}{:>9s}{:>22s}{:>10s}{:>8s}\n", "result", "route", "against", "points",
             "E mean", "rms", "worst, at density", "nu mean", "rms");
  for (const Deviation& d : all)
    if (d.number > 0)
      fmt::print("{:<20s}{:<16s}{:<17s}{:>7d}{:>+8.1f} %{:>7.1f} %{:>+12.1f} % at {:.3f}{:>+10.3f}{:>8.3f}\n", d.result,
                 d.route, d.reference, d.number, 100 * d.mean, 100 * d.rms, 100 * d.worst, d.worst_density,
                 d.poisson_mean, d.poisson_rms);
}

}  // namespace densify::app
