#include "app/chosen_result.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "app/run.h"
#include "base/check.h"
#include "base/quantity.h"
#include "dem/io/scene.h"
#include "dem/network/moduli.h"

namespace densify::app {

namespace fs = std::filesystem;

bool is_result(const std::string& source) {
  return fs::path(source).extension() == ".h5" || fs::exists(fs::path(source) / "result.h5");
}

fs::path result_file(const ChosenResult& command) {
  const fs::path given = command.source;
  if (is_result(command.source) && !command.overrides.empty())
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

std::vector<dem::StoredMoment> chosen_moments(const std::vector<dem::StoredMoment>& all, const ChosenResult& command,
                                              const fs::path& file) {
  if (all.empty()) throw InputError(file.string() + ": it holds no snapshot yet");
  if (!command.asked()) return all;
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

std::string why_no_porous_body(const dem::SpecimenNetwork& s) {
  try {
    dem::require_percolation(s, dem::structure_of(s));
  } catch (const InputError& error) {
    return error.what();
  }
  if (s.relative_density < 1) return "";
  return fmt::format("at {:.6g} s the relative density is {:.4f}: no pores are left", s.time, s.relative_density);
}

fs::path table_folder(const ChosenResult& command, const fs::path& file) {
  return command.folder.empty() ? file.parent_path() : fs::path(command.folder);
}

void make_folder(const fs::path& folder) {
  std::error_code failure;  // the first file that cannot be written says why
  fs::create_directories(folder, failure);
}

}  // namespace densify::app
