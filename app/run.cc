#include "app/run.h"

#include <fmt/core.h>

#include <cmath>
#include <cstdio>
#include <thread>

#include "app/progress_line.h"
#include "base/check.h"
#include "base/scene_document.h"
#include "base/version.h"
#include "dem/ensemble.h"

namespace densify::app {

namespace {

namespace fs = std::filesystem;

void print_summary(const dem::RunSummary& s, const fs::path& folder) {
  const dem::Measures& m = s.last;
  fmt::print("\nrelative density {:.4f} +- {:.4f} numerical", m.relative_density, s.density_error);
  if (std::isfinite(m.relative_density_inner)) fmt::print(" (inner {:.4f})", m.relative_density_inner);
  fmt::print(", coordination number {:.2f}", m.coordination_number);
  if (m.mean_neck_radius > 0)
    fmt::print(", mean neck radius {:.3g} um, {:.0f} % of the necks at equilibrium", m.mean_neck_radius * 1e6,
               100 * m.equilibrium_fraction);
  fmt::print("\n\n{:<28s}{:>10s}{:>8s}\n", "where the time went", "s", "%");
  for (const auto& share : s.shares)
    fmt::print("{:<28s}{:>10.2f}{:>8.1f}\n", share.what, share.seconds, 100 * share.seconds / s.wall_seconds);
  fmt::print("{:<28s}{:>10.2f}{:>8.1f}\n", "total", s.wall_seconds, 100.0);
  fmt::print("{} steps on {} thread{}, {} neighbour list builds, {:.1f} MB of state\n", s.steps, s.threads,
             s.threads == 1 ? "" : "s", s.list_builds, double(s.bytes) * 1e-6);
  if (const auto& c = s.inertia_free; c.steps > 0)
    fmt::print("{} of them without inertia ({} trials rejected): {} linear systems, {} iterations\n", c.steps,
               c.rejected, c.solutions, c.iterations);
  if (s.loosely_held > 0)
    fmt::print(
        "floppy at the end: {} particles with fewer than four contacts to others of four, which only "
        "tangential_share and mass_share hold\n",
        s.loosely_held);
  fmt::print("warnings: {}\n", s.warnings.empty() ? "none" : std::to_string(s.warnings.size()));
  for (const auto& w : s.warnings) fmt::print("  {}\n", w);
  fmt::print("\nresults in {}\n", folder.string());
}

/// The mean of the last row, and what the arrangement of the particles makes of it.
void print_ensemble(const dem::EnsembleSummary& s, const dem::Scene& scene, const fs::path& folder) {
  const dem::EnsembleHistory& h = s.history;
  const double n = double(h.realisations);
  const bool perturbed = scene.perturbation.size > 0;
  auto last = [&](const dem::History& part, const char* column) {
    return part.values[dem::column_index(part, column)].back();
  };
  auto line = [&](const char* label, const char* column, const std::string& numerical) {
    const double error = last(h.standard_error, column);
    fmt::print("{} {:.4f}{} +- {:.4f} from the {} (from one to the next +- {:.4f})\n", label, last(h.mean, column),
               numerical, error, perturbed ? "perturbation" : "particle arrangement", error * std::sqrt(n));
  };
  fmt::print("\n{} realisations ({}), mean and standard error:\n", h.realisations,
             perturbed ? "perturbations of one specimen" : "particle arrangements");
  line("relative density", "relative_density",
       fmt::format(" +- {:.4f} numerical", last(h.mean, "relative_density_bias")));
  line("coordination number", "coordination_number", "");
  std::uint64_t steps = 0;
  double cpu = 0, packing = 0;
  std::size_t bytes = 0, warnings = 0;
  for (const auto& r : s.realisation) {
    steps += r.steps;
    cpu += r.cpu_seconds;
    packing += r.packing_seconds;
    bytes += r.bytes;
    warnings += r.warnings.size();
  }
  fmt::print("{:.2f} s; {} steps in {:.2f} s of processor time after {:.2f} s of packing, {:.1f} MB of state in all\n",
             s.wall_seconds, steps, cpu, packing, double(bytes) * 1e-6);
  fmt::print("warnings: {}\n", warnings == 0 ? "none" : std::to_string(warnings));
  for (std::size_t k = 0; k < s.realisation.size(); ++k)
    for (const auto& w : s.realisation[k].warnings) fmt::print("  realisation {}: {}\n", k + 1, w);
  fmt::print("\nresults in {}\n", folder.string());
}

int run_realisations(const dem::Scene& scene, const RunCommand& command, const fs::path& folder) {
  ProgressLine line(command.quiet);
  dem::EnsembleOptions options;
  options.folder = folder;
  options.mode = command.resume ? dem::Continue::resume : dem::Continue::fresh;
  options.threads = command.threads > 0 ? command.threads : int(std::max(1u, std::thread::hardware_concurrency()));
  options.version = std::string(version());
  options.progress = [&](const dem::EnsembleProgress& p) {
    line.show_count("realisations", p.done, p.all, p.share, p.seconds_left);
  };
  options.stop = &catch_signals();
  try {
    const dem::EnsembleSummary summary = dem::run_ensemble(scene, options);
    line.end();
    if (!command.quiet) print_ensemble(summary, scene, folder);
  } catch (...) {
    line.end();
    throw;
  }
  return 0;
}

}  // namespace

fs::path result_folder(const std::string& scene, const std::string& folder) {
  if (!folder.empty()) return folder;
  const fs::path given = fs::path(scene).lexically_normal();
  const bool is_folder = fs::is_directory(given);
  const fs::path file = is_folder ? given / "scene.toml" : given;
  std::string name =
      is_folder ? (given.has_filename() ? given : given.parent_path()).filename().string() : file.stem().string();
  if (!is_folder && name != "scene" && file.has_parent_path())
    name = file.parent_path().filename().string() + "_" + name;
  else if (name == "scene")
    name = fs::absolute(file).parent_path().filename().string();
  return fs::path("results") / name;
}

bool is_press_scene(const std::string& scene) {
  const fs::path file = fs::is_directory(scene) ? fs::path(scene) / "scene.toml" : fs::path(scene);
  return SceneDocument::from_file(file, {}).root().has("press");
}

int run_command(const RunCommand& command) {
  if (command.ranks > 0)
    throw InputError("--ranks: only a scene with [press] runs on several processes; take --threads");
  const dem::Scene scene = dem::read_scene(command.scene, command.overrides);
  const fs::path folder = result_folder(command.scene, command.folder);
  if (scene.realisations > 1) return run_realisations(scene, command, folder);
  ProgressLine line(command.quiet);
  dem::RunOptions options;
  options.folder = folder;
  options.mode = command.resume ? dem::Continue::resume : dem::Continue::fresh;
  options.threads = std::max(1, command.threads);
  options.version = std::string(version());
  options.progress = [&](const dem::Progress& p) { line.show(p); };
  options.say = [&](const std::string& text) { line.say(text); };
  options.stop = &catch_signals();
  try {
    const dem::RunSummary summary = dem::run(scene, options);
    line.end();
    if (!command.quiet) print_summary(summary, folder);
  } catch (...) {
    line.end();
    throw;
  }
  return 0;
}

}  // namespace densify::app
