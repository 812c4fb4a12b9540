#include "dem/specimen.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "base/check.h"
#include "base/nearest.h"
#include "dem/io/atomic_file.h"
#include "dem/io/hdf5_file.h"
#include "dem/io/particle_import.h"
#include "dem/powder/random.h"

namespace densify::dem {

namespace {

std::string formatted(const char* format, double a, double b) {
  char text[200];
  std::snprintf(text, sizeof text, format, a, b);
  return text;
}

std::uint8_t material_index(const Scene& scene, const ImportedParticles& imported, std::size_t p) {
  std::string name = imported.material[p];
  if (scene.import->format == ImportSettings::Format::lammps) {
    const std::size_t type = std::stoul(name);
    if (type < 1 || type > scene.import->types.size())
      throw InputError(imported.file + ":" + std::to_string(imported.line[p]) + ": type " + name +
                       " has no material; specimen.import.types names " + std::to_string(scene.import->types.size()));
    name = scene.import->types[type - 1];
  }
  std::vector<std::string> known;
  for (std::size_t m = 0; m < scene.materials.size(); ++m) {
    if (scene.materials[m].name == name) return std::uint8_t(m);
    known.push_back(scene.materials[m].name);
  }
  throw InputError(imported.file + ":" + std::to_string(imported.line[p]) + ": material \"" + name +
                   "\" is not defined in the scene" + did_you_mean(name, known));
}

ImportedParticles read_import(const Scene& scene) {
  const auto& s = *scene.import;
  if (!std::filesystem::exists(s.file) || std::filesystem::is_directory(s.file))
    throw InputError("specimen.import.file: there is no file " + s.file.string() +
                     "; its path counts from the folder of the scene");
  return s.format == ImportSettings::Format::csv ? read_particle_table(s.file, s.length_unit)
                                                 : read_lammps_data(s.file, s.length_unit);
}

Cell import_cell(const Scene& scene, const ImportedParticles& imported) {
  Cell cell;
  if (scene.container.shape != ContainerShape::periodic) return cell;
  if (!scene.cell_vectors.isZero(0)) {
    cell.h = scene.cell_vectors;
  } else if (imported.box) {
    cell = *imported.box;
  } else {
    throw InputError("specimen: a periodic specimen imported from " + imported.file +
                     " needs its cell; give [specimen.cell] with the edge vectors a, b and c");
  }
  cell.periodic = true;
  return cell;
}

/// How far a sphere's surface is beyond the walls of a container [m]; negative inside.
double beyond_walls(const Container& container, const Vec3& x, double r) {
  const Vec3& size = container.size;
  if (container.shape != ContainerShape::cylinder && container.shape != ContainerShape::box) return -r;
  double beyond = std::max(r - x[2], x[2] + r - size[2]);
  if (container.shape == ContainerShape::cylinder) return std::max(beyond, std::hypot(x[0], x[1]) + r - 0.5 * size[0]);
  for (int axis : {0, 1}) beyond = std::max({beyond, r - x[axis], x[axis] + r - size[axis]});
  return beyond;
}

/// A packing whose particles stick out of the container has not reached its density, whatever their mutual overlaps.
void reject_unpacked(const GreenBody& body, double green_density) {
  constexpr double stuck = 0.5;  // of the radius; what presses against a wall while packing is some per cent of it
  for (std::size_t k = 0; k < body.particles.size(); ++k) {
    const double r = body.particles.reference_radius[k];
    const double beyond = beyond_walls(body.container, body.particles.body[k].position, r);
    if (beyond > stuck * r)
      throw InputError(
          formatted("specimen.packing.green_density: %g is not reachable: particle %.0f", green_density,
                    double(body.particles.id[k])) +
          formatted(" does not fit and stands %.3g um (%.0f %% of its radius)", beyond * 1e6, 100 * beyond / r) +
          " outside the container; lower green_density, give more powder, or a narrower container");
  }
}

GreenBody import_body(const Scene& scene) {
  ImportedParticles imported = read_import(scene);
  GreenBody body;
  body.container = scene.container;
  body.cell = import_cell(scene, imported);
  if (body.cell.periodic)
    for (Vec3& x : imported.position) x = body.cell.wrap(x);
  reject_overlaps(imported, body.cell, scene.import->largest_overlap);
  Particles& p = body.particles;
  for (std::size_t k = 0; k < imported.size(); ++k) {
    const double r = imported.radius[k], beyond = beyond_walls(body.container, imported.position[k], r);
    if (beyond > scene.import->largest_overlap * r)
      throw InputError(imported.file + ":" + std::to_string(imported.line[k]) + ": particle " + std::to_string(k) +
                       " lies " + formatted("%.3g um (%.0f %% of its radius)", beyond * 1e6, 100 * beyond / r) +
                       " outside the container; move it inside or enlarge the container");
    p.body.push_back({imported.position[k], imported.radius[k], Vec3::Zero(), 1});
    p.reference_radius.push_back(imported.radius[k]);
    p.material.push_back(material_index(scene, imported, k));
    p.id.push_back(std::uint32_t(k));
  }
  return body;
}

}  // namespace

PowderSample particles_of(const Scene& scene) {
  if (scene.powder) return draw(*scene.powder);
  PowderSample sample;
  const ImportedParticles imported = read_import(scene);
  for (std::size_t k = 0; k < imported.size(); ++k) {
    sample.diameter.push_back(2 * imported.radius[k]);
    sample.material.push_back(material_index(scene, imported, k));
  }
  return sample;
}

void perturb(GreenBody& body, const PerturbationSettings& perturbation) {
  if (perturbation.size == 0) return;
  Random random(perturbation.seed);
  Particles& p = body.particles;
  std::vector<std::size_t> order(p.size());
  for (std::size_t k = 0; k < order.size(); ++k) order[k] = k;
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return p.id[a] < p.id[b]; });
  for (const std::size_t k : order) {
    for (int axis = 0; axis < 3; ++axis)
      p.body[k].position[axis] += perturbation.size * p.reference_radius[k] * (2 * random.uniform() - 1);
    if (body.cell.periodic) p.body[k].position = body.cell.wrap(p.body[k].position);
  }
}

