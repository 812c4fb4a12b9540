#include "app/moduli.h"

#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "app/moduli_table.h"
#include "app/progress_line.h"
#include "base/check.h"
#include "base/version.h"

namespace densify::app {

namespace {

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
  const std::filesystem::path path = result_file(command);
  const dem::Hdf5Reader file(path);
  const dem::Scene scene = dem::read_scene_text(file.text("/effective_input"), {});
  if (command.models.empty())  // a viscous contact has no spring
    for (const dem::NeckModel m : dem::all_neck_models)
      if (m != dem::NeckModel::normal_spring || !scene.contact.sintering ||
          scene.contact.sintering->model != dem::SinteringModel::viscous)
        settings.models.push_back(m);

  ProgressLine progress(command.quiet);
  std::string solving;
  // Only what takes long is shown; the error falls by powers of ten.
  auto start = std::chrono::steady_clock::now();
  auto begin = [&](const std::string& what) { solving = what, start = std::chrono::steady_clock::now(); };
  settings.watch = [&](double error) {
    constexpr double long_time = 2;  // [s]
    if (std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count() < long_time) return;
    progress.show_solution(solving, std::clamp(std::log(error) / std::log(settings.balance), 0.0, 1.0));
  };
  ResultTable elastic({"model"}), viscous({"stage"});
  const auto moments = chosen_moments(dem::stored_moments(file), command, path);
  for (const dem::StoredMoment& moment : moments) {
    const dem::SpecimenNetwork s = dem::read_network(file, scene, moment);
    const dem::NetworkStructure structure = dem::structure_of(s);
    try {
      dem::require_percolation(s, structure);
    } catch (const InputError& error) {
      if (command.asked() || &moment == &moments.back()) throw;
      if (!command.quiet) fmt::print("\nleft out: {}\n", error.what());
      continue;
    }
    const auto cells = moment_cells(s, structure);
    if (!command.quiet) print_moment(s, structure);
    auto row = [&](std::vector<ResultTable::Cell> more) {
      more.insert(more.begin(), cells.begin(), cells.end());
      return more;
    };
    // A network that its springs hardly hold fails its checks; others of the same moment may be good.
    auto attempt = [&](const std::string& name, const auto& solve) {
      begin(name);
      try {
        solve();
      } catch (const RunError& error) {
        progress.end();
        if (!command.quiet)
          fmt::print("warning: {} at relative density {:.4f} is nan: {}\n", name, s.relative_density, error.what());
      }
    };
    for (const dem::NeckModel model : settings.models) {
      const std::string name = dem::name_of(model);
      dem::TensorAnswer a = dem::unknown_elastic_answer();
      attempt(name, [&] {
        a = dem::elastic_answer(s, scene.materials, model, settings);
        progress.end();
        if (!command.quiet) print_elastic(name, a);
      });
      elastic.add_row({name}, row(stiffness_cells(a)));
    }
    if (dem::count_flowing(s) == 0) continue;
    dem::ViscousAnswer v = dem::unknown_viscous_answer(s, settings);
    attempt("viscosity", [&] {
      v = dem::viscous_answer(s, settings);
      progress.end();
      if (!command.quiet) print_viscous(v);
    });
    viscous.add_row({s.stage}, row(viscosity_cells(v)));
  }
  const std::filesystem::path folder = table_folder(command, path);
  make_folder(folder);
  elastic.write_csv(folder, "moduli");
  dem::Hdf5Writer out(folder / "moduli.h5");
  out.attribute("/", "densify_version", std::string(version()));
  out.attribute("/", "git_revision", std::string(git_revision()));
  elastic.write_hdf5(out, "/elastic");
  if (!viscous.empty()) {
    viscous.write_csv(folder, "viscosities");
    viscous.write_hdf5(out, "/viscous");
  }
  out.commit(dem::Durability::kill);
  if (!command.quiet)
    fmt::print("\ntables in {}{}\n", (folder / "moduli.csv").string(),
               viscous.empty() ? " (no contact flows, so that there are no viscosities)" : ", viscosities.csv");
  return 0;
}

}  // namespace densify::app
