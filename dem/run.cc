#include "dem/run.h"

#include <time.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <span>
#include <sstream>

#include "base/check.h"
#include "base/version.h"
#include "dem/derived_numbers.h"
#include "dem/history_row.h"
#include "dem/io/atomic_file.h"
#include "dem/io/checkpoint.h"
#include "dem/io/result_file.h"
#include "dem/io/result_folder.h"
#include "dem/io/visualisation.h"
#include "dem/network/network.h"
#include "dem/run_watch.h"

namespace densify::dem {

namespace {

namespace fs = std::filesystem;

class Stopwatch {
 public:
  double seconds() const { return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count(); }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// Processor time of this thread [s].
double thread_seconds() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return double(t.tv_sec) + 1e-9 * double(t.tv_nsec);
}

std::string text(const char* format, double a) {
  char buffer[120];
  std::snprintf(buffer, sizeof buffer, format, a);
  return buffer;
}

struct Paths {
  explicit Paths(const fs::path& folder)
      : checkpoint(folder / "checkpoint.h5"),
        specimen(folder / "specimen.h5"),
        sizes(folder / "particle_sizes.csv"),
        history(folder / "history.csv"),
        pictures(folder / "paraview") {}
  fs::path checkpoint, specimen, sizes, history, pictures;
};

/// Particles with fewer than four contacts to others of four, walls counted: normal forces alone do not hold them.
std::size_t loosely_held(const Simulation& sim) {
  const State& s = sim.state();
  const auto loose = find_rattlers(
      build_network({s.particles, s.contacts, s.cell, sim.table(), sim.setup().contact, s.walls}, s.time), 4);
  return std::size_t(std::count(loose.begin(), loose.end(), true));
}

/// The first multiple of the interval after a time [s]; never, without an interval.
double next_multiple(double interval, double time) {
  return std::isnan(interval) ? std::numeric_limits<double>::infinity() : interval * (std::floor(time / interval) + 1);
}

/// One run in progress.
class Run {
 public:
  Run(const Scene& scene, const RunOptions& options) : scene_(scene), options_(options), paths_(options.folder) {}

  RunSummary whole();

 private:
  GreenBody pack();
  void prepare();
  void loop();
  void record(const Recording&, bool breakpoint);
  void write_checkpoint_now();
  void report_progress();
  void say(const std::string& line) const {
    if (options_.say) options_.say(line);
  }
  std::string stage_name(double t) const;