GreenBody make_specimen(const Scene& scene, int threads, const PackingProgress& progress) {
  if (scene.import) return import_body(scene);
  const PowderSample sample = draw(*scene.powder);
  const PackingSettings settings = scene.packing.value_or(PackingSettings{});
  const CompactionGoal goal{scene.container, settings.green_density, settings.friction, settings.largest_overlap,
                            settings.seed};
  GreenBody body = compact(sample.diameter, sample.material, goal, threads, progress);
  reject_unpacked(body, settings.green_density);
  return body;
}

Setup make_setup(const Scene& scene, const GreenBody& body, int threads) {
  Setup setup{scene.materials,   scene.interfaces, scene.contact, scene.container,
              scene.integration, scene.schedule,   scene.loads,   scene.reference_temperature,
              body.particles,    body.cell};
  setup.container.size = body.container.size;
  // Threads that wait for each other over a handful of particles cost more than they save (27 particles on two busy
  // cores: ten times the time); results do not depend on their number.
  constexpr std::size_t particles_per_thread = 50;
  setup.integration.threads = std::min(threads, 1 + int(body.particles.size() / particles_per_thread));
  setup.cell.velocity_gradient = scene.velocity_gradient;
  setup.cell_path = scene.cell_path;
  setup.energies = scene.output.energies;
  return setup;
}

void write_specimen(const std::filesystem::path& path, const GreenBody& body) {
  Hdf5Writer file(path);
  std::vector<Vec3> position;
  for (const auto& b : body.particles.body) position.push_back(b.position);
  file.table("position", position, "m");
  file.list("radius", body.particles.reference_radius, "m");
  file.list("material", body.particles.material, "");
  file.list("id", body.particles.id, "");
  const Vec3& s = body.container.size;
  file.list("container_size", std::vector<double>(s.data(), s.data() + 3), "m");
  file.list("cell_edges_by_column", std::vector<double>(body.cell.h.data(), body.cell.h.data() + 9), "m");
  file.list("cell_origin", std::vector<double>(body.cell.origin.data(), body.cell.origin.data() + 3), "m");
  file.list("summary",
            std::vector<double>{double(body.cell.periodic), body.relative_density, body.coordination_number,
                                body.mean_overlap, double(body.steps)},
            "");
  file.commit(Durability::power_loss);
}

GreenBody read_specimen(const std::filesystem::path& path) try {
  const Hdf5Reader file(path);
  GreenBody body;
  const auto position = file.read<double>("position");
  body.particles.reference_radius = file.read<double>("radius");
  body.particles.material = file.read<std::uint8_t>("material");
  body.particles.id = file.read<std::uint32_t>("id");
  const auto size = file.read<double>("container_size"), h = file.read<double>("cell_edges_by_column"),
             origin = file.read<double>("cell_origin"), summary = file.read<double>("summary");
  const std::size_t n = body.particles.reference_radius.size();
  if (position.size() != 3 * n || body.particles.material.size() != n || body.particles.id.size() != n ||
      size.size() != 3 || h.size() != 9 || origin.size() != 3 || summary.size() != 5)
    throw InputError(path.string() + " is not a specimen that Densify wrote (its lists differ in length)");
  for (std::size_t p = 0; p < n; ++p)
    body.particles.body.push_back(
        {Eigen::Map<const Vec3>(&position[3 * p]), body.particles.reference_radius[p], Vec3::Zero(), 1});
  body.container.size = Eigen::Map<const Vec3>(size.data());  // the rest of the container is the scene's
  body.cell.h = Eigen::Map<const Mat3>(h.data());
  body.cell.origin = Eigen::Map<const Vec3>(origin.data());
  body.cell.periodic = summary[0] != 0;
  body.relative_density = summary[1];
  body.coordination_number = summary[2];
  body.mean_overlap = summary[3];
  body.steps = std::uint64_t(summary[4]);
  return body;
} catch (const FileError& error) {
  throw InputError(std::string(error.what()) + "; start again without --resume");
}

}  // namespace densify::dem
