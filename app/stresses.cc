#include "app/stresses.h"

#include <fmt/core.h>

#include "app/draw.h"
#include "app/stress_tables.h"
#include "base/version.h"
#include "dem/io/stored_snapshot.h"
#include "dem/measure/statistics.h"

namespace densify::app {

namespace {

using dem::MomentStresses;
using dem::Snapshot;
using dem::StressPart;

constexpr double mega = 1e-6;

void print_macroscopic(const Snapshot& s, const MomentStresses& m) {
  fmt::print("{:<38s}{:>9s}{:>11s}{:>11s}{:>11s}{:>11s}{:>11s}\n", "macroscopic stress [MPa]", "xx", "yy", "zz", "yz",
             "xz", "xy");
  auto line = [](const std::string& name, const dem::Stress& t) {
    fmt::print("  {:<36s}", name);
    fmt::print("{:>9.4g}{:>11.4g}{:>11.4g}{:>11.4g}{:>11.4g}{:>11.4g}\n", mega * t[0], mega * t[1], mega * t[2],
               mega * t[3], mega * t[4], mega * t[5]);
  };
  const auto total = std::size_t(StressPart::total);
  for (const StressPart part : dem::stress_parts) {
    if (m.necks.empty() && part != StressPart::total) continue;
    line(name_of(part), m.macroscopic[std::size_t(part)]);
  }
  for (std::size_t k = 0; k < m.kinds.size(); ++k)
    if (k != m.kinds.walls() || !s.wall.empty()) line("  of it " + m.kinds.name(k), m.by_kind[total][k]);
  for (std::size_t k = 0; k < s.materials.size() && s.materials.size() > 1; ++k)
    line("  of it " + s.materials[k] + " particles", m.by_material[total][k]);
}

void print_statistics(const std::string& title, const std::vector<std::pair<std::string, std::vector<double>>>& lines) {
  fmt::print("{:<38s}{:>9s}{:>11s}{:>11s}{:>11s}{:>11s}{:>11s}\n", title, "number", "mean", "std dev", "minimum",
             "maximum", "median");
  for (const auto& [name, values] : lines) {
    if (values.empty()) continue;
    const dem::Statistics t = dem::statistics(values);
    fmt::print("  {:<36s}{:>9d}{:>11.4g}{:>11.4g}{:>11.4g}{:>11.4g}{:>11.4g}\n", name, t.number, mega * t.mean,
               mega * t.standard_deviation, mega * t.minimum, mega * t.maximum, mega * t.median);
  }
}

void print_particles(const Snapshot& s, const MomentStresses& m) {
  std::vector<std::pair<std::string, std::vector<double>>> lines;
  for (auto& group : by_materials(s, dem::mean_stresses(m.of_particles[std::size_t(StressPart::total)])))
    lines.emplace_back(group.name, std::move(group.values));
  print_statistics("mean stress in particles [MPa]", lines);
}

void print_necks(const Snapshot& s, const MomentStresses& m) {
  std::vector<std::pair<std::string, std::vector<double>>> lines;
  for (const StressPart part : dem::stress_parts) {
    for (auto& group : necks_by_kinds(s, m, part, dem::NeckSet::all))
      lines.emplace_back(std::string(name_of(part)) + ", " + group.name, std::move(group.values));
    lines.emplace_back(std::string(name_of(part)) + ", short of equilibrium",
                       necks_by_kinds(s, m, part, dem::NeckSet::short_of_equilibrium).back().values);
  }
  print_statistics("stress in necks [MPa]", lines);
}

void print_moment(const Snapshot& s, const MomentStresses& m) {
  fmt::print("\n{:.6g} s ({:.1f} min), {:.1f} K, relative density {:.4f}, stage \"{}\"\n", s.moment.time,
             s.moment.time / 60, s.moment.temperature, s.moment.relative_density, s.moment.stage);
  fmt::print("{} particles, {} contacts, {} necks; (6.9) and (6.10) agree to {:.1e}\n", s.id.size(), s.first_id.size(),
             m.necks.size(), m.mismatch);
  print_macroscopic(s, m);
  print_particles(s, m);
  if (!m.necks.empty()) print_necks(s, m);
}

}  // namespace

int stresses_command(const StressesCommand& command) {
  const std::filesystem::path path = result_file(command);
  const dem::Hdf5Reader file(path);
  const auto moments = chosen_moments(dem::stored_moments(file), command, path);
  StressTables tables;
  const std::filesystem::path folder = table_folder(command, path);
  dem::Hdf5Writer out(folder / "stresses.h5");
  out.attribute("/", "densify_version", std::string(version()));
  out.attribute("/", "git_revision", std::string(git_revision()));
  for (std::size_t k = 0; k < moments.size(); ++k) {
    const Snapshot s = dem::read_snapshot(file, moments[k].group);
    const MomentStresses m = dem::moment_stresses(s);
    tables.add(s, m);
    write_each(out, "/moments/" + dem::six_digits(k), s, m);
    if (!command.quiet) print_moment(s, m);
  }
  make_folder(folder);
  tables.write_csv(folder);
  tables.write_hdf5(out);
  out.commit(dem::Durability::kill);
  if (command.quiet) return 0;
  fmt::print("\ntables in {} and, beside it, {}macroscopic_stress.csv, stress_histograms.csv, stresses.h5\n",
             (folder / "particle_stress.csv").string(), tables.has_necks() ? "neck_stress.csv, " : "");
  std::vector<std::filesystem::path> drawn{folder / "stress_histograms.csv", "-o", folder};
  if (const auto history = path.parent_path() / "history.csv"; std::filesystem::exists(history))
    drawn.insert(drawn.end(), {"--history", history});
  if (draw("plot_stresses.py", drawn))
    fmt::print("pictures beside them: particle_stress.png, {}and the same as .svg\n",
               tables.has_necks() ? "neck_stress.png, macroscopic_stress.png " : "");
  return 0;
}

}  // namespace densify::app
