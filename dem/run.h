#pragma once
// A whole run of a scene: specimen, process, results, checkpoints.  The only place that knows the result folder.

#include <atomic>
#include <filesystem>
#include <functional>

#include "dem/io/result_folder.h"
#include "dem/measure/measures.h"
#include "dem/specimen.h"

namespace densify::dem {

/// What a progress line needs.
struct Progress {
  std::string stage;            ///< "packing" before the process
  double share = 0;             ///< of the process time, or of the packing
  double time = 0;              ///< process time [s]
  double temperature = 0;       ///< [K]
  double pressure = 0;          ///< [Pa]
  double relative_density = 0;  ///< of the last measure
  double steps_per_second = 0;
  double seconds_left = 0;  ///< wall time, by the rate of process time so far
};

struct RunOptions {
  std::filesystem::path folder;  ///< results; made when absent
  Continue mode = Continue::fresh;
  std::filesystem::path packing;  ///< a specimen to start from instead of packing or importing; empty: none
  int threads = 1;
  std::string version;                            ///< written into the results
  std::function<void(const Progress&)> progress;  ///< called about four times a second; may be empty
  std::function<void(const std::string&)> say;    ///< one line of the log; may be empty
  const std::atomic<bool>* stop = nullptr;        ///< set by a signal: end with a checkpoint
};

/// Where the time of a run went, and what it came to.
struct RunSummary {
  struct Share {
    std::string what;
    double seconds;
  };
  std::vector<Share> shares;
  double wall_seconds = 0;
  double packing_seconds = 0;
  double cpu_seconds = 0;  ///< of the calling thread after the packing: the whole process on one thread
  std::uint64_t steps = 0;
  int threads = 1;  ///< in use: at most those asked for, fewer for few particles
  std::size_t list_builds = 0;
  std::size_t bytes = 0;          ///< of state and scratch
  InertiaFreeCount inertia_free;  ///< steps without inertia and what they took
  std::size_t loosely_held = 0;   ///< at the end, without inertia: floppy but for tangential_share and mass_share
  Measures last;
  double density_error = 0;  ///< estimated, of the last density
  double end_time = 0;       ///< process time [s]
  std::vector<std::string> warnings;
};

/// Runs a scene to its end.  Throws InputError (a folder that holds other results, an unusable checkpoint, a fixed step
/// above the limit), RunError (the cause and the last good checkpoint), FileError, Interrupted.
RunSummary run(const Scene&, const RunOptions&);

/// Fingerprint of what determines the trajectory: the effective input without its output section and title.
std::string fingerprint(const Scene&);

}  // namespace densify::dem
