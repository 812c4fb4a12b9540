#include "app/voxel_moduli.h"

#include <fmt/core.h>
#include <sys/resource.h>

#include <algorithm>
#include <cmath>

#include "app/result_table.h"
#include "base/check.h"
#include "base/elastic_tensor.h"
#include "base/version.h"
#include "coupling/packing_voxels.h"
#include "dem/network/moduli.h"
#include "fem/boolean_spheres.h"
#include "fem/resolution.h"

namespace densify::app {

namespace {

using Cells = std::vector<ResultTable::Cell>;

/// One body in voxels, ready to be solved.
struct Body {
  fem::VoxelImage image;
  double drawn_fraction;  ///< of the spheres before they were grown; NaN when that means nothing
  double growth;          ///< over the width of a voxel; NaN likewise
};

/// Moduli of one body at all resolutions.
class Study {
 public:
  Study(const VoxelCommand& command, MPI_Comm comm) : command_(command), comm_(comm) {
    MPI_Comm_rank(comm, &rank_);
    MPI_Comm_size(comm, &ranks_);
  }

  bool speaks() const { return rank_ == 0 && !command_.quiet; }
  bool writes() const { return rank_ == 0; }
  int ranks() const { return ranks_; }

  /// `draw(n)` gives the body, `cells` the columns that come first; returns the extrapolated E and nu.
  template <class Draw>
  std::array<fem::Extrapolated, 2> add(const std::string& name, const Cells& cells,
                                       const std::vector<fem::ElasticSolid>& solids, Draw draw) {
    std::array<std::vector<double>, 4> values;
    for (const int n : command_.voxels) {
      Body body = draw(n);
      const double wanted = body.image.solid_fraction();
      const fem::LooseVoxels loose = remove_loose(body.image);
      if (!loose.spans)
        throw InputError(
            fmt::format("{}: at {} voxels no part of the solid spans the cell in three directions, so that it "
                        "resists nothing; take more voxels or a denser packing",
                        name, n));
      fem::VoxelSettings settings;
      settings.tolerance = command_.tolerance;
      const fem::VoxelAnswer a = voxel_stiffness(body.image, solids, settings, comm_);
      const IsotropicPart p = isotropic_part(a.stiffness);
      for (const auto& [k, value] : {std::pair{0, p.youngs}, {1, p.poisson}, {2, p.bulk}, {3, p.shear}})
        values[std::size_t(k)].push_back(value);
      if (speaks())
        fmt::print(
            "  {:>4d} voxels  E {:9.4g} Pa  nu {:7.4f}  K {:9.4g} Pa  G {:9.4g} Pa  anisotropy {:.3f}  ({} "
            "elements, {} iterations, {:.1f} s)\n",
            n, p.youngs, p.poisson, p.bulk, p.shear, p.distance, a.elements, a.iterations, a.seconds);
      Cells row = cells;
      row.insert(row.end(), {{"voxels", "1", double(n)},
                             {"solid_fraction", "1", wanted},
                             {"drawn_fraction", "1", body.drawn_fraction},
                             {"growth_in_voxels", "1", body.growth},
                             {"loose_fraction", "1", double(loose.removed) / double(body.image.size())},
                             {"youngs_modulus", "Pa", p.youngs},
                             {"poissons_ratio", "1", p.poisson},
                             {"bulk_modulus", "Pa", p.bulk},
                             {"shear_modulus", "Pa", p.shear},
                             {"anisotropy", "1", p.distance}});
      for (int i = 0; i < 6; ++i)
        for (int j = i; j < 6; ++j) row.push_back({fmt::format("C_{}{}", i + 1, j + 1), "Pa", a.stiffness(i, j)});
      row.insert(row.end(), {{"asymmetry", "1", a.asymmetry},
                             {"power_mismatch", "1", a.power_mismatch},
                             {"iterations", "1", double(a.iterations)},
                             {"ranks", "1", double(ranks_)},
                             {"solution_time", "s", a.seconds},
                             {"peak_memory_of_all_ranks", "B", peak_memory()}});
      resolutions_.add_row({name}, row);
    }
    Cells row = cells;
    std::array<fem::Extrapolated, 4> limit;
    const char* const names[] = {"youngs_modulus", "poissons_ratio", "bulk_modulus", "shear_modulus"};
    for (std::size_t k = 0; k < 4; ++k) {
      limit[k] = fem::extrapolate(command_.voxels, values[k]);
      const char* unit = k == 1 ? "1" : "Pa";
      row.push_back({names[k], unit, limit[k].value});
      row.push_back({std::string(names[k]) + "_error", unit, limit[k].error});
    }
    limits_.add_row({name}, row);
    if (speaks())
      fmt::print("   infinitely  E {:9.4g} +- {:.2g} Pa  nu {:7.4f} +- {:.4f}\n", limit[0].value, limit[0].error,
                 limit[1].value, limit[1].error);
    return {limit[0], limit[1]};
  }

