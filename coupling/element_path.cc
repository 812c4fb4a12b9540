#include "coupling/element_path.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "base/check.h"
#include "dem/measure/envelope.h"
#include "dem/network/moduli.h"
#include "dem/specimen.h"

namespace densify::coupling {

namespace {

constexpr double cold_mark = 0.003;               // of ln(density), between points
constexpr double first_mark = 5e-4, most = 0.01;  // between points of sintering: grows from the first
constexpr double growth = 0.4;                    // of ln(density) since necks began
constexpr double most_elastic = 0.05;             // volume strain: what gives way further is hardly held
constexpr double holding = 20;                    // above activation until a free cell is let go [K]
constexpr double letting_go = 120;                // [s]
constexpr int look_interval = 10;                 // steps between two looks at the density

dem::CellPath cell_path(const Schedule& schedule, PathKind kind) {
  using dem::CellControl;
  const auto goals = [&](double pressure) {
    dem::CellGoals g;
    const bool all = kind != PathKind::die;
    for (std::size_t c = 0; c < 6; ++c) {
      const bool normal = c < 3;
      if (all || c == 2) g[c] = {CellControl::stress, normal ? -pressure : 0.0};
    }
    return g;
  };
  dem::CellPath path;
  path.start = goals(std::numeric_limits<double>::quiet_NaN());
  for (std::size_t c = 3; c < 6; ++c) path.start[c].value = 0;
  for (const Stage& stage : schedule.stages()) path.stages.push_back(goals(stage.end_pressure));
  return path;
}

/// Probes one moment of a cell.
class Recorder {
 public:
  Recorder(const dem::Scene& element, double peak_temperature) : element_(element) {
    const auto pair = dem::complete_interface(element.materials, 0, 0, element.interfaces);
    diffusion_ = pair.diffusion;
    half_angle_ = std::sin(pair.dihedral_angle / 2);
    reference_ = diffusion_.effective(peak_temperature);
  }

  void note(const dem::Simulation& sim) { stress_ += sim.cell_stress(), ++steps_; }

  /// The point now; nothing when too few contacts hold the cell for its network to be solved.
  std::optional<PathPoint> point(const dem::Simulation& sim) {
    try {
      return probed(sim);
    } catch (const RunError&) {
      return std::nullopt;
    }
  }

 private:
  std::optional<PathPoint> probed(const dem::Simulation& sim);
  void add_necks(const dem::Simulation& sim, PathPoint&) const;

