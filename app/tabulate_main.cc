// densify tabulate: from the volume element of a scene to its response table; densify starts this program.

#include <fmt/core.h>

#include <algorithm>
#include <thread>

#include "app/command_line.h"
#include "app/progress_line.h"
#include "base/check.h"
#include "coupling/press_scene.h"

namespace {

using namespace densify;
namespace fs = std::filesystem;

/// Where the table of a scene goes: the file that it names, or one beside the scene.
fs::path target_of(const coupling::PressScene& scene, const std::string& out) {
  if (!out.empty()) return out;
  return scene.table.empty() ? scene.file.parent_path() / "table.h5" : scene.table;
}

void print_branch(const coupling::SinteringBranch& b) {
  const auto &first = b.nodes.front(), &last = b.nodes.back();
  double viscosity = 0, stress = 0;
  for (const auto& n : b.nodes) {
    viscosity += n.viscosity_scatter / double(b.nodes.size());
    stress += n.sintering_stress_scatter / double(b.nodes.size());
  }
  fmt::print(
      "{:<12s} x {:<5g} densities {:.4f} to {:.4f}, axial viscosity {:.3g} to {:.3g} Pa s, sintering stress {:.3g} to "
      "{:.3g} MPa; one element scatters by {:.1f} % and {:.1f} %\n",
      b.path, b.pressure_factor, first.density, last.density, first.viscosity[1], last.viscosity[1],
      1e-6 * first.sintering_stress[1], 1e-6 * last.sintering_stress[1], 100 * viscosity, 100 * stress);
}

void print_table(const coupling::ResponseTable& t, const fs::path& file) {
  fmt::print("{} of {} particles, {} elements\n", t.material, t.particles, t.elements);
  fmt::print("loose        densities {:.4f} to {:.4f}, axial pressure {:.3g} to {:.3g} MPa\n", t.cold.front().density,
             t.cold.back().density, 1e-6 * t.cold.front().axial, 1e-6 * t.cold.back().axial);
  for (const auto& b : t.sintering) print_branch(b);
  fmt::print(
      "beside a path that is not in it (pressure x {:.3g}, heating x {:g}): relative density off by up to {:.4f} "
      "while loose, by {:.4f} from then on\n",
      t.check.pressure_factor, t.check.heating_factor, t.check.loose_error, t.check.error);
  fmt::print("\ntable in {}\n", file.string());
}

int run_main(int argc, char** argv) {
  std::string scene_name, out;
  std::vector<std::string> overrides;
  int threads = int(std::max(1u, std::thread::hardware_concurrency()));
  bool quiet = false;
  CLI::App command{"Make a response table of the volume element of a scene."};
  command.name("densify tabulate");
  command.footer(app::exit_codes);
  command.add_option("SCENE", scene_name, "A scene file with [press] and [rve], or a folder that holds scene.toml")
      ->required();
  command.add_option("--out", out, "The table; without it press.table.file of the scene, or table.h5 beside it");
  command.add_option("--set", overrides, "path.to.key=value, again for each")->take_all();
  command.add_option("--threads", threads, "Paths at a time; without it one a core")->check(CLI::Range(1, 1024));
  command.add_flag("--quiet", quiet, "No progress, no summary");
  try {
    command.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return command.exit(error) == 0 ? 0 : 2;
  }
  const coupling::PressScene scene = coupling::read_press_scene(scene_name, overrides);
  if (!scene.element)
    throw InputError(scene.file.string() + ": has no volume element [rve] to make a table of; see help-scene --press");
  app::ProgressLine line(quiet);
  coupling::TableOptions options;
  options.threads = threads;
  options.stop = &app::catch_signals();
  options.progress = [&](const coupling::TableProgress& p) {
    line.show_count("paths", p.done, p.all, p.share, dem::unset);
  };
  try {
    coupling::ResponseTable table = coupling::tabulate(*scene.element, scene.table_settings, options);
    table.scene = scene.effective_text;
    const fs::path file = target_of(scene, out);
    if (file.has_parent_path()) fs::create_directories(file.parent_path());
    coupling::write_table(file, table);
    line.end();
    if (!quiet) print_table(table, file);
  } catch (...) {
    line.end();
    throw;
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  return densify::app::guarded([&] { return run_main(argc, argv); });
}
