#include "dem/ensemble.h"

#include <chrono>
#include <cmath>
#include <condition_variable>
#include <cstdio>
#include <exception>
#include <limits>
#include <mutex>
#include <sstream>
#include <thread>

#include "base/check.h"
#include "dem/io/atomic_file.h"
#include "dem/io/result_folder.h"

namespace densify::dem {

namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// The realisations of one ensemble, handed out to threads in order.
class Ensemble {
 public:
  Ensemble(const Scene& scene, const EnsembleOptions& options)
      : scene_(scene),
        options_(options),
        n_(std::size_t(scene.realisations)),
        share_(n_, 0.0),
        summary_(n_),
        workers_(std::min(n_, std::size_t(std::max(1, options.threads)))) {}

  std::vector<RunSummary> run_all(const fs::path& packing);

 private:
  void work(const fs::path& packing);
  void run_one(std::size_t k, const fs::path& packing);
  void stop_with(std::exception_ptr);
  EnsembleProgress progress() const;

  const Scene& scene_;
  const EnsembleOptions& options_;
  const std::size_t n_;
  const Clock::time_point start_ = Clock::now();
  mutable std::mutex mutex_;  // of all that follows
  std::condition_variable ended_;
  std::size_t next_ = 0, done_ = 0, working_ = 0;
  std::vector<double> share_;
  double first_share_ = -1;  // where this call took up the ensemble
  std::vector<RunSummary> summary_;
  std::exception_ptr error_;
  bool interrupted_ = false;
  std::atomic<bool> stop_{false};
  const std::size_t workers_;
};

void Ensemble::stop_with(std::exception_ptr error) {
  const std::lock_guard lock(mutex_);
  if (!error_) error_ = std::move(error);
  stop_ = true;
}

void Ensemble::run_one(std::size_t k, const fs::path& packing) {
  const Scene scene = realisation(scene_, int(k));
  RunOptions options;
  options.folder = realisation_folder(options_.folder, int(k));
  options.packing = packing;
  options.threads = std::max(1, options_.threads / int(workers_));
  options.version = options_.version;
  options.stop = &stop_;
  options.mode = options_.mode;
  if (options.mode == Continue::resume && !fs::exists(options.folder / "checkpoint.h5")) {
    fs::remove_all(options.folder);  // of one that had not begun
    options.mode = Continue::fresh;
  }
  options.progress = [&](const Progress& p) {
    const std::lock_guard lock(mutex_);
    share_[k] = p.stage == "packing" ? 0 : p.share;
  };
  RunSummary summary = run(scene, options);
  const std::lock_guard lock(mutex_);
  summary_[k] = std::move(summary);
  share_[k] = 1;
  ++done_;
}

void Ensemble::work(const fs::path& packing) {
  while (true) {
    std::size_t k = 0;
    {
      const std::lock_guard lock(mutex_);
      if (next_ == n_ || stop_) break;
      k = next_++;
    }
    const std::string who = "realisation " + std::to_string(k + 1) + ": ";
    try {
      run_one(k, packing);
    } catch (const InputError& e) {
      stop_with(std::make_exception_ptr(InputError(who + e.what())));
    } catch (const RunError& e) {
      stop_with(std::make_exception_ptr(RunError(who + e.what())));
    } catch (const FileError& e) {
      stop_with(std::make_exception_ptr(FileError(who + e.what())));
    } catch (const Interrupted&) {  // by stop_, whose cause is known
    } catch (...) {
      stop_with(std::current_exception());
    }
  }
  const std::lock_guard lock(mutex_);
  --working_;
  ended_.notify_all();
}

EnsembleProgress Ensemble::progress() const {
  EnsembleProgress p;
  p.all = n_;
  p.done = done_;
  p.running = std::min(next_, n_) - done_;
  for (const double s : share_) p.share += s / double(n_);
  const double gained = p.share - std::max(0.0, first_share_);
  p.seconds_left = gained > 0 ? seconds_since(start_) * (1 - p.share) / gained : unset;
  return p;
}

std::vector<RunSummary> Ensemble::run_all(const fs::path& packing) {
  working_ = workers_;
  std::vector<std::thread> threads;
  for (std::size_t w = 0; w < workers_; ++w) threads.emplace_back([this, &packing] { work(packing); });
  {
    std::unique_lock lock(mutex_);
    auto last = Clock::now();
    while (working_ > 0) {
      ended_.wait_for(lock, std::chrono::milliseconds(50));
      if (options_.stop && *options_.stop && !stop_) {
        stop_ = true;
        interrupted_ = true;
      }
      if (seconds_since(last) < 0.25) continue;
      last = Clock::now();
      const EnsembleProgress now = progress();
      if (first_share_ < 0 && now.share > 0) first_share_ = now.share;
      if (!options_.progress) continue;
      lock.unlock();
      options_.progress(now);
      lock.lock();
    }
  }
  for (auto& t : threads) t.join();
  if (error_) std::rethrow_exception(error_);
  if (interrupted_) {
    bool begun = false;
    for (std::size_t k = 0; k < n_; ++k)
      begun = begun || fs::exists(realisation_folder(options_.folder, int(k)) / "checkpoint.h5");
    throw Interrupted(begun ? "interrupted; every realisation that had begun has a checkpoint, continue with --resume "
                              "--out " +
                                  options_.folder.string()
                            : "interrupted while packing; there is nothing to resume yet, start the run again");
  }
  return std::move(summary_);
}

/// The specimen that all perturbations start from, packed once; nothing for an ensemble of packings.
fs::path shared_packing(const Scene& scene, const EnsembleOptions& options) {
  if (scene.perturbation.size == 0 || !scene.powder) return {};
  if (!options.packing.empty()) return options.packing;
  const fs::path path = options.folder / "packing.h5";
  if (fs::exists(path)) return path;
  write_specimen(
      path, make_specimen(scene, options.threads, [&](double) {
        if (options.stop && *options.stop)
          throw Interrupted("interrupted while packing; there is nothing to resume yet, start the run again");
      }));
  return path;
}

std::string realisation_table(const Scene& scene, const std::vector<History>& histories) {
  std::ostringstream out;
  out.precision(std::numeric_limits<double>::max_digits10);
  out << "realisation,folder,packing_seed,perturbation_seed";
  for (const auto& c : histories.front().columns) out << ',' << c;
  out << '\n';
  for (std::size_t k = 0; k < histories.size(); ++k) {
    const Scene one = realisation(scene, int(k));
    out << k + 1 << ',' << realisation_folder("", int(k)).string() << ',' << (one.packing ? one.packing->seed : 0)
        << ',' << one.perturbation.seed;
    for (const auto& column : histories[k].values) out << ',' << column.back();
    out << '\n';
  }
  return out.str();
}

}  // namespace

