#pragma once
// densify trade: what each setting of a scene costs, and how far its results are from the converged ones.

#include <string>
#include <vector>

namespace densify::app {

struct TradeCommand {
  std::string scene;
  std::string folder;
  std::string ladder;                  ///< a file; empty: the built-in ladder
  std::vector<std::string> overrides;  ///< path.to.key=value, of all rungs
  int realisations = 0;                ///< 0: as the ladder says
  int threads = 0;                     ///< runs at a time, one thread each; 0: one a core
  bool resume = false;
  bool quiet = false;
};

/// Returns the exit code; errors are thrown.
int trade_command(const TradeCommand&);

}  // namespace densify::app
