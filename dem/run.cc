#include "dem/run.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <sstream>

#include "base/check.h"
#include "base/version.h"
#include "dem/history_row.h"
#include "dem/io/checkpoint.h"
#include "dem/io/result_file.h"
#include "dem/io/visualisation.h"

namespace densify::dem {

namespace {

namespace fs = std::filesystem;

class Stopwatch {
 public:
  double seconds() const { return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count(); }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

std::string text(const char* format, double a) {
  char buffer[120];
  std::snprintf(buffer, sizeof buffer, format, a);
  return buffer;
}

struct Paths {
  explicit Paths(const fs::path& folder)
      : checkpoint(folder / "checkpoint.h5"),
        specimen(folder / "specimen.h5"),
        history(folder / "history.csv"),
        pictures(folder / "paraview") {}
  fs::path checkpoint, specimen, history, pictures;
};

void open_folder(const RunOptions& options) {
  std::error_code error;
  const bool used = fs::exists(options.folder, error) && !fs::is_empty(options.folder, error);
  if (options.mode == Continue::fresh && used)
    throw InputError("--out " + options.folder.string() +
                     ": the folder holds other results; nothing was changed.  Choose another folder, or continue that "
                     "run with --resume");
  if (options.mode == Continue::resume && !fs::exists(options.folder / "checkpoint.h5"))
    throw InputError("--resume: " + options.folder.string() +
                     " holds no checkpoint.h5, so there is nothing to resume; start the run without --resume");
  fs::create_directories(options.folder, error);
  if (error) throw FileError("cannot make the folder " + options.folder.string() + " (" + error.message() + ")");
}

/// The numbers behind the scene's numbers, as comments that a scene reader skips.
std::string derived_text(const Scene& scene, const Simulation& sim, const Specimen* specimen) {
  std::ostringstream out;
  out.precision(9);
  const double real = [&] {
    double m = 0;
    for (std::size_t p = 0; p < sim.state().particles.size(); ++p) m += sim.real_mass(p);
    return m;
  }();
  out << "\n# Derived numbers\n";
  out << "# particles = " << sim.state().particles.size() << "\n";
  out << "# solid volume = " << sim.solid_volume() << " m^3\n";
  out << "# powder mass = " << real << " kg, as integrated (mass scaling " << scene.integration.mass_scaling
      << ") = " << real * scene.integration.mass_scaling << " kg\n";
  const Vec3& size = sim.setup().container.size;
  out << "# container = " << size[0] << " x " << size[1] << " x " << size[2] << " m\n";
  if (sim.state().punch.mass > 0)
    out << "# punch: fictitious mass = " << sim.state().punch.mass << " kg, area = " << sim.state().punch.area
        << " m^2\n";
  out << "# neighbour list skin = " << sim.state().contacts.skin << " m\n";
  for (std::size_t a = 0; a < scene.materials.size(); ++a)
    for (std::size_t b = a; b < scene.materials.size() && scene.contact.sintering; ++b) {
      const Interface& f = sim.table().interface(std::uint8_t(a), std::uint8_t(b));
      const double peak = scene.schedule.peak_temperature();
      out << "# " << scene.materials[a].name << " - " << scene.materials[b].name << ": activation at "
          << f.activation_temperature << " K; D_eff(" << peak << " K) = " << f.diffusion.effective(peak)
          << " m^5/(N s)\n";
    }
  if (specimen)
    for (const auto& line : specimen->lines) out << "# specimen: " << line << "\n";
  out << "# densify " << version() << " (" << git_revision() << ")\n";
  return out.str();
}

/// One run in progress.
class Run {
 public:
  Run(const Scene& scene, const RunOptions& options) : scene_(scene), options_(options), paths_(options.folder) {}

  RunSummary whole();

