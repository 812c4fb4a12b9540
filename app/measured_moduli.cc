#include "app/measured_moduli.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <map>
#include <string_view>

#include "base/check.h"
#include "base/specimen_tests.h"

namespace densify::app {

namespace {

std::vector<std::string> fields_of(std::string_view line) {
  std::vector<std::string> fields;
  while (true) {
    const std::size_t end = std::min(line.find(','), line.size());
    std::string_view field = line.substr(0, end);
    while (!field.empty() && field.front() == ' ') field.remove_prefix(1);
    while (!field.empty() && (field.back() == ' ' || field.back() == '\r')) field.remove_suffix(1);
    fields.emplace_back(field);
    if (end == line.size()) return fields;
    line.remove_prefix(end + 1);
  }
}

/// One row: numbers by column, NaN where a column is missing or a field empty.
class Row {
 public:
  Row(const std::vector<std::string>& columns, const std::string& line, std::string place) : place_(std::move(place)) {
    const auto fields = fields_of(line);
    if (fields.size() != columns.size())
      throw InputError(place_ + ": " + std::to_string(fields.size()) + " fields, and the first line names " +
                       std::to_string(columns.size()));
    for (std::size_t c = 0; c < columns.size(); ++c) text_[columns[c]] = fields[c];
  }

  double number(const std::string& column) const {
    const auto found = text_.find(column);
    if (found == text_.end() || found->second.empty()) return ModuliPoint::unknown;
    const std::string& text = found->second;
    double value = 0;
    const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (failure != std::errc() || end != text.data() + text.size() || !std::isfinite(value))
      throw InputError(place_ + ": " + column + " \"" + text + "\" is not a number");
    return value;
  }
  double within(const std::string& column, double low, double high) const {
    const double value = number(column);
    if (value <= low || value > high)
      throw InputError(place_ + ": " + column + " must be above " + std::to_string(low) + " and at most " +
                       std::to_string(high));
    return value;
  }
  double positive(const std::string& column) const {
    const double value = number(column);
    if (value <= 0) throw InputError(place_ + ": " + column + " must be above 0");
    return value;
  }

 private:
  std::string place_;
  std::map<std::string, std::string> text_;
};

ModuliPoint point_of(const Row& row, const std::string& place) {
  ModuliPoint p;
  p.relative_density = row.within("relative_density", 0, 1);
  if (std::isnan(p.relative_density)) throw InputError(place + ": no relative_density");
  p.youngs = 1e9 * row.positive("youngs_modulus_GPa");
  p.poisson = row.within("poissons_ratio", -1, 0.5);
  const double density = row.positive("density_kg_per_m3"), longitudinal = row.positive("longitudinal_speed_m_per_s"),
               transverse = row.positive("transverse_speed_m_per_s");
  if (const double waves = density * longitudinal * transverse; std::isfinite(waves)) {
    const IsotropicModuli m = moduli_of_waves(density, longitudinal, transverse);
    if (!(m.bulk > 0))
      throw InputError(place + ": the transverse wave must be slower than 0.866 of the longitudinal one");
    p.youngs = m.youngs(), p.poisson = m.poisson();
  }
  p.strength = 1e6 * row.positive("strength_MPa");
  const double force = row.positive("peak_force_N"), height = 1e-3 * row.positive("disc_height_mm"),
               diameter = 1e-3 * row.positive("disc_diameter_mm");
  if (std::isfinite(force * height * diameter)) p.strength = brazilian_strength(force, height, diameter);
  if (std::isnan(p.youngs) && std::isnan(p.poisson) && std::isnan(p.strength))
    throw InputError(place +
                     ": no modulus and no strength; columns are youngs_modulus_GPa and poissons_ratio, or "
                     "density_kg_per_m3, longitudinal_speed_m_per_s and transverse_speed_m_per_s; strength_MPa, or "
                     "peak_force_N, disc_height_mm and disc_diameter_mm");
  return p;
}

}  // namespace

Route read_measured_moduli(const std::filesystem::path& file) {
  std::ifstream stream(file);
  if (!stream || std::filesystem::is_directory(file))
    throw InputError("--measured " + file.string() + ": cannot be read");
  Route measured{"measured", "measured", {}};
  std::vector<std::string> columns;
  std::string line;
  for (int number = 1; std::getline(stream, line); ++number) {
    if (line.empty() || line.front() == '#') continue;
    const std::string place = file.string() + ", line " + std::to_string(number);
    if (columns.empty()) {
      columns = fields_of(line);
      if (std::find(columns.begin(), columns.end(), "relative_density") == columns.end())
        throw InputError(place + ": no column relative_density among the names of the columns");
      continue;
    }
    measured.points.push_back(point_of(Row(columns, line, place), place));
  }
  if (measured.points.empty()) throw InputError(file.string() + ": no measurement in it");
  std::stable_sort(measured.points.begin(), measured.points.end(),
                   [](const auto& a, const auto& b) { return a.relative_density < b.relative_density; });
  return measured;
}

}  // namespace densify::app
