#include "app/compare_moduli.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "app/command_line.h"
#include "app/comparison_report.h"
#include "app/draw.h"
#include "app/fem_program.h"
#include "app/measured_moduli.h"
#include "app/run.h"
#include "base/check.h"
#include "dem/network/moduli.h"

namespace densify::app {

namespace {

namespace fs = std::filesystem;

/// A result with the moments whose moduli are compared.
struct Body {
  std::string name;
  fs::path file;
  std::vector<dem::Material> materials;
  std::vector<dem::SpecimenNetwork> moments;  // in ascending order of density
  DenseBody dense;
};

/// What the tables call a source: the folder of a result, the name that a scene's results have.
std::string name_of_source(const std::string& source, std::set<std::string>& taken) {
  std::string name = result_folder(source, "").filename().string();
  if (is_result(source)) {
    const fs::path given = fs::absolute(source).lexically_normal();
    name = (given.extension() == ".h5" || !given.has_filename() ? given.parent_path() : given).filename().string();
  }
  for (int again = 2; !taken.insert(name).second; ++again) name = fmt::format("{}_{}", name, again);
  return name;
}

void require_cell(dem::ContainerShape shape, const std::string& source, const CompareCommand& command) {
  if (!command.no_voxels && shape != dem::ContainerShape::periodic)
    throw InputError(source +
                     ": voxel elements need a periodic cell, and this is a specimen between walls or free; leave them "
                     "out with --no-voxels");
}

Body read_body(const CompareCommand& command, const std::string& source, const std::string& name, double temperature) {
  ChosenResult chosen = command;
  chosen.source = source;
  if (!is_result(source)) chosen.folder = (fs::path(command.folder) / name).string();
  Body body{name, result_file(chosen), {}, {}, {}};
  const dem::Hdf5Reader file(body.file);
  const dem::Scene scene = dem::read_scene_text(file.text("/effective_input"), {});
  require_cell(scene.container.shape, body.file.string(), command);
  body.materials = scene.materials;
  std::string why;
  for (dem::StoredMoment moment : chosen_moments(dem::stored_moments(file), chosen, body.file)) {
    moment.temperature = temperature;
    dem::SpecimenNetwork s = dem::read_network(file, scene, moment);
    if (const std::string left_out = why_no_porous_body(s); !left_out.empty()) {
      why = body.file.string() + ": " + left_out;
      if (command.asked()) throw InputError(why);
      if (!command.quiet) fmt::print("left out: {}\n", why);
      continue;
    }
    body.moments.push_back(std::move(s));
  }
  if (body.moments.empty()) throw InputError(why);
  std::stable_sort(body.moments.begin(), body.moments.end(),
                   [](const auto& a, const auto& b) { return a.relative_density < b.relative_density; });
  body.dense.phases = dem::solid_phases(body.moments.front(), body.materials);
  body.dense.strength = 1e6 * command.dense_strength;
  body.dense.strength_exponent = command.strength_exponent;
  return body;
}

/// A solution that fails its checks, as of a nearly floppy network, leaves a point without moduli.
Route by_network(const Body& body, dem::NeckModel model, bool quiet) {
  Route route{body.name, dem::name_of(model), {}};
  dem::ModuliSettings settings;
  for (const dem::SpecimenNetwork& s : body.moments) {
    ModuliPoint p;
    p.relative_density = s.relative_density, p.time = s.time;
    try {
      const dem::TensorAnswer a = dem::elastic_answer(s, body.materials, model, settings);
      p.youngs = a.relaxed.youngs;
      if (!a.response.floppy) p.poisson = a.relaxed.poisson;
    } catch (const RunError& error) {
      if (!quiet)
        fmt::print("warning: {}, {} at relative density {:.4f}, is left out: {}\n", route.result, route.name,
                   s.relative_density, error.what());
    }
    route.points.push_back(p);
  }
  return route;
}

/// The moments that voxels are taken at: those nearest to the densities asked for, or all.
std::vector<const dem::SpecimenNetwork*> voxel_moments(const Body& body, const std::vector<double>& densities) {
  std::set<std::size_t> take;
  for (std::size_t k = 0; densities.empty() && k < body.moments.size(); ++k) take.insert(k);
  for (const double density : densities) {
    const double first = body.moments.front().relative_density, last = body.moments.back().relative_density;
    constexpr double slack = 0.01;  // as far as chosen moments may lie from a density without a warning
    if (!(density >= first - slack && density <= last + slack))
      throw InputError(fmt::format("--voxel-density {}: outside {}, whose chosen snapshots go from {:.4f} to {:.4f}",
                                   density, body.name, first, last));
    std::size_t best = 0;
    for (std::size_t k = 1; k < body.moments.size(); ++k)
      if (std::abs(body.moments[k].relative_density - density) <
          std::abs(body.moments[best].relative_density - density))
        best = k;
    take.insert(best);
  }
  std::vector<const dem::SpecimenNetwork*> moments;
  for (const std::size_t k : take) moments.push_back(&body.moments[k]);
  return moments;
}

/// Empty when the program with the elements failed, which says why itself; its exit code is then in `code`.
Route by_voxels(const Body& body, const CompareCommand& command, double temperature, int& code) {
  const fs::path folder = fs::path(command.folder) / "voxels" / body.name;
  std::vector<std::string> words{body.file.string(),
                                 "--out",
                                 folder.string(),
                                 "--ranks",
                                 std::to_string(command.ranks),
                                 "--temperature",
                                 fmt::format("{} K", temperature)};
  for (const auto* s : voxel_moments(body, command.voxel_densities))
    words.insert(words.end(), {"--at-time", fmt::format("{} s", s->time)});
  for (const int n : command.voxels) words.insert(words.end(), {"--voxels", std::to_string(n)});
  if (command.quiet) words.push_back("--quiet");
  Route route{body.name, "voxels", {}};
  code = run_program(voxel_program, words);
  if (code != 0) return route;
  const dem::Hdf5Reader file(folder / "voxel_moduli.h5");
  auto column = [&](const char* name) { return file.read<double>(std::string("/moduli/") + name); };
  const auto time = column("time"), density = column("relative_density"),
             across = column("coarsest_voxels_across_neck"), e = column("youngs_modulus"),
             e_error = column("youngs_modulus_error"), nu = column("poissons_ratio"),
             nu_error = column("poissons_ratio_error");
  for (std::size_t k = 0; k < time.size(); ++k)
    route.points.push_back(
        {density[k], e[k], nu[k], e_error[k], nu_error[k], ModuliPoint::unknown, time[k], across[k]});
  std::stable_sort(route.points.begin(), route.points.end(),
                   [](const auto& a, const auto& b) { return a.relative_density < b.relative_density; });
  return route;
}

/// sigma_0 of (3.9) that fits measured strengths best in least squares; NaN without any.
double fitted_strength(const Route& measured, double exponent) {
  double product = 0, squares = 0;
  for (const ModuliPoint& p : measured.points) {
    if (!std::isfinite(p.strength)) continue;
    const double ratio = ryshkewitch_strength_ratio(p.relative_density, exponent);
    product += ratio * p.strength, squares += ratio * ratio;
  }
  return product / squares;
}

}  // namespace

void add_comparison_options(CLI::App& app, CompareCommand& command) {
  app.add_option("RESULT", command.sources, "Folders of results, result.h5 files, or scenes, which are run first")
      ->required();
  app.add_option("--out", command.folder, "Folder of the tables and of what scenes make")->required();
  add_moments(app, command);
  app.add_option("--model", command.models,
                 "Contact model: normal_spring, bonded_neck, neck_beam or series; again for each; without it all")
      ->take_all();
  app.add_option("--temperature", command.temperature,
                 "Of the bodies when their moduli are taken; without it 20 degC, that of ultrasonic measurements");
  app.add_option("--measured", command.measured, "A table of measured moduli and strengths (doc/compare_moduli.md)");
  app.add_flag("--no-voxels", command.no_voxels, "Leave voxel elements out");
  app.add_option("--voxels", command.voxels, "Voxels along the longest edge, again for each; without it 32, 48, 64")
      ->check(CLI::Range(4, 512))
      ->take_all();
  app.add_option("--voxel-density", command.voxel_densities,
                 "Voxel elements at the chosen snapshot nearest to this density alone; again for each")
      ->take_all();
  app.add_option("--ranks", command.ranks, "Processes of the voxel elements")->check(CLI::Range(1, 4096));
  app.add_option("--dense-strength", command.dense_strength,
                 "Strength of the dense body [MPa]; without it the one that fits measured strengths")
      ->check(CLI::PositiveNumber);
  app.add_option("--strength-exponent", command.strength_exponent,
                 "q of the strength exp(-q porosity); without it 11 (NiAl-Al2O3)")
      ->check(CLI::Range(0.0, 100.0));
}

int compare_command(const CompareCommand& command) {
  // Everything that can be refused is refused before the first run.
  const double temperature = parsed_temperature(command.temperature);
  std::vector<dem::NeckModel> models;
  for (const std::string& name : command.models) models.push_back(dem::neck_model(name));
  if (!command.no_voxels)
    require_program(voxel_program, "compare-moduli with voxel elements", "; or leave them out with --no-voxels");
  Route measured;
  if (!command.measured.empty()) measured = read_measured_moduli(command.measured);
  std::set<std::string> taken;
  std::vector<std::string> names;
  for (const std::string& source : command.sources) {
    if (!is_result(source) && !fs::exists(fs::path(source) / "realisation_001"))
      require_cell(dem::read_scene(source, command.overrides).container.shape, source, command);
    names.push_back(name_of_source(source, taken));
  }
  std::vector<Body> bodies;
  for (std::size_t k = 0; k < names.size(); ++k) {
    bodies.push_back(read_body(command, command.sources[k], names[k], temperature));
    if (!std::isfinite(command.dense_strength))
      bodies.back().dense.strength = fitted_strength(measured, command.strength_exponent);
    if (!command.no_voxels) voxel_moments(bodies.back(), command.voxel_densities);
  }

  ResultTable comparison({"result", "route"}), curves({"result"}), deviations({"result", "route", "reference"});
  std::vector<Deviation> all;
  auto compare = [&](const Route& route, const DenseBody& dense) {
    add_comparison(comparison, route, dense);
    for (Deviation& d : deviations_from_curves(route, dense)) all.push_back(std::move(d));
  };
  if (!measured.points.empty()) compare(measured, bodies.front().dense);
  for (const Body& body : bodies) {
    add_curves(curves, body.name, body.dense);
    std::vector<Route> routes;
    const auto springless = [&](dem::NeckModel m) {
      return m == dem::NeckModel::normal_spring && std::isinf(body.moments.front().network.edges.front().law.stiffness);
    };
    for (const dem::NeckModel model : dem::all_neck_models) {
      const bool named = std::find(models.begin(), models.end(), model) != models.end();
      if (models.empty() ? springless(model) : !named) continue;
      routes.push_back(by_network(body, model, command.quiet));
    }
    if (!command.no_voxels) {
      int code = 0;
      routes.push_back(by_voxels(body, command, temperature, code));
      if (code != 0) return code;
    }
    if (!command.quiet) print_comparison(body.name, body.dense, routes);
    for (const Route& route : routes) {
      compare(route, body.dense);
      if (!command.no_voxels && route.name != "voxels") all.push_back(deviation_from(route, routes.back()));
      if (!measured.points.empty()) all.push_back(deviation_from(route, measured));
    }
  }
  for (const Deviation& d : all) add_deviation(deviations, d);
  const fs::path folder = command.folder;
  make_folder(folder);
  comparison.write_csv(folder, "comparison");
  curves.write_csv(folder, "curves");
  deviations.write_csv(folder, "deviations");
  if (command.quiet) return 0;
  print_deviations(all);
  fmt::print("\ntables in {} and, beside it, curves.csv, deviations.csv\n", (folder / "comparison.csv").string());
  if (draw("plot_moduli.py", {folder / "comparison.csv"}))
    fmt::print("pictures beside them: comparison.png, comparison.svg\n");
  return 0;
}

}  // namespace densify::app