  const dem::Scene& element_;
  dem::GrainBoundaryDiffusion diffusion_;
  double half_angle_, reference_;
  Mat3 stress_ = Mat3::Zero();  // sum over steps
  int steps_ = 0;
};

std::optional<PathPoint> Recorder::probed(const dem::Simulation& sim) {
  PathPoint p{};
  p.time = sim.state().time;
  p.temperature = sim.temperature();
  p.density = dem::solid_volume_now(sim) / sim.state().cell.volume();
  const Mat3 s = stress_ / std::max(1, steps_);
  p.stress << s(0, 0), s(1, 1), s(2, 2), s(1, 2), s(0, 2), s(0, 1);
  stress_.setZero(), steps_ = 0;
  const dem::SpecimenNetwork network = dem::network_of(sim);
  const auto elastic = dem::elastic_answer(network, element_.materials, dem::NeckModel::bonded_neck, {}).response;
  if (elastic.floppy) return std::nullopt;
  const double strain = elastic.relaxed.fullPivLu().solve(p.stress).head<3>().sum();
  if (!(std::abs(strain) < most_elastic)) return std::nullopt;
  p.unloaded = p.density * std::exp(strain);
  p.stiffness = elastic.relaxed / element_.materials[0].youngs_modulus(p.temperature);
  if (dem::count_flowing(network) == 0) return p;
  const dem::ViscousAnswer viscous = dem::viscous_answer(network, {});
  if (viscous.viscosity.response.floppy) return std::nullopt;
  p.flows = true;
  p.viscosity = viscous.viscosity.response.relaxed * (diffusion_.effective(p.temperature) / reference_);
  p.sintering_stress = viscous.sintering_stress;
  add_necks(sim, p);
  return p;
}

void Recorder::add_necks(const dem::Simulation& sim, PathPoint& p) const {
  const dem::State& state = sim.state();
  double squares = 0;
  std::size_t necks = 0, bonded = 0;
  for (std::size_t k = 0; k < state.contacts.neck.size(); ++k) {
    const dem::NeckHistory& neck = state.contacts.neck[k];
    if (neck.phase == dem::NeckPhase::loose) continue;
    const double a = state.particles.body[state.contacts.i(k)].radius,
                 b = state.particles.body[state.contacts.j(k)].radius;
    squares += std::pow(neck.radius / (2 * a * b / (a + b) * half_angle_), 2);
    ++necks;
    bonded += neck.phase == dem::NeckPhase::bonded || neck.phase == dem::NeckPhase::arriving;
  }
  p.neck_state = squares / double(std::max<std::size_t>(1, necks));
  p.at_equilibrium = double(bonded) / double(std::max<std::size_t>(1, necks));
}

}  // namespace

double activation_of(const dem::Scene& element) {
  if (element.materials.size() != 1)
    throw InputError(
        "rve.materials: a table is of one material, whose temperature factors out of its viscosities; here are " +
        std::to_string(element.materials.size()));
  if (!element.contact.sintering)
    throw InputError("rve.contact: there is nothing to tabulate without [rve.contact.sintering]");
  return dem::complete_interface(element.materials, 0, 0, element.interfaces).activation_temperature;
}

Schedule path_schedule(const Schedule& process, const ElementPath& path, double activation) {
  const double peak = process.peak_temperature();
  if (peak < activation)
    throw InputError("process: its highest temperature does not activate sintering; there is nothing to tabulate");
  std::size_t last = 0;
  for (std::size_t k = 0; k < process.stages().size(); ++k)
    if (process.stages()[k].end_temperature == peak) last = k;
  std::vector<Stage> stages;
  double temperature = process.temperature(0);
  bool free = false;
  for (std::size_t k = 0; k <= last; ++k) {
    Stage stage = process.stages()[k];
    stage.end_pressure = free ? 0 : path.pressure_factor * stage.end_pressure;
    const double begin = temperature;
    temperature = stage.end_temperature;
    if (temperature != begin) stage.duration /= path.heating_factor;
    const double held = std::min(activation + holding, peak);
    if (path.kind == PathKind::free && !free && temperature >= held) {
      const double share = temperature > begin ? (held - begin) / (temperature - begin) : 0.0;
      if (share > 0) stages.push_back({"until necks hold", share * stage.duration, held, stage.end_pressure});
      stages.push_back({"letting go", letting_go, held, 0});
      free = true;
      stage.duration *= 1 - share;
      stage.end_pressure = 0;
      if (!(stage.duration > 0)) continue;
    }
    stages.push_back(stage);
  }
  stages.push_back({"further hold", path.longest_hold, peak, stages.back().end_pressure});
  return Schedule(process.temperature(0), 0, stages);
}

PathRecord run_path(const dem::Scene& element, const ElementPath& path, const std::function<void(double)>& watch) {
  const double activation = activation_of(element);
  PathRecord record{path_schedule(element.schedule, path, activation), {}};
  dem::Scene scene = element;
  scene.schedule = record.schedule;
  scene.cell_path = cell_path(scene.schedule, path.kind);
  const dem::GreenBody body = dem::make_specimen(scene, 1, [&](double) { watch(0); });
  dem::Simulation sim(dem::make_setup(scene, body, 1));
  Recorder recorder(scene, scene.schedule.peak_temperature());
  double next = -std::numeric_limits<double>::infinity(), birth = std::numeric_limits<double>::quiet_NaN();
  std::size_t stage = 0;
  for (std::uint64_t step = 0; !sim.finished(); ++step) {
    sim.advance();
    recorder.note(sim);
    const std::size_t now = scene.schedule.stage_at(sim.state().time);
    const bool stage_ends = now != stage;
    stage = now;
    if (step % look_interval != 0 && !stage_ends) continue;
    watch(sim.state().time / scene.schedule.end());
    const double density = dem::solid_volume_now(sim) / sim.state().cell.volume(), x = std::log(density);
    if (std::isnan(birth) && sim.temperature() >= activation) birth = x, next = x;
    if (x < next && !stage_ends) continue;
    if (const auto point = recorder.point(sim)) record.points.push_back(*point);
    next = x + (std::isnan(birth) ? cold_mark : std::clamp(growth * (x - birth), first_mark, most));
    if (density >= path.end_density) break;
  }
  return record;
}

}  // namespace densify::coupling
