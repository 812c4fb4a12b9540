// densify run of a scene with [press]: the program with deal.II and PETSc; densify starts it.

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "app/mpi_main.h"
#include "app/progress_line.h"
#include "app/run.h"
#include "base/check.h"
#include "coupling/press_case.h"

namespace {

using namespace densify;

void print_summary(const coupling::PressScene& scene, const coupling::PressSummary& summary,
                   const std::filesystem::path& folder) {
  const fem::PressRow& r = summary.row;
  const double radius = std::sqrt(r.volume / (std::numbers::pi * r.height));
  fmt::print("\nrelative density {:.4f} +- {:.4f} numerical, from {:.4f} to {:.4f} in the body\n", r.density.mean,
             r.density_error, r.density.least, r.density.most);
  fmt::print("height {:.4f} mm, mean diameter {:.4f} mm, punch travel {:.4f} mm\n", 1e3 * r.height, 2e3 * radius,
             1e3 * r.travel);
  fmt::print(
      "work of punch and die {:.4g} J = {:.4g} J dissipated in the body + {:.4g} J by friction at the wall "
      "{:+.4g} J on thermal strains {:+.4g} J stored, off by {:.2g} %\n",
      r.work, r.dissipated, r.slid, r.thermal, r.stored,
      100 * std::abs(r.work - r.dissipated - r.slid - r.thermal - r.stored) /
          std::max({std::abs(r.work), std::abs(r.dissipated), std::abs(r.thermal), 1e-300}));
  fmt::print("{} steps ({} rejected), {} Newton iterations\n", r.steps, r.rejected, r.iterations);
  if (const auto& live = summary.live)
    fmt::print(
        "{} volume elements, {:.2f} MB each: {} steps, {} linear systems, in {} solutions of the body; stresses off "
        "their "
        "laws by at most {:.2g} of the largest, work of contacts off that of stresses by {:.2g}, shears that were "
        "dropped {:.2g}\n",
        live->elements, 1e-6 * double(live->bytes) / double(live->elements), live->steps, live->solutions, live->rounds,
        live->largest_mismatch, live->mismatch_work / std::max(live->contact_work, 1e-300), live->dropped_stress);
  fmt::print("warnings: {}\n", scene.warnings.empty() ? "none" : std::to_string(scene.warnings.size()));
  for (const auto& w : scene.warnings) fmt::print("  {}\n", w);
  fmt::print("\nresults in {}\n", folder.string());
}

void print_check(const coupling::PressScene& scene) {
  const auto& s = scene.size;
  const bool plane = scene.geometry == coupling::PressGeometry::axisymmetric;
  fmt::print("{}\n", scene.title);
  fmt::print("specimen                        {:.4g} mm x {:.4g} mm, {}\n", 2e3 * s.radius, 1e3 * s.height,
             scene.coupling == coupling::Coupling::live ? "of live volume elements"
                                                        : fmt::format("relative density {:.4g}", scene.density));
  fmt::print("elements                        {} of degree {}, {}\n", fem::element_count(s, plane ? 2 : 3),
             scene.settings.degree, plane ? "a body of revolution" : "a quarter in three dimensions");
  fmt::print("process                         {:.4g} s in {} stages, then {:.4g} s of ejection\n",
             scene.schedule->end(), scene.schedule->stages().size(), scene.press.ejection_time);
  if (scene.settings.punches == fem::Punches::both)
    fmt::print("punches                         both come into the die\n");
  for (const auto& w : scene.warnings) fmt::print("warning: {}\n", w);
  fmt::print("the scene is valid\n");
}

int run_main(int argc, char** argv) {
  app::RunCommand run;
  bool help_scene = false, check = false;
  CLI::App command{"Press a whole specimen by finite elements."};
  command.name("densify run");
  command.footer(app::exit_codes);
  auto* scene_option =
      command.add_option("SCENE", run.scene, "A scene file with [press], or a folder that holds scene.toml");
  command.add_option("--out", run.folder, "Folder of the results; without it results/NAME");
  command.add_option("--set", run.overrides, "path.to.key=value, again for each")->take_all();
  command.add_flag("--resume", run.resume, "Continue from the checkpoint in the folder of the results");
  command.add_flag("--quiet", run.quiet, "No progress, no summary");
  command.add_flag("--check", check, "Say what the scene comes to; run nothing");
  command.add_flag("--help-scene", help_scene, "Every key of such a scene");
  const bool first = app::speaks();
  if (const int code = app::parse_on_all(command, argc, argv); code >= 0) return code;
  if (help_scene) {
    if (first) std::fputs(coupling::press_scene_help().c_str(), stdout);
    return 0;
  }
  if (scene_option->count() == 0) throw InputError("SCENE is required");
  const coupling::PressScene scene = coupling::read_press_scene(run.scene, run.overrides);
  if (check) {
    if (first) print_check(scene);
    return 0;
  }
  app::ProgressLine line(run.quiet || !first);
  coupling::PressOptions options;
  options.folder = app::result_folder(run.scene, run.folder);
  options.mode = run.resume ? dem::Continue::resume : dem::Continue::fresh;
  options.progress = [&](const dem::Progress& p) { line.show(p); };
  options.stop = &app::catch_signals();
  try {
    const coupling::PressSummary last = coupling::run_press(scene, options, MPI_COMM_WORLD);
    line.end();
    if (first && !run.quiet) print_summary(scene, last, options.folder);
  } catch (...) {
    line.end();
    throw;
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  return densify::app::mpi_main(argv, [&] { return run_main(argc, argv); });
}
