#pragma once
// What commands on results share: which result, which of its moments, where their tables go.

#include <filesystem>
#include <string>
#include <vector>

#include "dem/network/specimen_network.h"

namespace densify::app {

struct ChosenResult {
  std::string source;                  ///< a result folder, a result.h5, or a scene that is run first
  std::string folder;                  ///< of the tables; empty: that of the result
  std::vector<std::string> times;      ///< with units
  std::vector<double> densities;       ///< relative
  std::vector<std::string> overrides;  ///< of a scene
  int threads = 0;                     ///< of a scene's run
  bool quiet = false;

  /// Moments were named.
  bool asked() const { return !times.empty() || !densities.empty(); }
};

/// Whether a source names a result, and no scene.
bool is_result(const std::string& source);

/// The result that the command names; a scene is run first.
std::filesystem::path result_file(const ChosenResult&);

/// The snapshots nearest to the times and densities, or all.  Throws InputError for what the result `file` does not
/// reach.
std::vector<dem::StoredMoment> chosen_moments(const std::vector<dem::StoredMoment>& all, const ChosenResult&,
                                              const std::filesystem::path& file);

/// Why a moment has no porous body that carries load: no network that spans, no pores left; empty when it has.
std::string why_no_porous_body(const dem::SpecimenNetwork&);

/// The folder of the tables; who writes them makes it, once there is something to write.
std::filesystem::path table_folder(const ChosenResult&, const std::filesystem::path& file);
void make_folder(const std::filesystem::path&);

}  // namespace densify::app