Scene realisation(const Scene& scene, int k) {
  const auto counted = [k](std::uint64_t seed) { return std::to_string(seed + std::uint64_t(k)); };
  std::vector<std::string> overrides{"realisations=1"};
  if (scene.perturbation.size > 0)
    overrides.push_back("specimen.perturbation.seed=" + counted(scene.perturbation.seed));
  else if (scene.packing)
    overrides.push_back("specimen.packing.seed=" + counted(scene.packing->seed));
  return with_overrides(scene, overrides);
}

fs::path realisation_folder(const fs::path& ensemble, int k) {
  char name[40];
  std::snprintf(name, sizeof name, "realisation_%03d", k + 1);
  return ensemble / name;
}

EnsembleSummary run_ensemble(const Scene& scene, const EnsembleOptions& options) {
  const auto start = Clock::now();
  ResultFolder folder(options.folder, options.mode, {realisation_folder("", 0).string(), "packing.h5"});
  EnsembleSummary summary;
  try {
    const fs::path packing = shared_packing(scene, options);
    summary.realisation = Ensemble(scene, options).run_all(packing);
  } catch (...) {
    folder.abandon();  // leaves no empty folder behind; one with files stays
    throw;
  }
  std::vector<History> histories;
  double end = scene.schedule.end();
  for (int k = 0; k < scene.realisations; ++k) {
    histories.push_back(read_history(realisation_folder(options.folder, k) / "history.csv"));
    end = std::min(end, histories.back().values[0].back());  // with stop_when, that of the first to stop
  }
  const double asked = scene.output.history_interval;
  summary.history =
      average(histories, common_times(scene.schedule, std::isnan(asked) ? scene.schedule.end() / 400 : asked, end));
  write_ensemble_history(options.folder / "history.csv", summary.history);
  write_atomically(options.folder / "realisations.csv", {realisation_table(scene, histories)}, Durability::kill);
  summary.wall_seconds = seconds_since(start);
  return summary;
}

}  // namespace densify::dem
