#include "app/stress_tables.h"

#include <algorithm>

#include "dem/measure/statistics.h"

namespace densify::app {

namespace {

using dem::MomentStresses;
using dem::Snapshot;
using dem::StressPart;
using Cell = ResultTable::Cell;

std::vector<Cell> moment_cells(const Snapshot& s) {
  return {{"time", "s", s.moment.time},
          {"temperature", "K", s.moment.temperature},
          {"relative_density", "", s.moment.relative_density}};
}

std::vector<Cell> statistics_cells(const Snapshot& s, const std::vector<double>& values) {
  std::vector<Cell> cells = moment_cells(s);
  const dem::Statistics t = dem::statistics(values);
  cells.push_back({"number", "", double(t.number)});
  cells.push_back({"mean", "Pa", t.mean});
  cells.push_back({"standard_deviation", "Pa", t.standard_deviation});
  cells.push_back({"minimum", "Pa", t.minimum});
  cells.push_back({"maximum", "Pa", t.maximum});
  cells.push_back({"median", "Pa", t.median});
  return cells;
}

}  // namespace

StressTables::StressTables()
    : macroscopic_({"stage", "by", "of"}),
      particles_({"stage", "stress", "of"}),
      necks_({"stage", "stress", "necks", "of"}) {}

void StressTables::add(const Snapshot& s, const MomentStresses& m) {
  add_macroscopic(s, m);
  add_particles(s, m);
  if (!m.necks.empty()) add_necks(s, m);
}

void StressTables::add_macroscopic(const Snapshot& s, const MomentStresses& m) {
  auto row = [&](const std::string& by, const std::string& of, double share, auto&& stress_of) {
    constexpr const char* component[6] = {"xx", "yy", "zz", "yz", "xz", "xy"};
    std::vector<Cell> cells = moment_cells(s);
    cells.push_back({"volume", "m^3", m.volume});
    cells.push_back({"volume_share", "", share});
    for (const StressPart part : dem::stress_parts) {
      const dem::Stress& stress = stress_of(std::size_t(part));
      for (std::size_t c = 0; c < 6; ++c)
        cells.push_back({std::string(name_of(part)) + "_" + component[c], "Pa", stress[c]});
    }
    cells.push_back({"mismatch", "", m.mismatch});
    macroscopic_.add_row({s.moment.stage, by, of}, cells);
  };
  row(
      "specimen", "all", dem::unset, [&](std::size_t p) -> auto& { return m.macroscopic[p]; });
  for (std::size_t k = 0; k < m.kinds.size(); ++k)
    if (k != m.kinds.walls() || !s.wall.empty())
      row(
          "contacts", m.kinds.name(k), dem::unset, [&](std::size_t p) -> auto& { return m.by_kind[p][k]; });
  const auto solid = dem::material_volumes(s);
  for (std::size_t k = 0; k < s.materials.size(); ++k)
    row(
        "particles", s.materials[k], solid[k] / m.volume, [&](std::size_t p) -> auto& { return m.by_material[p][k]; });
}

void StressTables::add_particles(const Snapshot& s, const MomentStresses& m) {
  auto rows = [&](const std::string& stress, const std::vector<double>& of_particles) {
    for (auto& group : dem::by_materials(s, of_particles)) {
      particles_.add_row({s.moment.stage, stress, group.name}, statistics_cells(s, group.values));
      samples_.push_back({s.moment.time, s.moment.stage, "particles", stress, "all", std::move(group)});
    }
  };
  for (const StressPart part : dem::stress_parts)
    rows(std::string(name_of(part)) + " mean", dem::mean_stresses(m.of_particles[std::size_t(part)]));
  std::vector<double> von_mises;
  for (const auto& t : m.of_particles[std::size_t(StressPart::total)]) von_mises.push_back(dem::von_mises_stress(t));
  rows("total von Mises", von_mises);
}

void StressTables::add_necks(const Snapshot& s, const MomentStresses& m) {
  for (const StressPart part : dem::stress_parts)
    for (const dem::NeckSet set : {dem::NeckSet::all, dem::NeckSet::short_of_equilibrium})
      for (auto& group : dem::necks_by_kinds(s, m, part, set)) {
        const std::string which = set == dem::NeckSet::all ? "all" : "short of equilibrium";
        necks_.add_row({s.moment.stage, name_of(part), which, group.name}, statistics_cells(s, group.values));
        samples_.push_back({s.moment.time, s.moment.stage, "necks", name_of(part), which, std::move(group)});
      }
}

ResultTable StressTables::histograms() const {
  ResultTable table({"stage", "where", "stress", "set", "of"});
  std::vector<bool> done(samples_.size(), false);
  for (std::size_t first = 0; first < samples_.size(); ++first) {
    if (done[first]) continue;
    // Moments and groups of one stress share their bins, so that they can be compared.
    std::vector<std::size_t> same;
    std::vector<double> values;
    for (std::size_t k = first; k < samples_.size(); ++k)
      if (samples_[k].where == samples_[first].where && samples_[k].stress == samples_[first].stress) {
        done[k] = true;
        same.push_back(k);
        values.insert(values.end(), samples_[k].group.values.begin(), samples_[k].group.values.end());
      }
    const dem::Bins bins = dem::round_bins(std::move(values));
    constexpr double infinity = std::numeric_limits<double>::infinity();
    for (const std::size_t k : same) {
      const auto count = dem::count_in(bins, samples_[k].group.values);
      for (std::size_t b = 0; b < count.size(); ++b) {
        const double low = bins.low + (double(b) - 1) * bins.width;
        table.add_row(
            {samples_[k].stage, samples_[k].where, samples_[k].stress, samples_[k].set, samples_[k].group.name},
            {{"time", "s", samples_[k].time},
             {"low", "Pa", b == 0 ? -infinity : low},
             {"high", "Pa", b + 1 == count.size() ? infinity : low + bins.width},
             {"count", "", double(count[b])}});
      }
    }
  }
  return table;
}

void StressTables::write_csv(const std::filesystem::path& folder) const {
  macroscopic_.write_csv(folder, "macroscopic_stress");
  particles_.write_csv(folder, "particle_stress");
  if (has_necks()) necks_.write_csv(folder, "neck_stress");
  histograms().write_csv(folder, "stress_histograms");
}

void StressTables::write_hdf5(dem::Hdf5Writer& file) const {
  macroscopic_.write_hdf5(file, "/macroscopic");
  particles_.write_hdf5(file, "/particles");
  if (has_necks()) necks_.write_hdf5(file, "/necks");
  histograms().write_hdf5(file, "/histograms");
}

void write_each(dem::Hdf5Writer& file, const std::string& group, const Snapshot& s, const MomentStresses& m) {
  file.group(group);
  file.attribute(group, "time", s.moment.time);
  file.list(group + "/particles/id", s.id, "");
  for (const StressPart part : dem::stress_parts) {
    std::vector<double> flat;
    for (const auto& t : m.of_particles[std::size_t(part)]) flat.insert(flat.end(), t.begin(), t.end());
    const std::string name = group + "/particles/" + name_of(part) + "_stress";
    file.table(name, flat, 6, "Pa");
    file.attribute(name, "components", "xx yy zz yz xz xy");
  }
  if (m.necks.empty()) return;
  std::vector<std::uint32_t> first, second;
  std::vector<std::uint8_t> at_equilibrium;
  std::vector<double> sintering, viscoelastic;
  for (const auto& n : m.necks) {
    first.push_back(s.first_id[n.contact]);
    second.push_back(s.second_id[n.contact]);
    at_equilibrium.push_back(n.at_equilibrium);
    sintering.push_back(n.sintering);
    viscoelastic.push_back(n.viscoelastic);
  }
  file.list(group + "/necks/first_id", first, "");
  file.list(group + "/necks/second_id", second, "");
  file.list(group + "/necks/at_equilibrium", at_equilibrium, "");
  file.list(group + "/necks/sintering_stress", sintering, "Pa");
  file.list(group + "/necks/viscoelastic_stress", viscoelastic, "Pa");
}

}  // namespace densify::app