  /// After every body, so that a later one takes nothing away.
  void write(const std::filesystem::path& folder) const {
    if (!writes()) return;
    make_folder(folder);
    resolutions_.write_csv(folder, "voxel_resolutions");
    limits_.write_csv(folder, "voxel_moduli");
    dem::Hdf5Writer out(folder / "voxel_moduli.h5");
    out.attribute("/", "densify_version", std::string(version()));
    out.attribute("/", "git_revision", std::string(git_revision()));
    resolutions_.write_hdf5(out, "/resolutions");
    limits_.write_hdf5(out, "/moduli");
    out.commit(dem::Durability::kill);
  }
  void say_where(const std::filesystem::path& folder) const {
    if (speaks())
      fmt::print("\ntables in {} and, beside it, voxel_resolutions.csv, voxel_moduli.h5\n",
                 (folder / "voxel_moduli.csv").string());
  }

 private:
  double peak_memory() const {
    rusage use{};
    getrusage(RUSAGE_SELF, &use);
    double bytes = 1024.0 * double(use.ru_maxrss);
    MPI_Allreduce(MPI_IN_PLACE, &bytes, 1, MPI_DOUBLE, MPI_SUM, comm_);
    return bytes;
  }

  const VoxelCommand& command_;
  MPI_Comm comm_;
  int rank_, ranks_;
  ResultTable resolutions_{std::vector<std::string>{"body"}}, limits_{std::vector<std::string>{"body"}};
};

Body grown(const fem::LevelSet& level, const dem::SpecimenNetwork& s, int n, bool pores) {
  const double shift = level.shift_for(s.relative_density);
  const double width = s.cell.h.colwise().norm().maxCoeff() / n;
  return {pores ? level.complement(shift) : level.body(shift), pores ? 1 - level.fraction(0) : level.fraction(0),
          shift / width};
}

void study_result(const VoxelCommand& command, Study& study) {
  if (study.ranks() > 1 && !is_result(command.source))
    throw InputError(command.source + ": several ranks take a result that is there; run the scene first");
  const std::filesystem::path path = result_file(command);
  const dem::Hdf5Reader file(path);
  const dem::Scene scene = dem::read_scene_text(file.text("/effective_input"), {});
  if (scene.container.shape != dem::ContainerShape::periodic)
    throw InputError(path.string() +
                     ": voxel elements need a periodic cell, and this is a specimen between walls or free; "
                     "densify moduli takes the inner region of one between walls");
  // All moments are looked at before the first is solved.
  std::vector<dem::SpecimenNetwork> bodies;
  std::string why;
  for (const dem::StoredMoment& moment : chosen_moments(dem::stored_moments(file), command, path)) {
    bodies.push_back(dem::read_network(file, scene, moment));
    if (std::isfinite(command.temperature)) bodies.back().temperature = command.temperature;
    const std::string left_out = why_no_porous_body(bodies.back());
    if (left_out.empty()) continue;
    if (command.asked()) throw InputError(left_out);
    why = left_out;
    bodies.pop_back();
    if (study.speaks()) fmt::print("left out: {}\n", left_out);
  }
  if (bodies.empty()) throw InputError(why);
  for (const dem::SpecimenNetwork& s : bodies) {
    auto solids = coupling::elastic_solids(scene.materials, s.temperature);
    if (command.pores) {
      const std::uint8_t m = s.material.front();
      if (std::any_of(s.material.begin(), s.material.end(), [&](auto k) { return k != m; }))
        throw InputError(path.string() + ": --pores takes a packing of one material");
      solids = {solids[m]};
    }
    if (study.speaks()) {
      fmt::print("\n{:.6g} s, {:.1f} K, relative density {:.4f}\n", s.time, s.temperature, s.relative_density);
      constexpr double fewest = 4;
      const double across = coupling::voxels_across_neck(s, command.voxels.front());
      if (!command.pores && !(across >= fewest))
        fmt::print("warning: the mean neck is {:.1f} voxels wide at {} voxels, fewer than 4: too coarse to trust\n",
                   across, command.voxels.front());
    }
    study.add(fmt::format("{:.6g} s", s.time),
              {{"time", "s", s.time},
               {"temperature", "K", s.temperature},
               {"relative_density", "1", s.relative_density},
               {"coarsest_voxels_across_neck", "1", coupling::voxels_across_neck(s, command.voxels.front())}},
              solids, [&](int n) { return grown(coupling::packing_level_set(s, n), s, n, command.pores); });
    study.write(table_folder(command, path));
  }
  study.say_where(table_folder(command, path));
}

void study_spheres(const VoxelCommand& command, Study& study) {
  const auto model = command.spheres == "solid" ? fem::BooleanModel::solid_spheres : fem::BooleanModel::spherical_pores;
  const std::vector<fem::ElasticSolid> solids{{command.youngs_modulus, command.poissons_ratio}};
  for (const double fraction : command.fractions) {
    std::vector<double> youngs, poisson;
    for (int seed = 1; seed <= command.realisations; ++seed) {
      if (study.speaks())
        fmt::print("\n{} spheres, solid fraction {}, realisation {}\n", command.spheres, fraction, seed);
      const auto [e, nu] = study.add(
          command.spheres, {{"relative_density", "1", fraction}, {"seed", "1", double(seed)}}, solids, [&](int n) {
            return Body{boolean_spheres(model, fraction, command.box, n, unsigned(seed)), std::nan(""), std::nan("")};
          });
      study.write(command.folder);
      youngs.push_back(e.value);
      poisson.push_back(nu.value);
    }
    auto line = [](const char* name, const std::vector<double>& v) {
      double sum = 0, squares = 0;
      for (const double x : v) sum += x / double(v.size());
      for (const double x : v) squares += (x - sum) * (x - sum);
      return fmt::format("{} {:.4f} +- {:.4f}", name, sum,
                         std::sqrt(squares / double(v.size() - 1) / double(v.size())));
    };
    if (study.speaks() && command.realisations > 1)
      fmt::print("\n{} spheres, solid fraction {}: {}, {} (standard error of {} realisations)\n", command.spheres,
                 fraction, line("E", youngs), line("nu", poisson), command.realisations);
  }
  study.say_where(command.folder);
}

}  // namespace

int voxel_command(const VoxelCommand& given, MPI_Comm comm) {
  VoxelCommand command = given;
  std::sort(command.voxels.begin(), command.voxels.end());
  command.voxels.erase(std::unique(command.voxels.begin(), command.voxels.end()), command.voxels.end());
  Study study(command, comm);
  if (command.spheres.empty() == command.source.empty())
    throw InputError("voxel-moduli takes a RESULT or --spheres, one of the two");
  if (!command.spheres.empty()) {
    if (command.fractions.empty()) throw InputError("--spheres needs --solid-fraction, e.g. --solid-fraction 0.7");
    if (command.folder.empty()) throw InputError("--spheres needs --out, a folder for the tables");
    if (command.asked() || command.pores || !command.overrides.empty() || std::isfinite(command.temperature))
      throw InputError("--spheres takes no moments, no --pores, no --temperature and no --set: these go with a RESULT");
    study_spheres(command, study);
  } else {
    if (!command.fractions.empty())
      throw InputError("--solid-fraction goes with --spheres; a RESULT has its own density");
    study_result(command, study);
  }
  return 0;
}

}  // namespace densify::app
