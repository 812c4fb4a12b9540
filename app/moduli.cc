#include "app/moduli.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "app/moduli_table.h"
#include "app/run.h"
#include "base/check.h"
#include "base/quantity.h"
#include "base/version.h"

namespace densify::app {

namespace {

namespace fs = std::filesystem;

/// The result that the command names; a scene is run first.
fs::path result_file(const ModuliCommand& command) {
  const fs::path given = command.source;
  const bool result = given.extension() == ".h5" || fs::exists(given / "result.h5");
  if (result && !command.overrides.empty())
    throw InputError("--set " + command.overrides.front() + ": " + given.string() +
                     " is a result, which no setting can change; --set goes with a scene");
  if (given.extension() == ".h5") {
    if (!fs::exists(given)) throw InputError(given.string() + ": no such result");
    return given;
  }
  if (fs::is_directory(given)) {
    if (fs::exists(given / "result.h5")) return given / "result.h5";
    if (fs::exists(given / "realisation_001" / "result.h5"))
      throw InputError(given.string() + ": a folder of several realisations; name one of them, " +
                       (given / "realisation_001").string());
    if (!fs::exists(given / "scene.toml"))
      throw InputError(given.string() +
                       ": neither result.h5 nor scene.toml is in this folder; name a result, or a "
                       "scene to run");
  }
  RunCommand run;
  run.scene = command.source;
  run.folder = result_folder(command.source, command.folder).string();
  run.overrides = command.overrides;
  run.threads = command.threads;
  run.quiet = command.quiet;
  if (dem::read_scene(run.scene, run.overrides).realisations > 1)
    throw InputError(command.source + ": the scene has several realisations; run it, then name one of them");
  run_command(run);
  return fs::path(run.folder) / "result.h5";
}

std::vector<dem::StoredMoment> chosen(const std::vector<dem::StoredMoment>& all, const ModuliCommand& command,
                                      const fs::path& file) {
  if (all.empty()) throw InputError(file.string() + ": it holds no snapshot yet");
  if (command.times.empty() && command.densities.empty()) return all;
  std::vector<std::size_t> take;
  auto nearest = [&](auto value, double to) {
    std::size_t best = 0;
    for (std::size_t k = 1; k < all.size(); ++k)
      if (std::abs(value(all[k]) - to) < std::abs(value(all[best]) - to)) best = k;
    take.push_back(best);
  };
  for (const std::string& text : command.times) {
    double time;
    try {
      time = parse_quantity(text, dim::time);
    } catch (const QuantityError& error) {
      throw InputError("--at-time " + text + ": " + error.what());
    }
    if (time < all.front().time || time > all.back().time * (1 + 1e-12))
      throw InputError(fmt::format("--at-time {}: outside the result, whose snapshots go from {:.6g} s to {:.6g} s",
                                   text, all.front().time, all.back().time));
    nearest([](const dem::StoredMoment& m) { return m.time; }, time);
  }
  const auto [least, most] = std::minmax_element(
      all.begin(), all.end(), [](const auto& a, const auto& b) { return a.relative_density < b.relative_density; });
  for (const double density : command.densities) {
    if (!(density >= least->relative_density && density <= most->relative_density))
      throw InputError(fmt::format("--at-density {}: outside the run, whose snapshots go from {:.4f} to {:.4f}",
                                   density, least->relative_density, most->relative_density));
    nearest([](const dem::StoredMoment& m) { return m.relative_density; }, density);
    constexpr double far = 0.01;
    if (const double found = all[take.back()].relative_density; std::abs(found - density) > far && !command.quiet)
      fmt::print(
          "warning: the snapshot nearest to relative density {} has {:.4f}; a shorter output.snapshot_interval "
          "gives nearer ones\n",
          density, found);
  }
  std::sort(take.begin(), take.end());
  take.erase(std::unique(take.begin(), take.end()), take.end());
  std::vector<dem::StoredMoment> moments;
  for (const std::size_t k : take) moments.push_back(all[k]);
  return moments;
}

void print_moment(const dem::SpecimenNetwork& s, const dem::NetworkStructure& n) {
  fmt::print("\n{:.6g} s, {:.1f} K, relative density {:.4f}{}\n", s.time, s.temperature, s.relative_density,
             s.cell.periodic ? "" : " (inner region of the specimen)");
  fmt::print(
      "{} particles, {} contacts ({} with necks), coordination number {:.2f}, {} rattlers, {} held by fewer than "
      "four contacts, {} part{}\n",
      n.particles, n.contacts, n.necks, n.coordination, n.rattlers, n.loose, n.islands, n.islands == 1 ? "" : "s");
}

void print_elastic(const std::string& name, const dem::TensorAnswer& a) {
  auto line = [](const IsotropicPart& p) {
    return fmt::format("E {:9.4g} Pa  nu {:7.4f}  K {:9.4g} Pa  G {:9.4g} Pa  anisotropy {:.3f}", p.youngs, p.poisson,
                       p.bulk, p.shear, p.distance);
  };
  fmt::print("{:<14s} {}  ({} iterations, {:.2f} s)\n{:<14s} {}\n", name,
             a.response.floppy ? "resists nothing: too few contacts hold each particle" : line(a.relaxed),
             a.response.iterations, a.seconds, "  affine", line(a.affine));
  if (std::isfinite(a.soft_modes)) fmt::print("{:<14s} {:.0f} motions without resistance\n", "", a.soft_modes);
}

void print_viscous(const dem::ViscousAnswer& v) {
  auto line = [](const IsotropicPart& p) {
    return fmt::format("bulk {:9.4g} Pa s  shear {:9.4g} Pa s  viscous Poisson's ratio {:7.4f}", p.bulk, p.shear,
                       p.poisson);
  };
  fmt::print(
      "{:<14s} {}  ({} iterations, {:.2f} s)\n{:<14s} {}\n", "viscosity",
      v.viscosity.response.floppy ? "resists nothing: too few contacts hold each particle" : line(v.viscosity.relaxed),
      v.viscosity.response.iterations, v.viscosity.seconds, "  affine", line(v.viscosity.affine));
  const std::string rate =
      std::isfinite(v.densification_rate) ? fmt::format("{:.4g} 1/s", v.densification_rate) : "undefined";
  fmt::print(
      "sintering stress {:.4g} Pa (affine {:.4g} Pa), free densification rate {}; {} contacts flow, {} are held "
      "rigid\n",
      v.sintering_stress.head<3>().mean(), v.affine_sintering_stress.head<3>().mean(), rate, v.flowing, v.rigid);
}

}  // namespace

int moduli_command(const ModuliCommand& command) {
  dem::ModuliSettings settings;
  for (const std::string& name : command.models) settings.models.push_back(dem::neck_model(name));
  settings.tangential = command.tangential;
  settings.tangential_viscosity = command.tangential_viscosity;
  settings.rigid = command.rigid;
  constexpr double soft = 1e-9;
  if (command.soft_modes) settings.soft_share = soft;
  const fs::path path = result_file(command);
  const dem::Hdf5Reader file(path);
  const dem::Scene scene = dem::read_scene_text(file.text("/effective_input"), {});
  if (command.models.empty())  // a viscous contact has no spring
    for (const dem::NeckModel m : dem::all_neck_models)
      if (m != dem::NeckModel::normal_spring || !scene.contact.sintering ||
          scene.contact.sintering->model != dem::SinteringModel::viscous)
        settings.models.push_back(m);

  ResultTable elastic, viscous;
  const bool asked = !command.times.empty() || !command.densities.empty();
  const auto moments = chosen(dem::stored_moments(file), command, path);
  for (const dem::StoredMoment& moment : moments) {
    const dem::SpecimenNetwork s = dem::read_network(file, scene, moment);
    const dem::NetworkStructure structure = dem::structure_of(s);
    try {
      dem::require_percolation(s, structure);
    } catch (const InputError& error) {
      if (asked || &moment == &moments.back()) throw;
      if (!command.quiet) fmt::print("\nleft out: {}\n", error.what());
      continue;
    }
    const auto cells = moment_cells(s, structure);
    if (!command.quiet) print_moment(s, structure);
    auto row = [&](std::vector<ResultTable::Cell> more) {
      more.insert(more.begin(), cells.begin(), cells.end());
      return more;
    };
    for (const dem::NeckModel model : settings.models) {
      const auto a = dem::elastic_answer(s, scene.materials, model, settings);
      elastic.add_row(dem::name_of(model), row(stiffness_cells(a)));
      if (!command.quiet) print_elastic(dem::name_of(model), a);
    }
    if (dem::count_flowing(s) == 0) continue;
    const auto v = dem::viscous_answer(s, settings);
    viscous.add_row(s.stage, row(viscosity_cells(v)));
    if (!command.quiet) print_viscous(v);
  }
  const fs::path folder = command.folder.empty() ? path.parent_path() : fs::path(command.folder);
  std::error_code failure;
  fs::create_directories(folder, failure);
  elastic.write_csv(folder, "moduli", "model");
  dem::Hdf5Writer out(folder / "moduli.h5");
  out.attribute("/", "densify_version", std::string(version()));
  out.attribute("/", "git_revision", std::string(git_revision()));
  elastic.write_hdf5(out, "/elastic", "model");
  if (!viscous.empty()) {
    viscous.write_csv(folder, "viscosities", "stage");
    viscous.write_hdf5(out, "/viscous", "stage");
  }
  out.commit(dem::Durability::kill);
  if (!command.quiet)
    fmt::print("\ntables in {}{}\n", (folder / "moduli.csv").string(),
               viscous.empty() ? " (no contact flows, so that there are no viscosities)" : ", viscosities.csv");
  return 0;
}

}  // namespace densify::app
