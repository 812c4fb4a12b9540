#pragma once
// densify check: everything that can be said of a scene without running it.

#include <string>
#include <vector>

namespace densify::app {

struct CheckCommand {
  std::string scene;
  std::vector<std::string> overrides;  ///< path.to.key=value
  int threads = 1;
};

/// Prints memory, critical step, number of steps and expected time; errors are thrown.
int check_command(const CheckCommand&);

}  // namespace densify::app
