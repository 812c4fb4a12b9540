#include "app/moduli_table.h"

#include <fmt/core.h>

namespace densify::app {

namespace {

using Cell = ResultTable::Cell;
constexpr const char* component[6] = {"xx", "yy", "zz", "yz", "xz", "xy"};

void add_tensor(std::vector<Cell>& cells, const std::string& name, const std::string& unit, const Mat6& c) {
  for (int a = 0; a < 6; ++a)
    for (int b = a; b < 6; ++b)
      cells.push_back({fmt::format("{}_{}{}", name, a + 1, b + 1), unit, 0.5 * (c(a, b) + c(b, a))});
}

void add_vector(std::vector<Cell>& cells, const std::string& name, const std::string& unit, const Vec6& v) {
  for (int a = 0; a < 6; ++a) cells.push_back({name + "_" + component[a], unit, v[a]});
}

void add_checks(std::vector<Cell>& cells, const dem::TensorAnswer& a) {
  cells.push_back({"asymmetry", "", a.response.asymmetry});
  cells.push_back({"power_mismatch", "", a.response.power_mismatch});
  cells.push_back({"smallest_eigenvalue", "", a.response.smallest_eigenvalue});
  cells.push_back({"imbalance", "", a.response.imbalance});
  cells.push_back({"floppy", "", double(a.response.floppy)});
  cells.push_back({"soft_modes", "", a.soft_modes});
  cells.push_back({"iterations", "", double(a.response.iterations)});
  cells.push_back({"matrix_bytes", "", double(a.response.bytes)});
  cells.push_back({"solution_time", "s", a.seconds});
}

}  // namespace

std::vector<Cell> moment_cells(const dem::SpecimenNetwork& s, const dem::NetworkStructure& n) {
  std::vector<Cell> cells{{"time", "s", s.time},
                          {"temperature", "K", s.temperature},
                          {"relative_density", "", s.relative_density},
                          {"volume", "m^3", s.volume},
                          {"particles", "", double(n.particles)},
                          {"contacts", "", double(n.contacts)},
                          {"necks", "", double(n.necks)},
                          {"coordination_number", "", n.coordination},
                          {"rattlers", "", double(n.rattlers)},
                          {"loosely_held", "", double(n.loose)},
                          {"islands", "", double(n.islands)},
                          {"spanning_particles", "", double(n.spanning)}};
  const Mat3& f = n.fabric;
  Vec6 fabric;
  fabric << f(0, 0), f(1, 1), f(2, 2), f(1, 2), f(0, 2), f(0, 1);
  add_vector(cells, "fabric", "", fabric);
  return cells;
}

std::vector<Cell> stiffness_cells(const dem::TensorAnswer& a) {
  std::vector<Cell> cells;
  for (const bool relaxed : {true, false}) {
    const IsotropicPart& p = relaxed ? a.relaxed : a.affine;
    const std::string of = relaxed ? "" : "affine_";
    cells.push_back({of + "youngs_modulus", "Pa", p.youngs});
    cells.push_back({of + "poissons_ratio", "", p.poisson});
    cells.push_back({of + "bulk_modulus", "Pa", p.bulk});
    cells.push_back({of + "shear_modulus", "Pa", p.shear});
    cells.push_back({of + "anisotropy", "", p.distance});
    cells.push_back({of + "universal_anisotropy", "", p.universal});
  }
  add_tensor(cells, "C", "Pa", a.response.relaxed);
  add_tensor(cells, "affine_C", "Pa", a.response.affine);
  add_checks(cells, a);
  return cells;
}

std::vector<Cell> viscosity_cells(const dem::ViscousAnswer& v) {
  const std::string pas = "Pa s";
  std::vector<Cell> cells{{"flowing_contacts", "", double(v.flowing)}, {"rigid_contacts", "", double(v.rigid)}};
  for (const bool relaxed : {true, false}) {
    const IsotropicPart& p = relaxed ? v.viscosity.relaxed : v.viscosity.affine;
    const std::string of = relaxed ? "" : "affine_";
    cells.push_back({of + "bulk_viscosity", pas, p.bulk});
    cells.push_back({of + "shear_viscosity", pas, p.shear});
    cells.push_back({of + "viscous_poissons_ratio", "", p.poisson});
    cells.push_back({of + "anisotropy", "", p.distance});
  }
  cells.push_back({"sintering_stress", "Pa", v.sintering_stress.head<3>().mean()});
  cells.push_back({"affine_sintering_stress", "Pa", v.affine_sintering_stress.head<3>().mean()});
  cells.push_back({"free_densification_rate", "1/s", v.densification_rate});
  add_vector(cells, "sintering_stress", "Pa", v.sintering_stress);
  add_vector(cells, "affine_sintering_stress", "Pa", v.affine_sintering_stress);
  add_vector(cells, "free_strain_rate", "1/s", v.free_strain_rate);
  add_tensor(cells, "N", pas, v.viscosity.response.relaxed);
  add_tensor(cells, "affine_N", pas, v.viscosity.response.affine);
  add_checks(cells, v.viscosity);
  return cells;
}

}  // namespace densify::app
