#pragma once
// The runs of a ladder, side by side, each kept on disk as soon as it has ended.

#include <atomic>
#include <functional>

#include "app/trade_table.h"

namespace densify::app {

struct TradeJobs {
  std::filesystem::path folder;
  std::vector<std::vector<dem::Scene>> scenes;  ///< scenes[r][k]: realisation k of rung r
  int threads = 1;
  std::string version;
  const std::atomic<bool>* stop = nullptr;
  std::function<void(std::size_t done, std::size_t all, double share, double seconds_left)> progress;  ///< may be empty
};

/// Runs what is not on disk yet; every packing is made once and shared by the rungs that start from it.  A run that a
/// guard stops is a result with a failure.  Throws InputError (a packing or step that is not possible), FileError,
/// Interrupted; finished runs stay on disk.
std::vector<std::vector<TradeRun>> run_jobs(const TradeJobs&);

}  // namespace densify::app