  const Scene& scene_;
  const RunOptions& options_;
  const Paths paths_;
  Stopwatch clock_;
  std::optional<ResultFolder> folder_;
  std::optional<Simulation> sim_;
  std::optional<HistoryFile> history_;
  std::optional<ResultFile> results_;
  std::optional<Visualisation> pictures_;
  CheckpointOwner owner_;
  HistoryMemory memory_;
  RunWatch watch_;  // without what the guards have seen in this call
  EnergyBalance balance_;
  RunPosition position_;
  double last_snapshot_ = 0, next_row_ = 0, next_snapshot_ = 0;  // process time [s]
  double row_interval_ = 0, snapshot_interval_ = 0;
  double last_checkpoint_ = 0, last_progress_ = -1;  // wall time [s]
  double start_time_ = 0, start_wall_ = 0;           // where this call took up the process
  std::uint64_t start_steps_ = 0;
  double packing_cpu_seconds_ = 0;
  double packing_seconds_ = 0, list_seconds_ = 0, force_seconds_ = 0, motion_seconds_ = 0, output_seconds_ = 0,
         checkpoint_seconds_ = 0;
  RunSummary summary_;
};

GreenBody Run::pack() try {
  return make_specimen(scene_, options_.threads, [this](double share) {
    if (options_.stop && *options_.stop)
      throw Interrupted("interrupted while packing; there is nothing to resume yet, start the run again");
    if (options_.progress && clock_.seconds() - last_progress_ > 0.25) {
      last_progress_ = clock_.seconds();
      options_.progress({"packing", share, 0, 0, 0, 0, 0, share > 0 ? last_progress_ * (1 / share - 1) : 0});
    }
  });
} catch (const RunError& error) {
  throw RunError(error.what() + std::string(".  This was while packing; there is no checkpoint yet"));
}

void Run::prepare() {
  folder_.emplace(options_.folder, options_.mode, std::vector<std::string>{"checkpoint.h5"});
  owner_ = {fingerprint(scene_), options_.version};
  GreenBody body;
  if (options_.mode == Continue::resume) {
    require_checkpoint(paths_.checkpoint, owner_);  // before a specimen of another scene is made to fit this one
    body = read_specimen(paths_.specimen);
  } else if (!options_.packing.empty()) {
    body = read_specimen(options_.packing);
    perturb(body, scene_.perturbation);
  } else {
    body = pack();
    perturb(body, scene_.perturbation);
  }
  const SpecimenReport specimen = report_on(body, scene_.materials);
  if (options_.mode == Continue::fresh)
    for (const auto& line : specimen.lines) say(line);
  packing_seconds_ = clock_.seconds();
  packing_cpu_seconds_ = thread_seconds();
  sim_.emplace(make_setup(scene_, body, options_.threads));
  sim_->require_stable_step();

  const Schedule& schedule = scene_.schedule;
  row_interval_ = std::isnan(scene_.output.history_interval) ? schedule.end() / 400 : scene_.output.history_interval;
  snapshot_interval_ = scene_.output.snapshot_interval;
  const auto columns = history_columns(sim_->setup());
  RunDescription description{scene_.effective_text + derived_numbers(scene_, *sim_, specimen), std::string(version()),
                             std::string(git_revision()), columns};
  if (options_.mode == Continue::resume) {
    position_ = read_checkpoint(paths_.checkpoint, *sim_, owner_);
    if (position_.numbers.size() != HistoryMemory::size + 1 + RunWatch::size)
      throw InputError(paths_.checkpoint.string() + " is not readable (truncated or damaged)");
    memory_ = HistoryMemory::from(position_.numbers);
    last_snapshot_ = position_.numbers[HistoryMemory::size];
    watch_ = RunWatch::from(std::span(position_.numbers).subspan(HistoryMemory::size + 1));
    sim_->resume_guards(watch_.last_look);
    history_.emplace(HistoryFile::resume(paths_.history, columns, position_.history_bytes));
    say("resumed at process time " + text("%.6g s", sim_->state().time));
  } else {
    write_specimen(paths_.specimen, body);
    write_atomically(paths_.sizes, {specimen.sizes_csv}, Durability::kill);
    history_.emplace(HistoryFile::create(paths_.history, columns));
    position_.history_bytes = history_->bytes();
    write_checkpoint_now();  // from here on the folder can be resumed
  }
  next_row_ = next_multiple(row_interval_, memory_.time);
  next_snapshot_ = next_multiple(snapshot_interval_, last_snapshot_);
  results_.emplace(options_.folder, description, position_.snapshots);
  if (scene_.output.visualisation)
    pictures_.emplace(paths_.pictures, position_.snapshots,
                      scene_.output.stress_fields ? StressFields::written : StressFields::left_out);
  start_time_ = sim_->state().time;
  start_steps_ = sim_->state().steps;
  start_wall_ = last_checkpoint_ = clock_.seconds();
}

std::string Run::stage_name(double t) const {
  const Schedule& s = scene_.schedule;
  std::size_t k = s.stage_at(t);
  if (k > 0 && t == s.stage_end(k - 1)) --k;  // a row at a breakpoint belongs to the stage that it ends
  return s.stages()[k].name;
}

void Run::record(const Recording& recording, bool breakpoint) {
  const Stopwatch watch;
  const State& state = sim_->state();
  sim_->require_sound();
  const Measures m = measure(*sim_, recording);
  if (position_.history_rows == 0) {
    memory_.initial = m.envelope;
    memory_.density = m.relative_density;
    memory_.time = state.time;
  }
  if (!std::isfinite(m.relative_density) || !m.stress.allFinite())
    throw RunError("density or stress is no longer finite; try a smaller step_safety or mass_scaling");
  const bool loose = !sim_->table().any_active() && scene_.contact.damping_ratio > 0 && sim_->load().size > 0;
  if (loose) watch_.note_damping(m.damping_share, state.time);
  position_.history_bytes = history_->add_row(history_row(*sim_, m, memory_), stage_name(state.time));
  ++position_.history_rows;
  summary_.density_error = memory_.density_error;
  next_row_ = next_multiple(row_interval_, state.time);
  summary_.last = m;

  if (breakpoint || state.time >= next_snapshot_) {
    const Snapshot snapshot =
        take_snapshot(*sim_, recording,
                      {state.time, sim_->temperature(), sim_->pressure(), m.relative_density, stage_name(state.time)});
    results_->add_snapshot(snapshot);
    if (pictures_) pictures_->add(snapshot);
    position_.snapshots = results_->snapshots();
    last_snapshot_ = state.time;
    next_snapshot_ = next_multiple(snapshot_interval_, state.time);
  }
  output_seconds_ += watch.seconds();
}

void Run::write_checkpoint_now() {
  sim_->require_sound();  // the last good checkpoint must stay when the last step has spoilt the state
  const Stopwatch watch;
  history_->sync();
  position_.numbers = memory_.numbers();
  position_.numbers.push_back(last_snapshot_);
  for (const double n : watch_.and_then(sim_->guards()).numbers()) position_.numbers.push_back(n);
  write_checkpoint(paths_.checkpoint, *sim_, position_, owner_);
  last_checkpoint_ = clock_.seconds();
  checkpoint_seconds_ += watch.seconds();
}

void Run::report_progress() {
  const double now = clock_.seconds(), spent = now - start_wall_;
  last_progress_ = now;
  if (!options_.progress) return;
  const State& s = sim_->state();
  const double end = scene_.schedule.end(), done = s.time - start_time_;
  options_.progress({scene_.schedule.stages()[scene_.schedule.stage_at(s.time)].name, s.time / end, s.time,
                     sim_->temperature(), sim_->load().size, memory_.density,
                     spent > 0 ? double(s.steps - start_steps_) / spent : 0,
                     done > 0 ? spent * (end - s.time) / done : 0});
}

void Run::loop() {
  Recording recording;
  const auto punch = sim_->wall("punch");
  // Every so many steps are timed, and the clock looked at: a prime, so that what is done every limit_interval steps
  // has its due share.
  constexpr std::uint64_t watched = 31;
  const Schedule& schedule = scene_.schedule;
  const std::uint64_t first = sim_->state().steps;
  while (true) {
    const State& state = sim_->state();
    const bool last =
        sim_->finished() || (scene_.stop_when == StopWhen::all_necks_at_equilibrium && sim_->all_at_equilibrium());
    const bool look = (state.steps - first) % watched == 0;
    if (look) {
      if (options_.stop && *options_.stop) {
        write_checkpoint_now();
        throw Interrupted("interrupted at process time " + text("%.6g s", state.time) +
                          "; continue with --resume --out " + options_.folder.string());
      }
      if (clock_.seconds() - last_checkpoint_ > scene_.output.checkpoint_interval) write_checkpoint_now();
      if (clock_.seconds() - last_progress_ > 0.25) report_progress();
    }
    if (last) write_checkpoint_now();
    const std::size_t stage = schedule.stage_at(state.time);
    const bool breakpoint = state.steps == 0 || last || (stage > 0 && state.time == schedule.stage_end(stage - 1));
    const bool row = breakpoint || state.time >= next_row_ || state.time >= next_snapshot_;
    const bool energies = sim_->setup().energies;
    if (look && !energies) {
      const Stopwatch lists;
      sim_->refresh();
      list_seconds_ += watched * lists.seconds();
    }
    const Stopwatch forces;
    if (energies)
      balance_.evaluate(*sim_, recording, memory_.energy);  // with its lists
    else
      sim_->evaluate(row ? &recording : nullptr);
    if (look) force_seconds_ += watched * forces.seconds();
    if (punch) {
      memory_.punch_impulse += sim_->state().walls.normal_force()[*punch] * state.last_step;
      memory_.punch_time += state.last_step;
    }
    if (sim_->stress_driven()) {
      for (std::size_t c = 0; c < 6; ++c)
        memory_.cell_impulse[c] += sim_->cell_stress()(tensor_places[c][0], tensor_places[c][1]) * state.last_step;
      memory_.cell_time += state.last_step;
    }
    if (row) record(recording, breakpoint);
    if (last) break;
    const Stopwatch motion;
    if (energies)
      balance_.move(*sim_, recording, memory_.energy);
    else
      sim_->move();
    if (look) motion_seconds_ += watched * motion.seconds();
  }
}

RunSummary Run::whole() {
  try {
    prepare();
  } catch (...) {
    if (folder_) folder_->abandon();  // leaves no empty folder behind; one with files stays
    throw;
  }
  try {
    loop();
  } catch (const RunError& error) {
    const State& state = sim_->state();
    throw RunError(error.what() + text(".  This was at process time %.6g s", state.time) + " (step " +
                   std::to_string(state.steps) + ", stage \"" + stage_name(state.time) +
                   "\").  The last good checkpoint is " + paths_.checkpoint.string() + "; the history so far is " +
                   paths_.history.string());
  }
  const Stopwatch watch;
  results_->consolidate(ResultFile::usual_largest);
  output_seconds_ += watch.seconds();
  report_progress();

  const State& state = sim_->state();
  summary_.warnings = watch_.and_then(sim_->guards()).warnings(scene_.integration, state.time);
  for (std::string& line : calibration_warnings(scene_, sim_->setup().container.size[0]))
    summary_.warnings.push_back(std::move(line));
  summary_.wall_seconds = clock_.seconds();
  summary_.packing_seconds = packing_seconds_;
  summary_.cpu_seconds = thread_seconds() - packing_cpu_seconds_;
  summary_.steps = state.steps - start_steps_;
  summary_.threads = sim_->setup().integration.threads;
  summary_.list_builds = state.contacts.builds;
  summary_.bytes = sim_->bytes();
  summary_.inertia_free = sim_->inertia_free_count();
  if (state.inertia_free) summary_.loosely_held = loosely_held(*sim_);
  summary_.end_time = state.time;
  // Sampled shares are scaled to the time that is not accounted for otherwise.
  const double rest = std::max(0.0, summary_.wall_seconds - packing_seconds_ - output_seconds_ - checkpoint_seconds_);
  const double scale = rest / std::max(1e-12, list_seconds_ + force_seconds_ + motion_seconds_);
  summary_.shares = {{"packing", packing_seconds_},
                     {"neighbour lists", scale * list_seconds_},
                     {"forces", scale * force_seconds_},
                     {"motion and step limits", scale * motion_seconds_},
                     {"measures and results", output_seconds_},
                     {"checkpoints", checkpoint_seconds_}};
  return summary_;
}

}  // namespace

RunSummary run(const Scene& scene, const RunOptions& options) try {
  return Run(scene, options).whole();
} catch (const InputError& error) {
  throw InputError(scene.placed(error.what()));
}

std::string fingerprint(const Scene& scene) {
  // FNV-1a over the lines that matter: output settings but for the columns of the history, guards and title may change
  // between a run and its resumption.
  std::uint64_t hash = 14695981039346656037ull;
  std::istringstream lines(scene.effective_text);
  bool counts = true;
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("[")) counts = !line.starts_with("[output") && !line.starts_with("[guards");
    if ((!counts && !line.starts_with("energies")) || line.starts_with("title")) continue;
    for (unsigned char c : line + "\n") hash = (hash ^ c) * 1099511628211ull;
  }
  return std::to_string(hash);
}

}  // namespace densify::dem