 private:
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
  std::optional<Simulation> sim_;
  std::optional<HistoryFile> history_;
  std::optional<ResultFile> results_;
  std::optional<Visualisation> pictures_;
  CheckpointOwner owner_;
  HistoryMemory memory_;
  RunPosition position_;
  double next_row_ = 0, next_snapshot_ = 0;  // process time [s]
  double row_interval_ = 0, snapshot_interval_ = 0;
  double last_checkpoint_ = 0, last_progress_ = -1;  // wall time [s]
  double start_time_ = 0, start_wall_ = 0;           // where this session took up the process
  std::uint64_t start_steps_ = 0;
  double packing_seconds_ = 0, force_seconds_ = 0, motion_seconds_ = 0, output_seconds_ = 0, checkpoint_seconds_ = 0;
  RunSummary summary_;
};

void Run::prepare() {
  open_folder(options_);
  std::optional<Specimen> specimen;
  GreenBody body;
  if (options_.mode == Continue::resume) {
    body = read_specimen(paths_.specimen);
  } else {
    specimen = make_specimen(scene_, options_.threads, [this](double share) {
      if (options_.stop && *options_.stop)
        throw Interrupted("interrupted while packing; there is nothing to resume yet, start the run again");
      if (options_.progress && clock_.seconds() - last_progress_ > 0.25) {
        last_progress_ = clock_.seconds();
        options_.progress({"packing", share, 0, 0, 0, 0, 0, share > 0 ? last_progress_ * (1 / share - 1) : 0});
      }
    });
    body = specimen->body;
    for (const auto& line : specimen->lines) say(line);
  }
  packing_seconds_ = clock_.seconds();
  sim_.emplace(make_setup(scene_, body, options_.threads));
  sim_->require_stable_step();

  const Schedule& schedule = scene_.schedule;
  row_interval_ = std::isnan(scene_.output.history_interval) ? schedule.end() / 400 : scene_.output.history_interval;
  snapshot_interval_ = scene_.output.snapshot_interval;
  owner_ = {fingerprint(scene_), options_.version};
  const auto columns = history_columns(sim_->setup());
  RunDescription description{scene_.effective_text + derived_text(scene_, *sim_, specimen ? &*specimen : nullptr),
                             std::string(version()), std::string(git_revision()), columns};
  if (options_.mode == Continue::resume) {
    position_ = read_checkpoint(paths_.checkpoint, *sim_, owner_);
    if (position_.numbers.size() != HistoryMemory::size + 2)
      throw InputError(paths_.checkpoint.string() + " is not readable (truncated or damaged)");
    memory_ = HistoryMemory::from(position_.numbers);
    next_row_ = position_.numbers[HistoryMemory::size];
    next_snapshot_ = position_.numbers[HistoryMemory::size + 1];
    history_.emplace(HistoryFile::resume(paths_.history, columns, position_.history_bytes));
    say("resumed at process time " + text("%.6g s", sim_->state().time));
  } else {
    write_specimen(paths_.specimen, body);
    history_.emplace(HistoryFile::create(paths_.history, columns));
    position_.history_bytes = history_->bytes();
    if (std::isnan(snapshot_interval_)) next_snapshot_ = std::numeric_limits<double>::infinity();
  }
  results_.emplace(options_.folder, description, position_.snapshots);
  if (scene_.output.visualisation) pictures_.emplace(paths_.pictures, position_.snapshots);
  if (options_.mode == Continue::fresh) write_checkpoint_now();  // from here on a kill leaves something to resume
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
  const Measures m = measure(*sim_, recording);
  if (position_.history_rows == 0) {
    memory_.initial = m.envelope;
    memory_.density = m.relative_density;
    memory_.time = state.time;
  }
  if (!std::isfinite(m.relative_density) || !m.stress.allFinite())
    throw RunError("density or stress is no longer finite at process time " + text("%.6g s", state.time));
  if (m.largest_overlap > 1.95)
    throw RunError("two particles have passed through each other (overlap " + text("%.2f", m.largest_overlap) +
                   " of the smaller radius) at process time " + text("%.6g s", state.time) +
                   "; the contacts are too soft for the load or the step too large");
  const bool loose = !sim_->table().any_active() && scene_.contact.damping_ratio > 0 && sim_->pressure() > 0;
  if (loose && m.damping_share > 0.01 && summary_.warnings.empty())
    summary_.warnings.push_back("dampers carry " + text("%.1f %%", 100 * m.damping_share) +
                                " of the contact forces at process time " + text("%.4g s", state.time) +
                                ": the mass scaling makes (4.24) viscous; lower contact.damping_ratio or mass_scaling");
  position_.history_bytes = history_->add_row(history_row(*sim_, m, memory_), stage_name(state.time));
  ++position_.history_rows;
  while (next_row_ <= state.time) next_row_ += row_interval_;
  summary_.last = m;

  if (breakpoint || state.time >= next_snapshot_) {
    const Snapshot snapshot =
        take_snapshot(*sim_, recording,
                      {state.time, sim_->temperature(), sim_->pressure(), m.relative_density, stage_name(state.time)});
    results_->add_snapshot(snapshot);
    if (pictures_) pictures_->add(snapshot);
    position_.snapshots = results_->snapshots();
    while (next_snapshot_ <= state.time) next_snapshot_ += snapshot_interval_;
  }
  output_seconds_ += watch.seconds();
}

void Run::write_checkpoint_now() {
  const Stopwatch watch;
  history_->sync();
  position_.numbers = memory_.numbers();
  position_.numbers.insert(position_.numbers.end(), {next_row_, next_snapshot_});
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
                     sim_->temperature(), sim_->pressure(), memory_.density,
                     spent > 0 ? double(s.steps - start_steps_) / spent : 0,
                     done > 0 ? spent * (end - s.time) / done : 0});
}

void Run::loop() {
  Recording recording;
  const auto punch = sim_->wall("punch");
  constexpr std::uint64_t watched = 32;  // every so many steps are timed, and the clock looked at
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
      if (scene_.integration.fixed_step > state.critical_step && state.critical_step > 0)
        throw RunError("integration.fixed_step of " + text("%.4g s", scene_.integration.fixed_step) +
                       " has come above the stability limit of " + text("%.4g s", state.critical_step) +
                       " at process time " + text("%.6g s", state.time) + "; use a smaller one, or leave it out");
      if (clock_.seconds() - last_checkpoint_ > scene_.output.checkpoint_interval) write_checkpoint_now();
      if (clock_.seconds() - last_progress_ > 0.25) report_progress();
    }
    if (last) write_checkpoint_now();
    const std::size_t stage = schedule.stage_at(state.time);
    const bool breakpoint = state.steps == 0 || last || (stage > 0 && state.time == schedule.stage_end(stage - 1));
    const bool row = breakpoint || state.time >= next_row_ || state.time >= next_snapshot_;
    const Stopwatch forces;
    sim_->evaluate(row ? &recording : nullptr);
    if (look) force_seconds_ += watched * forces.seconds();
    if (punch) {
      memory_.punch_impulse += sim_->state().walls.normal_force()[*punch] * state.last_step;
      memory_.punch_time += state.last_step;
    }
    if (row) record(recording, breakpoint);
    if (last) break;
    const Stopwatch motion;
    sim_->move();
    if (look) motion_seconds_ += watched * motion.seconds();
  }
}

