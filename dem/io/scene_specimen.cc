// [specimen] and [walls]: what holds the powder, and where its particles come from.

#include <Eigen/LU>
#include <limits>

#include "dem/io/scene_parts.h"

namespace densify::dem {
namespace {

constexpr std::int64_t largest_seed = std::numeric_limits<std::int64_t>::max();
constexpr std::array<double, 3> unset_vector{unset, unset, unset};

Vec3 to_vector(const std::array<double, 3>& a) {
  return {a[0], a[1], a[2]};
}

// With a powder the height follows from the packing, so that only a base is given.
void read_size(Section& section, Container& container, bool powder) {
  const bool documenting = section.documenting();
  const ContainerShape shape = container.shape;
  if (documenting || shape == ContainerShape::cylinder) {
    double diameter = unset;
    double height = unset;
    section.quantity("diameter", diameter, dim::length, Range::positive(), Need::required,
                     "cylinder: inner diameter of the die, whose axis is x = y = 0 and whose bottom z = 0");
    if (documenting || !powder) {
      section.quantity("height", height, dim::length, Range::positive(), Need::required,
                       "cylinder with an import: from the bottom to the punch at the start");
    } else {
      refuse_keys(section, {"height"}, "the height of a powder specimen follows from packing.green_density; remove it");
    }
    container.size = Vec3(diameter, diameter, powder ? 0 : height);
  } else {
    refuse_keys(section, {"diameter", "height"}, "belongs to shape = \"cylinder\"; remove it");
  }
  if (documenting || shape == ContainerShape::box) {
    std::vector<double> size;
    section.quantity_list("size", size, dim::length, Range::positive(), Need::required,
                          "box from the origin: two edges of the base, with an import also the height");
    const std::size_t due = powder ? 2 : 3;
    if (!documenting && size.size() != due) {
      section.fail("size", powder ? "expected the two edges of the base (the height follows from "
                                    "packing.green_density), found " +
                                        std::to_string(size.size())
                                  : "expected three edges, found " + std::to_string(size.size()));
    }
    size.resize(3, 0.0);
    container.size = Vec3(size[0], size[1], size[2]);
  } else {
    refuse_keys(section, {"size"}, "belongs to shape = \"box\"; remove it");
  }
  if (documenting || (shape == ContainerShape::periodic && powder)) {
    std::vector<double> proportions{1.0, 1.0, 1.0};
    section.quantity_list("proportions", proportions, dim::none, Range::positive(), Need::optional,
                          "periodic with a powder: edges of the cell relative to each other");
    if (proportions.size() != 3) {
      section.fail("proportions", "expected three numbers, found " + std::to_string(proportions.size()));
    }
    container.size = Vec3(proportions[0], proportions[1], proportions[2]);
  } else {
    refuse_keys(section, {"proportions"}, "belongs to shape = \"periodic\" with a [[powder]]; remove it");
  }
}

void read_packing(Section& section, PackingSettings& packing, ContainerShape shape) {
  const PackingMethod fitting =
      shape == ContainerShape::periodic ? PackingMethod::isotropic_compression : PackingMethod::gravity_compaction;
  packing.method = fitting;
  section.choice("method", packing.method,
                 {{"gravity_compaction", PackingMethod::gravity_compaction},
                  {"isotropic_compression", PackingMethod::isotropic_compression}},
                 Need::optional, "gravity and moving walls (cylinder, box), or a shrinking periodic cell (App. C)");
  if (packing.method != fitting) {
    section.fail("method", fitting == PackingMethod::gravity_compaction
                               ? "a cylinder or box is packed by \"gravity_compaction\""
                               : "a periodic cell is packed by \"isotropic_compression\"");
  }
  section.quantity("green_density", packing.green_density, dim::none, Range::inside(0.0, 1.0), Need::optional,
                   "relative density of the finished specimen");
  section.quantity("friction", packing.friction, dim::none, Range::non_negative(), Need::optional,
                   "mu while packing; 0 packs densest");
  section.quantity("largest_overlap", packing.largest_overlap, dim::none, Range::inside(0.0, 1.0), Need::optional,
                   "mean overlap over mean radius above which the green density counts as unreachable");
  section.integer("seed", packing.seed, 0, largest_seed, Need::optional, "of the random placement");
}

void read_import(Section& section, ImportSettings& import, const Scene& scene) {
  std::string file;
  section.text("file", file, Need::required, "table or LAMMPS data file, seen from the folder of the scene");
  import.file = section.directory() / file;
  section.choice("format", import.format,
                 {{"csv", ImportSettings::Format::csv}, {"lammps", ImportSettings::Format::lammps}}, Need::optional,
                 "table with columns x, y, z, radius, material, or LAMMPS data file of atom style sphere");
  section.quantity("length_unit", import.length_unit, dim::length, Range::positive(), Need::optional,
                   "length of one unit of the file");
  if (section.documenting() || import.format == ImportSettings::Format::lammps) {
    section.text_list("types", import.types, Need::required, "lammps: materials of type 1, 2, ...");
    for (const std::string& name : import.types) material_index(section, "types", name, scene);
  } else {
    refuse_keys(section, {"types"}, "belongs to format = \"lammps\"; a table names its materials in each line");
  }
  section.quantity("largest_overlap", import.largest_overlap, dim::none,
                   Range{0.0, 1.0, Bound::inclusive, Bound::exclusive}, Need::optional,
                   "overlap over the smaller radius that is still accepted");
}

void read_cell(Section& section, Scene& scene) {
  std::array<double, 3> a = unset_vector, b = unset_vector, c = unset_vector;
  section.vector3("a", a, dim::length, Need::optional, "first edge vector, for an import; a LAMMPS box if absent");
  section.vector3("b", b, dim::length, Need::optional, "second edge vector");
  section.vector3("c", c, dim::length, Need::optional, "third edge vector");
  if (section.has("a") || section.has("b") || section.has("c")) {
    for (const std::string_view key : {"a", "b", "c"}) {
      if (!section.has(key)) section.fail(key, "missing; give all three edge vectors a, b, c or none");
    }
    scene.cell_vectors << to_vector(a), to_vector(b), to_vector(c);
    const double box = scene.cell_vectors.colwise().norm().prod();
    constexpr double flat = 1e-6;
    if (!(std::abs(scene.cell_vectors.determinant()) > flat * box)) {
      section.fail("c", "the three edge vectors lie in one plane; the cell has no volume");
    }
  }
  section.section(
      "velocity_gradient", Need::optional, "prescribed deformation of the cell, dh/dt = L h", [&](Section& below) {
        std::array<double, 3> x{}, y{}, z{};
        below.vector3("x", x, dim::rate, Need::optional, "row dv_x / d(x, y, z)");
        below.vector3("y", y, dim::rate, Need::optional, "row dv_y / d(x, y, z)");
        below.vector3("z", z, dim::rate, Need::optional, "row dv_z / d(x, y, z)");
        scene.velocity_gradient << to_vector(x).transpose(), to_vector(y).transpose(), to_vector(z).transpose();
      });
}

}  // namespace

void read_specimen(Section& root, Scene& scene, ScenePlaces& places) {
  root.section("specimen", Need::required, "where the particles are at the start", [&](Section& section) {
    places.specimen = section;
    // Without an import a powder is taken for granted, so that a misspelt [[powder]] is found as an unknown key.
    const bool powder = !section.has("import");
    Container& container = scene.container;
    section.choice("shape", container.shape,
                   {{"cylinder", ContainerShape::cylinder},
                    {"box", ContainerShape::box},
                    {"periodic", ContainerShape::periodic},
                    {"free", ContainerShape::free}},
                   Need::required, "what holds the particles");
    if (powder) {
      std::uint64_t seed = 1;
      section.integer("seed", seed, 0, largest_seed, Need::optional,
                      "of the order in which sizes and materials are mixed");
      if (scene.powder) scene.powder->seed = seed;
      section.section("packing", Need::defaulted, "how a powder becomes a green body (App. C)", [&](Section& below) {
        places.packing = below;
        read_packing(below, scene.packing.emplace(), container.shape);
      });
    } else {
      refuse_keys(section, {"packing", "seed"}, "belongs to a [[powder]]; imported particles stay where they are");
      if (scene.powder) section.fail("import", "there is a [[powder]] already; give either a powder or an import");
    }
    section.section("import", Need::optional, "particles from a file instead of a [[powder]]", [&](Section& below) {
      places.import = below;
      read_import(below, scene.import.emplace(), scene);
    });
    section.section("perturbation", Need::defaulted, "random shifts of the finished specimen", [&](Section& below) {
      places.perturbation = below;
      below.quantity("size", scene.perturbation.size, dim::none, Range{0.0, 0.1, Bound::inclusive, Bound::inclusive},
                     Need::optional,
                     "largest shift along each axis over the radius of the particle; 1e-3 changes the "
                     "trajectory and not the packing");
      below.integer("seed", scene.perturbation.seed, 0, largest_seed, Need::optional, "of the shifts");
    });
    read_size(section, container, powder);
    section.section("cell", Need::optional, "the periodic cell", [&](Section& below) {
      places.cell = below;
      read_cell(below, scene);
    });
  });
}

void read_walls(Section& root, Scene& scene, ScenePlaces& places) {
  Container& container = scene.container;
  const bool walled = container.shape == ContainerShape::cylinder || container.shape == ContainerShape::box;
  if (!walled) refuse_keys(root, {"walls"}, "a free or periodic specimen has no walls; remove this section");
  root.section(
      "walls", walled ? Need::defaulted : Need::optional, "rigid walls of a cylinder or box: Hertz, friction, no necks",
      [&](Section& section) {
        places.walls = section;
        section.quantity("youngs_modulus", container.material.youngs_modulus, dim::pressure, Range::positive(),
                         Need::optional, "E of the walls in (4.20); undeformable if absent");
        section.quantity("poissons_ratio", container.material.poissons_ratio, dim::none, Range::inside(-1.0, 0.5),
                         Need::optional, "nu of the walls; goes with youngs_modulus");
        section.quantity("thermal_expansion", container.wall_expansion, dim::thermal_expansion, Range::any(),
                         Need::optional, "linear coefficient of the lateral walls");
        section.section("punch", Need::defaulted, "the upper wall", [&](Section& below) {
          enum class Control { pressure, fixed } control = Control::pressure;
          below.choice("control", control, {{"pressure", Control::pressure}, {"fixed", Control::fixed}}, Need::optional,
                       "moves under the pressure of the process, or stands still");
          container.punch = control == Control::pressure;
          below.quantity(
              "mass_fraction", container.punch_settings.mass_fraction, dim::none, Range::positive(), Need::optional,
              "fictitious mass of the punch over the scaled mass of the powder, at least that of its mean particle");
          below.quantity("damping_ratio", container.punch_settings.damping_ratio, dim::none, Range::non_negative(),
                         Need::optional, "of the critical damping against the contacts of the punch");
        });
      });
}

}  // namespace densify::dem
