#pragma once
// Several realisations of a scene side by side in one process, and their mean.

#include "dem/ensemble_history.h"
#include "dem/run.h"

namespace densify::dem {

/// Where an ensemble stands.
struct EnsembleProgress {
  std::size_t done = 0, running = 0, all = 0;
  double share = 0;         ///< of all process time
  double seconds_left = 0;  ///< wall time, by the rate so far; nan before there is one
};

struct EnsembleOptions {
  std::filesystem::path folder;   ///< of the ensemble; realisation k has a subfolder
  std::filesystem::path packing;  ///< of a perturbed ensemble, a specimen that is packed already; empty: none
  Continue mode = Continue::fresh;
  int threads = 1;  ///< in all: as many realisations at a time, one thread each while there are enough
  std::string version;
  std::function<void(const EnsembleProgress&)> progress;  ///< about four times a second, from the calling thread
  const std::atomic<bool>* stop = nullptr;
};

struct EnsembleSummary {
  std::vector<RunSummary> realisation;  ///< a finished one that is resumed counts only what was left of it
  EnsembleHistory history;
  double wall_seconds = 0;
};

/// Scene of realisation k = 0, 1, ...: with a perturbation its seed plus k, otherwise the seed of the packing plus k;
/// itself a scene with one realisation.
Scene realisation(const Scene&, int k);

/// The subfolder of realisation k: realisation_001 for k = 0.
std::filesystem::path realisation_folder(const std::filesystem::path& ensemble, int k);

/// Runs scene.realisations realisations, each with all its files in its subfolder, and writes history.csv (mean and
/// standard error of every column) and realisations.csv (seeds and last values) of them.  Resuming takes up each where
/// it is, also with more realisations than before.  The first error ends the others at a checkpoint and is thrown, with
/// the realisation named; else as run().
EnsembleSummary run_ensemble(const Scene&, const EnsembleOptions&);

}  // namespace densify::dem
