#pragma once
// What a scene file says, as plain data in SI: from the TOML text to the pieces a Simulation is made of.

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "dem/io/material_library.h"
#include "dem/powder/powder.h"
#include "dem/simulation.h"

namespace densify::dem {

/// How loose particles become a green body (thesis App. C).
enum class PackingMethod : std::uint8_t {
  gravity_compaction,    ///< sub-grid placement, then gravity and walls moving to the final container
  isotropic_compression  ///< sub-grid placement in a periodic cell, shrunk to the target density
};

struct PackingSettings {
  PackingMethod method = PackingMethod::gravity_compaction;
  double green_density = 0.60;    ///< relative density of the finished specimen
  double friction = 0;            ///< between particles while packing
  double largest_overlap = 0.02;  ///< mean overlap over mean radius above which the density counts as unreachable
  std::uint64_t seed = 1;         ///< of the placement
};

/// Particles from a file instead of a powder.
struct ImportSettings {
  std::filesystem::path file;  ///< seen from where the program runs
  enum class Format : std::uint8_t { csv, lammps } format = Format::csv;
  double length_unit = 1;          ///< metres per unit of the file [m]
  std::vector<std::string> types;  ///< material name of LAMMPS type 1, 2, ...
  double largest_overlap = 0.05;   ///< overlap over the smaller radius that is still accepted
};

/// Random shifts of the finished specimen: the same packing with another chaos.
struct PerturbationSettings {
  double size = 0;         ///< largest shift along each axis over the radius of the particle
  std::uint64_t seed = 1;  ///< of the shifts
};

struct OutputSettings {
  double history_interval = unset;   ///< process time between rows [s]; unset: 1/400 of the process
  double snapshot_interval = unset;  ///< [s]; unset: at the ends of stages only
  double checkpoint_interval = 60;   ///< wall time between checkpoints [s]
  bool visualisation = true;         ///< ParaView files with every snapshot
  bool energies = false;             ///< of a driven cell, in the history
  bool stress_fields = false;        ///< in them, the stresses in particles and necks with their parts
};

/// When a run ends before its schedule does.
enum class StopWhen : std::uint8_t { schedule_ends, all_necks_at_equilibrium };

struct Scene {
  std::string title;
  std::vector<Material> materials;
  std::vector<Calibration> calibrations;  ///< of the materials
  std::vector<Interface> interfaces;
  ContactModel contact;
  Container container;  ///< with a powder: size has the base (periodic: its proportions), height from the packing
  Mat3 cell_vectors = Mat3::Zero();        ///< periodic: edge vectors in columns [m]; zero: from packing or import
  Mat3 velocity_gradient = Mat3::Zero();   ///< periodic [1/s]
  std::optional<CellPath> cell_path;       ///< periodic, where the process drives the cell
  std::optional<Powder> powder;            ///< exactly one of powder and import
  std::optional<PackingSettings> packing;  ///< with a powder
  std::optional<ImportSettings> import;
  PerturbationSettings perturbation;
  int realisations = 1;  ///< runs side by side: other packings, or other perturbations of one specimen
  IntegrationSettings integration;
  Schedule schedule{293.15, 0.0, {{"", 1.0, 293.15, 0.0}}};
  std::vector<Load> loads;
  double reference_temperature = 293.15;  ///< [K]
  StopWhen stop_when = StopWhen::schedule_ends;
  OutputSettings output;

  std::filesystem::path file;  ///< where it was read, empty for text
  std::string effective_text;  ///< TOML with every key in use; reads back to the same scene

  /// Keys that only packing and the first step can find at fault, each with its "file:line: key".
  std::vector<std::pair<std::string, std::string>> places;
  /// The message with the place in front when it begins with such a key.
  std::string placed(const std::string& message) const;
};

/// A line for each material whose diffusion was fitted to another kind of specimen than that of the scene, of the given
/// diameter or edge [m]; none for a scene without sintering.
std::vector<std::string> calibration_warnings(const Scene&, double size);

/// Reads and checks a scene (a file, or a folder that holds scene.toml); overrides are "path.to.key=value".
/// Throws InputError with file, line and key; FileError when the file or the shipped materials cannot be read.
Scene read_scene(const std::filesystem::path&, const std::vector<std::string>& overrides);

/// The same scene with other values; its file stays the place that messages name.
Scene with_overrides(const Scene&, const std::vector<std::string>& overrides);

/// The same from text, for tests.
Scene read_scene_text(std::string_view text, const std::vector<std::string>& overrides);

/// Every key with unit, range, default and meaning, from the declarations that validate.
std::string scene_help();

}  // namespace densify::dem
