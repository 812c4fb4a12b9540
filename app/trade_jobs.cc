#include "app/trade_jobs.h"

#include <fmt/core.h>

#include <chrono>
#include <condition_variable>
#include <fstream>
#include <map>
#include <mutex>
#include <sstream>
#include <thread>

#include "base/check.h"
#include "dem/io/atomic_file.h"
#include "dem/run.h"
#include "dem/specimen.h"

namespace densify::app {

namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

/// What a packing depends on: materials, powder and specimen of the effective input, without the perturbation.
std::string packing_key(const dem::Scene& scene) {
  std::uint64_t hash = 14695981039346656037ull;  // FNV-1a
  std::istringstream lines(scene.effective_text);
  bool counts = false;
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("["))
      counts = (line.starts_with("[materials") || line.starts_with("[[powder") || line.starts_with("[powder") ||
                line.starts_with("[specimen")) &&
               !line.starts_with("[specimen.perturbation");
    if (!counts) continue;
    for (const unsigned char c : line + "\n") hash = (hash ^ c) * 1099511628211ull;
  }
  return fmt::format("{:016x}", hash);
}

struct Job {
  const dem::Scene* scene;
  fs::path folder;
  TradeRun* run;
};

/// The record of a finished run: numbers that the history does not have; the scene's fingerprint says whose it is.
constexpr const char* record_name = "run.txt";

bool read_record(const Job& job) {
  std::ifstream file(job.folder / record_name);
  std::string fingerprint, failure;
  TradeRun run;
  if (!(file >> fingerprint >> run.wall >> run.cpu >> run.steps >> run.bytes)) return false;
  if (fingerprint != dem::fingerprint(*job.scene)) return false;
  std::getline(file, failure);
  std::getline(file, run.failure);
  run.history = dem::read_history(job.folder / "history.csv");
  *job.run = std::move(run);
  return true;
}

void write_record(const Job& job) {
  const TradeRun& r = *job.run;
  const std::string text =
      fmt::format("{} {} {} {} {}\n{}\n", dem::fingerprint(*job.scene), r.wall, r.cpu, r.steps, r.bytes, r.failure);
  dem::write_atomically(job.folder / record_name, {text}, dem::Durability::kill);
}

class Workers {
 public:
  Workers(const TradeJobs& jobs, std::vector<Job> due, std::size_t all)
      : jobs_(jobs), due_(std::move(due)), all_(all), share_(due_.size(), 0.0) {}

  void run_all();

 private:
  void work();
  void run_one(std::size_t k);
  fs::path packing(const dem::Scene&);

  const TradeJobs& jobs_;
  const std::vector<Job> due_;
  const std::size_t all_;
  const Clock::time_point start_ = Clock::now();
  std::mutex mutex_;
  std::map<std::string, std::unique_ptr<std::mutex>> packing_turn_;
  std::condition_variable ended_;
  std::size_t next_ = 0, done_ = 0, working_ = 0;
  std::vector<double> share_;
  std::exception_ptr error_;
  std::atomic<bool> stop_{false};
};

fs::path Workers::packing(const dem::Scene& scene) {
  if (!scene.powder) return {};
  const std::string key = packing_key(scene);
  const fs::path path = jobs_.folder / "packings" / (key + ".h5");
  std::mutex* turn = nullptr;
  {
    const std::lock_guard lock(mutex_);
    auto& of_key = packing_turn_[key];
    if (!of_key) of_key = std::make_unique<std::mutex>();
    turn = of_key.get();
  }
  const std::lock_guard packing_once(*turn);
  if (fs::exists(path)) return path;
  fs::create_directories(path.parent_path());
  dem::write_specimen(path, dem::make_specimen(scene, 1, [&](double) {
                        if (stop_) throw Interrupted("");
                      }));
  return path;
}

void Workers::run_one(std::size_t k) {
  const Job& job = due_[k];
  fs::remove_all(job.folder);  // what a kill has left
  dem::RunOptions options;
  options.packing = packing(*job.scene);
  options.folder = job.folder;
  options.version = jobs_.version;
  options.stop = &stop_;
  options.progress = [&](const dem::Progress& p) {
    const std::lock_guard lock(mutex_);
    share_[k] = p.share;
  };
  try {
    const dem::RunSummary summary = dem::run(*job.scene, options);
    job.run->wall = summary.wall_seconds - summary.packing_seconds;
    job.run->cpu = summary.cpu_seconds;
    job.run->steps = double(summary.steps);
    job.run->bytes = double(summary.bytes);
  } catch (const RunError& error) {
    job.run->failure = error.what();
  }
  job.run->history = dem::read_history(job.folder / "history.csv");
  for (const char* done_with : {"checkpoint.h5", "result.h5", "specimen.h5", "snapshots"})
    fs::remove_all(job.folder / done_with);
  write_record(job);
  const std::lock_guard lock(mutex_);
  share_[k] = 1;
  ++done_;
}

void Workers::work() {
  while (true) {
    std::size_t k = 0;
    {
      const std::lock_guard lock(mutex_);
      if (next_ == due_.size() || stop_) break;
      k = next_++;
    }
    try {
      run_one(k);
    } catch (const Interrupted&) {  // by stop_
    } catch (...) {
      const std::lock_guard lock(mutex_);
      if (!error_) error_ = std::current_exception();
      stop_ = true;
    }
  }
  const std::lock_guard lock(mutex_);
  --working_;
  ended_.notify_all();
}

void Workers::run_all() {
  working_ = std::min(due_.size(), std::size_t(std::max(1, jobs_.threads)));
  bool interrupted = false;
  std::vector<std::thread> threads;
  for (std::size_t w = working_; w > 0; --w) threads.emplace_back([this] { work(); });
  std::unique_lock lock(mutex_);
  while (working_ > 0) {
    ended_.wait_for(lock, std::chrono::milliseconds(250));
    if (jobs_.stop && *jobs_.stop) stop_ = interrupted = true;
    if (!jobs_.progress) continue;
    double share = 0;
    for (const double s : share_) share += s / double(due_.size());
    const double spent = std::chrono::duration<double>(Clock::now() - start_).count();
    jobs_.progress(all_ - due_.size() + done_, all_, share, share > 0 ? spent * (1 / share - 1) : dem::unset);
  }
  lock.unlock();
  for (auto& t : threads) t.join();
  if (error_) std::rethrow_exception(error_);
  if (interrupted)
    throw Interrupted("interrupted; finished runs are kept, continue with --resume --out " + jobs_.folder.string());
}

}  // namespace

std::vector<std::vector<TradeRun>> run_jobs(const TradeJobs& jobs) {
  const std::size_t rungs = jobs.scenes.size(), n = jobs.scenes.front().size();
  std::vector<std::vector<TradeRun>> runs(rungs, std::vector<TradeRun>(n));
  std::vector<Job> due;
  for (std::size_t k = 0; k < n; ++k)
    for (std::size_t r = 0; r < rungs; ++r) {
      const Job job{&jobs.scenes[r][k], jobs.folder / "runs" / fmt::format("rung_{:02d}_{:03d}", r + 1, k + 1),
                    &runs[r][k]};
      if (!read_record(job)) due.push_back(job);
    }
  if (!due.empty()) Workers(jobs, due, rungs * n).run_all();
  return runs;
}

}  // namespace densify::app
