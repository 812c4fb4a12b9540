#pragma once
// What `densify trade` compares: rungs, each a set of overrides of one scene.

#include <filesystem>
#include <string>
#include <vector>

#include "dem/io/scene.h"

namespace densify::app {

/// One setting.
struct Rung {
  std::string name;
  std::vector<std::string> set;  ///< overrides "path.to.key=value"; an empty value removes the key
  std::string family;            ///< rungs that differ in one size alone; empty: in none
  double size = dem::unset;      ///< of a step, a mass factor, ...: what goes to zero in its family
  bool converged = false;        ///< the rung that errors are counted from
};

struct Ladder {
  int realisations = 4;
  std::vector<std::string> set;  ///< of all rungs, before their own
  std::vector<double> times;     ///< besides the ends of stages, at which densities are compared [s]
  std::vector<Rung> rungs;       ///< exactly one is converged
};

/// Reads a ladder.  Throws InputError with file, line and key.
Ladder read_ladder(const std::filesystem::path&);
Ladder read_ladder_text(std::string_view text);

/// The ladder of a scene without one of its own: mass factor, step safety, Maxwell update, linear or Hertz, number of
/// particles, around the scene's own setting; converged is a tenth of its mass factor.
Ladder built_in_ladder(const dem::Scene&);

/// Every key of a ladder with unit, range, default and meaning.
std::string ladder_help();

}  // namespace densify::app