RunSummary Run::whole() {
  prepare();
  try {
    loop();
  } catch (const RunError& error) {
    std::error_code none;
    const bool saved = fs::exists(paths_.checkpoint, none);
    throw RunError(std::string(error.what()) + ".  " +
                   (saved ? "The last good checkpoint is " + paths_.checkpoint.string()
                          : std::string("No checkpoint had been written yet")) +
                   "; the history so far is " + paths_.history.string());
  }
  const Stopwatch watch;
  results_->consolidate(ResultFile::usual_largest);
  output_seconds_ += watch.seconds();
  report_progress();

  const State& state = sim_->state();
  summary_.wall_seconds = clock_.seconds();
  summary_.steps = state.steps - start_steps_;
  summary_.list_builds = state.contacts.builds;
  summary_.bytes = sim_->bytes();
  summary_.end_time = state.time;
  // Sampled shares are scaled to the time that is not accounted for otherwise.
  const double rest = std::max(0.0, summary_.wall_seconds - packing_seconds_ - output_seconds_ - checkpoint_seconds_);
  const double sampled = std::max(1e-12, force_seconds_ + motion_seconds_);
  summary_.shares = {{"packing", packing_seconds_},
                     {"forces and neighbour lists", rest * force_seconds_ / sampled},
                     {"motion and step limits", rest * motion_seconds_ / sampled},
                     {"measures and results", output_seconds_},
                     {"checkpoints", checkpoint_seconds_}};
  return summary_;
}

}  // namespace

RunSummary run(const Scene& scene, const RunOptions& options) {
  return Run(scene, options).whole();
}

std::string fingerprint(const Scene& scene) {
  // FNV-1a over the lines that matter: output settings and title may change between a run and its resumption.
  std::uint64_t hash = 14695981039346656037ull;
  std::istringstream lines(scene.effective_text);
  bool counts = true;
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("[")) counts = !line.starts_with("[output");
    if (!counts || line.starts_with("title")) continue;
    for (unsigned char c : line + "\n") hash = (hash ^ c) * 1099511628211ull;
  }
  return std::to_string(hash);
}

}  // namespace densify::dem
