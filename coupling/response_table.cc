#include "coupling/response_table.h"

#include <Eigen/LU>
#include <functional>

#include "base/check.h"
#include "dem/io/hdf5_file.h"

namespace densify::coupling {

namespace {

const char* const format = "densify response table 1";

/// A member of a node, one or several numbers of it.
template <class Node>
struct Column {
  const char* name;
  const char* unit;
  std::size_t width;
  std::function<double*(Node&)> at;
};

std::vector<Column<ColdNode>> cold_columns() {
  return {{"relative_density", "", 1, [](ColdNode& n) { return &n.density; }},
          {"axial_pressure", "Pa", 1, [](ColdNode& n) { return &n.axial; }},
          {"lateral_pressure", "Pa", 1, [](ColdNode& n) { return &n.lateral; }},
          {"relative_density_scatter", "", 1, [](ColdNode& n) { return &n.density_scatter; }},
          {"stiffness_over_youngs_modulus", "", 5, [](ColdNode& n) { return n.stiffness.data(); }}};
}

std::vector<Column<SinteringNode>> sintering_columns() {
  using N = SinteringNode;
  return {{"relative_density", "", 1, [](N& n) { return &n.density; }},
          {"viscosity", "Pa s", 5, [](N& n) { return n.viscosity.data(); }},
          {"viscosity_scatter", "", 1, [](N& n) { return &n.viscosity_scatter; }},
          {"stiffness_over_youngs_modulus", "", 5, [](N& n) { return n.stiffness.data(); }},
          {"sintering_stress", "Pa", 2, [](N& n) { return n.sintering_stress.data(); }},
          {"sintering_stress_scatter", "", 1, [](N& n) { return &n.sintering_stress_scatter; }},
          {"neck_state", "", 1, [](N& n) { return &n.neck_state; }},
          {"necks_at_equilibrium", "", 1, [](N& n) { return &n.at_equilibrium; }}};
}

template <class Node>
void write_nodes(dem::Hdf5Writer& file, const std::string& group, std::vector<Node> nodes,
                 const std::vector<Column<Node>>& columns) {
  for (const auto& c : columns) {
    std::vector<double> values;
    for (Node& n : nodes) values.insert(values.end(), c.at(n), c.at(n) + c.width);
    file.table(group + "/" + c.name, values, c.width, c.unit);
  }
}

template <class Node>
std::vector<Node> read_nodes(const dem::Hdf5Reader& file, const std::string& group,
                             const std::vector<Column<Node>>& columns) {
  std::vector<Node> nodes(file.shape(group + "/relative_density").rows);
  for (const auto& c : columns) {
    const auto values = file.read<double>(group + "/" + c.name);
    if (values.size() != nodes.size() * c.width)
      throw FileError(file.path().string() + ": " + group + "/" + c.name + " has not the length of the others");
    for (std::size_t k = 0; k < nodes.size(); ++k)
      std::copy_n(values.begin() + std::ptrdiff_t(k * c.width), c.width, c.at(nodes[k]));
  }
  return nodes;
}

std::string branch_group(std::size_t k) {
  return "/sintering/" + std::to_string(k);
}

}  // namespace

AxialTensor axial_part(const Mat6& c) {
  // The mean over all turns about z keeps two invariants of the plane: its resistance to dilatation and to shear.
  const double dilatation = (c(0, 0) + c(1, 1) + 2 * c(0, 1)) / 4;
  const double shear = (c(0, 0) + c(1, 1) - 2 * c(0, 1) + 4 * c(5, 5)) / 8;
  return {dilatation + shear, c(2, 2), dilatation - shear, 0.5 * (c(0, 2) + c(1, 2)), 0.5 * (c(3, 3) + c(4, 4))};
}

Mat6 full_tensor(const AxialTensor& a) {
  Mat6 c = Mat6::Zero();
  c(0, 0) = c(1, 1) = a[0];
  c(2, 2) = a[1];
  c(0, 1) = c(1, 0) = a[2];
  c(0, 2) = c(2, 0) = c(1, 2) = c(2, 1) = a[3];
  c(3, 3) = c(4, 4) = a[4];
  c(5, 5) = 0.5 * (a[0] - a[2]);
  return c;
}

Mat6 inverse_tensor(const AxialTensor& a) {
  const Mat6 c = full_tensor(a);
  Mat6 s = Mat6::Zero();
  s.topLeftCorner<3, 3>() = Mat3(c.topLeftCorner<3, 3>()).inverse();
  for (int k = 3; k < 6; ++k) s(k, k) = 1 / c(k, k);
  return s;
}

void write_table(const std::filesystem::path& path, const ResponseTable& t) {
  dem::Hdf5Writer file(path);
  file.attribute("/", "format", format);
  file.attribute("/", "git_revision", t.revision);
  file.attribute("/", "material", t.material);
  file.attribute("/", "particles", std::uint64_t(t.particles));
  file.attribute("/", "elements", std::uint64_t(t.elements));
  const auto number = [&](const char* name, double value) { file.attribute("/", name, value); };
  number("reference_temperature_K", t.reference_temperature);
  number("activation_temperature_K", t.activation_temperature);
  number("thermal_expansion_per_K", t.thermal_expansion);
  number("atomic_volume_m3", t.diffusion.atomic_volume);
  number("diffusion_prefactor_m2_per_s", t.diffusion.prefactor);
  number("activation_enthalpy_J_per_mol", t.diffusion.activation_enthalpy);
  number("grain_boundary_width_m", t.diffusion.grain_boundary_width);
  number("error_relative_density", t.check.error);
  number("error_relative_density_loose", t.check.loose_error);
  file.text("/scene", t.scene);
  std::vector<double> modulus;
  for (const auto& knot : t.youngs_modulus.knots()) modulus.insert(modulus.end(), {knot.x, knot.y});
  file.table("/youngs_modulus", modulus, 2, "K, Pa");
  write_nodes(file, "/cold", t.cold, cold_columns());
  for (std::size_t k = 0; k < t.sintering.size(); ++k) {
    const SinteringBranch& b = t.sintering[k];
    write_nodes(file, branch_group(k), b.nodes, sintering_columns());
    file.attribute(branch_group(k), "path", b.path);
    file.attribute(branch_group(k), "birth_density", b.birth);
    file.attribute(branch_group(k), "pressure_factor", b.pressure_factor);
  }
  file.list("/check/time", t.check.time, "s");
  file.list("/check/temperature", t.check.temperature, "K");
  file.list("/check/relative_density_of_element", t.check.element, "");
  file.list("/check/relative_density_by_table", t.check.table, "");
  file.attribute("/check", "pressure_factor", t.check.pressure_factor);
  file.attribute("/check", "heating_factor", t.check.heating_factor);
  file.commit(dem::Durability::power_loss);
}

ResponseTable read_table(const std::filesystem::path& path) {
  if (!std::filesystem::exists(path))
    throw InputError(path.string() + ": there is no such table; densify tabulate SCENE makes it");
  const dem::Hdf5Reader file(path);
  if (!file.has("/cold") || file.attribute<std::string>("/", "format") != format)
    throw InputError(path.string() + ": is no table of this version's densify tabulate; make it anew");
  ResponseTable t;
  t.revision = file.attribute<std::string>("/", "git_revision");
  t.material = file.attribute<std::string>("/", "material");
  t.particles = file.attribute<std::uint64_t>("/", "particles");
  t.elements = file.attribute<std::uint64_t>("/", "elements");
  const auto number = [&](const char* name) { return file.attribute<double>("/", name); };
  t.reference_temperature = number("reference_temperature_K");
  t.activation_temperature = number("activation_temperature_K");
  t.thermal_expansion = number("thermal_expansion_per_K");
  t.diffusion = {number("atomic_volume_m3"), number("diffusion_prefactor_m2_per_s"),
                 number("activation_enthalpy_J_per_mol"), number("grain_boundary_width_m")};
  t.check.error = number("error_relative_density");
  t.check.loose_error = number("error_relative_density_loose");
  t.scene = file.text("/scene");
  std::vector<PiecewiseLinear::Knot> knots;
  const auto modulus = file.read<double>("/youngs_modulus");
  for (std::size_t k = 0; k + 1 < modulus.size(); k += 2) knots.push_back({modulus[k], modulus[k + 1]});
  t.youngs_modulus = PiecewiseLinear(knots);
  t.cold = read_nodes(file, "/cold", cold_columns());
  for (std::size_t k = 0; file.has("/sintering") && file.has(branch_group(k)); ++k) {
    SinteringBranch b{file.attribute<std::string>(branch_group(k), "path"),
                      file.attribute<double>(branch_group(k), "birth_density"),
                      file.attribute<double>(branch_group(k), "pressure_factor"),
                      read_nodes(file, branch_group(k), sintering_columns())};
    t.sintering.push_back(std::move(b));
  }
  t.check.time = file.read<double>("/check/time");
  t.check.temperature = file.read<double>("/check/temperature");
  t.check.element = file.read<double>("/check/relative_density_of_element");
  t.check.table = file.read<double>("/check/relative_density_by_table");
  t.check.pressure_factor = file.attribute<double>("/check", "pressure_factor");
  t.check.heating_factor = file.attribute<double>("/check", "heating_factor");
  return t;
}

}  // namespace densify::coupling
