#pragma once
// A pressing with its files: history, fields, checkpoint.

#include <mpi.h>

#include <atomic>
#include <filesystem>
#include <functional>

#include "coupling/press_scene.h"
#include "dem/io/result_folder.h"
#include "dem/run.h"

namespace densify::coupling {

struct PressOptions {
  std::filesystem::path folder;
  dem::Continue mode = dem::Continue::fresh;
  std::function<void(const dem::Progress&)> progress;  ///< on rank 0
  const std::atomic<bool>* stop = nullptr;             ///< ends the run with a checkpoint (Interrupted)
};

/// How a pressing ended.
struct PressSummary {
  fem::PressRow row;
  std::optional<LiveCount> live;  ///< where volume elements live
};

/// Runs a scene to its end in a folder: scene.effective.toml, history.csv (a row a step), fields/ with a .pvd for
/// ParaView, checkpoint.h5.  Collective.  Throws InputError, FileError, RunError (naming the last checkpoint) and
/// Interrupted.
PressSummary run_press(const PressScene&, const PressOptions&, MPI_Comm);

}  // namespace densify::coupling
