#include "coupling/press_case.h"

#include <fmt/core.h>

#include <chrono>
#include <sstream>

#include "base/check.h"
#include "coupling/press_files.h"
#include "coupling/press_material.h"
#include "dem/io/atomic_file.h"

namespace densify::coupling {

namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

/// The effective text up to [output], which a resumed run may change.
std::string without_output(const std::string& text) {
  return text.substr(0, text.find("\n[output]"));
}

/// A wall gives way a hundredth of what the dense solid would.
fem::PressSettings with_wall(const PressScene& scene, double dense_youngs_modulus) {
  constexpr double factor = 100;
  fem::PressSettings settings = scene.settings;
  settings.wall_stiffness = factor * dense_youngs_modulus / scene.size.radius;
  return settings;
}

template <int dim>
class Case {
 public:
  Case(const PressScene& scene, const PressMaterial& material, const PressOptions& options, MPI_Comm comm)
      : scene_(scene),
        options_(options),
        comm_(comm),
        first_(dealii::Utilities::MPI::this_mpi_process(comm) == 0),
        live_(material.live),
        body_(scene.size, material.point, material.density, scene.schedule->temperature(0),
              with_wall(scene, material.dense_youngs_modulus), comm),
        run_(body_, *scene.schedule, scene.press, scene.control) {}

  PressSummary run();

 private:
  void begin();
  void resume();
  void write_fields();
  void write_checkpoint();
  void show();

  const PressScene& scene_;
  const PressOptions& options_;
  const MPI_Comm comm_;
  const bool first_;
  const std::shared_ptr<LiveMaterial> live_;
  fem::PressBody<dim> body_;
  fem::PressRun<dim> run_;
  std::string history_, fields_;
  double fields_at_ = 0, started_at_ = 0;
  int started_steps_ = 0;
  const Clock::time_point start_ = Clock::now();
};

template <int dim>
void Case<dim>::begin() {
  if (first_) {
    fs::create_directories(options_.folder / "fields");
    dem::write_atomically(options_.folder / "scene.effective.toml", {scene_.effective_text}, dem::Durability::kill);
  }
  MPI_Barrier(comm_);
  history_ = press_history_header() + press_history_row(run_.row());
  write_fields();
  write_checkpoint();  // from here on it can be resumed
}

template <int dim>
void Case<dim>::resume() {
  const PressCheckpoint c = read_press_checkpoint(options_.folder / "checkpoint.h5");
  if (c.scene != without_output(scene_.effective_text))
    throw InputError("--resume: the scene is not the one of the checkpoint in " + options_.folder.string() +
                     "; only [output] may change");
  body_.restore(c.body);
  run_.restore(c.run);
  if (live_) live_->restore(c.live);
  fields_ = c.fields;
  fields_at_ = c.fields_at;
  started_at_ = c.run.row.time, started_steps_ = c.run.row.steps;
  // Rows up to the checkpoint; steps count them.
  std::istringstream rows(dem::read_whole_file(options_.folder / "history.csv"));
  std::string line;
  for (int k = 0; k < c.run.row.steps + 2; ++k) {
    if (!std::getline(rows, line))
      throw InputError(fmt::format("{}: has lost rows that the checkpoint counts; start the run anew in another folder",
                                   (options_.folder / "history.csv").string()));
    history_.append(line).append("\n");
  }
}

template <int dim>
void Case<dim>::write_fields() {
  const std::string name = fmt::format("body_{:05d}", run_.row().steps);
  const std::string file = write_press_fields(options_.folder / "fields", name, body_);
  fields_ += fmt::format("{} {}\n", run_.row().time, file);
  fields_at_ = run_.row().time;
  if (first_) write_press_collection(options_.folder, fields_);
}

template <int dim>
void Case<dim>::write_checkpoint() {
  const PressCheckpoint c{without_output(scene_.effective_text), body_.state(), run_.memory(), fields_at_, fields_,
                          live_ ? live_->memory() : LiveMemory{}};
  if (!first_) return;
  dem::write_atomically(options_.folder / "history.csv", {history_}, dem::Durability::kill);
  write_press_checkpoint(options_.folder / "checkpoint.h5", c);
}

template <int dim>
void Case<dim>::show() {
  const LiveCount live = live_ ? live_->count() : LiveCount{};
  if (!first_ || !options_.progress) return;
  const fem::PressRow& r = run_.row();
  const std::string stage = live_ ? fmt::format("{}, {:.3g} steps of elements", r.stage, double(live.steps)) : r.stage;
  const double wall = std::chrono::duration<double>(Clock::now() - start_).count();
  options_.progress({stage, r.time / run_.end(), r.time, r.temperature, r.pressure, r.density.mean,
                     (r.steps - started_steps_) / wall, wall * (run_.end() - r.time) / (r.time - started_at_)});
}

template <int dim>
PressSummary Case<dim>::run() {
  if (options_.mode == dem::Continue::resume)
    resume();
  else
    begin();
  Clock::time_point saved = Clock::now();
  while (!run_.done()) {
    const std::string stage = run_.row().stage;
    try {
      run_.advance();
    } catch (const RunError& error) {
      write_checkpoint();
      throw RunError(
          fmt::format("{}; last good state: {}", error.what(), (options_.folder / "checkpoint.h5").string()));
    }
    const fem::PressRow& row = run_.row();
    history_ += press_history_row(row);
    const bool due = scene_.field_interval > 0 && row.time >= fields_at_ + scene_.field_interval;
    if (due || row.stage != stage || run_.done()) write_fields();
    show();
    int flags[2] = {options_.stop && *options_.stop,  // rank 0 decides for all
                    std::chrono::duration<double>(Clock::now() - saved).count() >= scene_.checkpoint_interval};
    MPI_Bcast(flags, 2, MPI_INT, 0, comm_);
    if (flags[0] || flags[1]) {
      write_checkpoint();
      saved = Clock::now();
    }
    if (flags[0]) throw Interrupted("interrupted; go on with --resume --out " + options_.folder.string());
    if (first_) dem::write_atomically(options_.folder / "history.csv", {history_}, dem::Durability::kill);
  }
  write_checkpoint();
  return {run_.row(), live_ ? std::optional(live_->count()) : std::nullopt};
}

}  // namespace

PressSummary run_press(const PressScene& scene, const PressOptions& options, MPI_Comm comm) {
  const unsigned ranks = dealii::Utilities::MPI::n_mpi_processes(comm);
  const int elements = fem::element_count(scene.size, scene.geometry == PressGeometry::axisymmetric ? 2 : 3);
  if (int(ranks) > elements)
    throw InputError(
        fmt::format("--ranks {}: the body has only {} elements; take fewer ranks or a finer mesh", ranks, elements));
  std::optional<dem::ResultFolder> folder;  // held by rank 0, which speaks for all
  std::string refused;
  if (dealii::Utilities::MPI::this_mpi_process(comm) == 0) try {
      folder.emplace(options.folder, options.mode, std::vector<std::string>{"checkpoint.h5"});
    } catch (const InputError& error) {
      refused = error.what();
    }
  refused = dealii::Utilities::MPI::broadcast(comm, refused, 0);
  if (!refused.empty()) throw InputError(refused);
  const PressMaterial material = press_material(scene, comm);
  if (scene.geometry == PressGeometry::axisymmetric) return Case<2>(scene, material, options, comm).run();
  return Case<3>(scene, material, options, comm).run();
}

}  // namespace densify::coupling
