#include "dem/specimen_report.h"

#include <algorithm>
#include <cstdio>
#include <sstream>

#include "dem/powder/size_distribution.h"

namespace densify::dem {

namespace {

constexpr int bins = 20;  // of equal width over the range of all diameters

std::string formatted(const char* format, double a, double b) {
  char text[200];
  std::snprintf(text, sizeof text, format, a, b);
  return text;
}

std::vector<double> diameters_of(const Particles& p, int material) {  // every material when negative
  std::vector<double> d;
  for (std::size_t k = 0; k < p.size(); ++k)
    if (material < 0 || p.material[k] == material) d.push_back(2 * p.reference_radius[k]);
  return d;
}

std::vector<double> bin_edges(const std::vector<double>& diameters) {
  const auto [low, high] = std::minmax_element(diameters.begin(), diameters.end());
  // Equal spheres need a bin of some width around them.
  const double from = *low < *high ? *low : 0.95 * *low, to = *low < *high ? *high : 1.05 * *high;
  std::vector<double> edges;
  for (int b = 0; b < bins; ++b) edges.push_back(from + (to - from) * b / bins);
  edges.push_back(to);
  return edges;
}

}  // namespace

SpecimenReport report_on(const GreenBody& body, const std::vector<Material>& materials) {
  const std::vector<double> all = diameters_of(body.particles, -1), edges = bin_edges(all);
  std::vector<std::string> names;
  std::vector<SizeStatistics> columns;
  for (std::size_t m = 0; materials.size() > 1 && m < materials.size(); ++m) {
    const auto d = diameters_of(body.particles, int(m));
    if (d.empty()) continue;
    names.push_back(materials[m].name);
    columns.push_back(size_statistics(d, edges));
  }
  names.push_back("all");
  columns.push_back(size_statistics(all, edges));

  SpecimenReport report;
  for (std::size_t c = 0; c < columns.size(); ++c) {
    const SizeStatistics& s = columns[c];
    report.lines.push_back(
        (columns.size() > 1 ? names[c] + ": " : "") + std::to_string(s.count) + " particles, " +
        formatted("solid volume %.4g um^3, diameter mean %.3f", s.solid_volume * 1e18, s.mean * 1e6) +
        formatted(" um, standard deviation %.3f um, %.2f", s.standard_deviation * 1e6, s.minimum * 1e6) +
        formatted(" to %.2f um", s.maximum * 1e6, 0));
  }
  if (body.steps > 0)  // packed, not imported
    report.lines.push_back(
        formatted("green density %.4f, coordination number %.2f", body.relative_density, body.coordination_number) +
        formatted(", mean overlap %.3f %% of the mean radius (%.0f packing steps)", 100 * body.mean_overlap,
                  double(body.steps)));

  std::ostringstream csv;
  csv << "diameter_from_m,diameter_to_m";
  for (const auto& name : names) csv << ",number_fraction_" << name << ",volume_fraction_" << name;
  csv << '\n';
  csv.precision(9);
  for (int b = 0; b < bins; ++b) {
    csv << edges[std::size_t(b)] << ',' << edges[std::size_t(b) + 1];
    for (const auto& s : columns)
      csv << ',' << s.number_fraction[std::size_t(b)] << ',' << s.volume_fraction[std::size_t(b)];
    csv << '\n';
  }
  report.sizes_csv = csv.str();
  return report;
}

}  // namespace densify::dem
