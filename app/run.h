#pragma once
// densify run: a scene from the command line, with progress, signals and a summary.

#include <filesystem>
#include <string>
#include <vector>

namespace densify::app {

struct RunCommand {
  std::string scene;
  std::string folder;                  ///< empty: results/NAME
  std::vector<std::string> overrides;  ///< path.to.key=value
  int threads = 0;                     ///< 0: one, or with several realisations one a core
  int ranks = 0;                       ///< processes of a press scene; 0: not given
  bool resume = false;
  bool quiet = false;
};

/// Where the results of a scene go: `folder`, or results/NAME when that is empty.
std::filesystem::path result_folder(const std::string& scene, const std::string& folder);

/// Whether a scene file has a table [press], which another program runs.  Throws as reading any scene does.
bool is_press_scene(const std::string& scene);

/// Returns the exit code; errors are thrown.
int run_command(const RunCommand&);

}  // namespace densify::app
