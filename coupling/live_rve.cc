#include "coupling/live_rve.h"

#include <cmath>

#include "base/check.h"
#include "dem/io/state_image.h"
#include "dem/specimen.h"

namespace densify::coupling {

namespace {

constexpr double same_time = 1e-9;  // of a step: sums of steps miss the end of a stage by rounding

void require_movable(const dem::Scene& scene) {
  if (scene.container.shape != dem::ContainerShape::periodic)
    throw InputError("rve.specimen.shape: a live volume element is a periodic cell; set shape = \"periodic\"");
  if (scene.contact.friction)
    throw InputError(
        "rve.contact.friction: a live volume element moves without inertia and rotations; remove the table");
}

/// What an `accuracy` stands for where an owner moves the cell: the error of a step, a skin that long steps do not
/// leave, and masses that swing on stiff contacts within 2e-6 of the process, at any size: they hold what rearranges.
void choose_live_settings(dem::Setup& setup) {
  constexpr double step_share = 1.0 / 3, balance = 1e-2, skin = 1, swing = 2e-6;
  dem::IntegrationSettings& s = setup.integration;
  s.inertia_free.step_tolerance = step_share * s.accuracy;
  s.inertia_free.force_tolerance = balance;
  s.skin = skin;
  double mass = 0, stiffness = 0;
  for (std::size_t p = 0; p < setup.particles.size(); ++p) {
    const dem::Material& m = setup.materials[setup.particles.material[p]];
    const double r = setup.particles.reference_radius[p];
    mass += m.density * 4.0 / 3 * M_PI * r * r * r;
    stiffness += m.youngs_modulus(setup.schedule.temperature(0)) * r;
  }
  s.mass_scaling = stiffness * std::pow(swing * setup.schedule.end(), 2) / (s.inertia_free.mass_share * mass);
}

dem::Setup moved_by_an_owner(const dem::Scene& scene, const dem::GreenBody& body) {
  require_movable(scene);
  dem::Setup setup = dem::make_setup(scene, body, 1);
  setup.integration.method = dem::IntegrationMethod::inertia_free;
  setup.integration.inertia_free.from = dem::InertiaFreeFrom::start;
  setup.integration.inertia = dem::Inertia::uniform;
  if (!std::isnan(setup.integration.accuracy)) choose_live_settings(setup);
  setup.cell_path.reset();
  setup.cell.velocity_gradient.setZero();
  return setup;
}

Mat3 tensor(const Vec6& e) {
  Mat3 t;
  t << e[0], 0.5 * e[5], 0.5 * e[4], 0.5 * e[5], e[1], 0.5 * e[3], 0.5 * e[4], 0.5 * e[3], e[2];
  return t;
}

}  // namespace

dem::GreenBody pressed_powder(const dem::Scene& scene, std::uint64_t seed, double pressure) {
  require_movable(scene);
  dem::Scene one = scene;
  if (one.packing) one.packing->seed = seed;
  dem::GreenBody body = dem::make_specimen(one, 1, {});
  dem::perturb(body, one.perturbation);

  dem::Setup setup = dem::make_setup(one, body, 1);
  setup.contact.sintering.reset();  // loose, however warm
  constexpr double accuracy = 3e-3;
  dem::choose_settings(setup.integration, accuracy);
  setup.integration.method = dem::IntegrationMethod::leapfrog;
  setup.integration.fixed_step = setup.integration.largest_step = setup.integration.smallest_step = dem::unset;
  // Time has no meaning to loose particles; a stage to press them and one to come to rest.
  const double temperature = scene.schedule.temperature(0);
  setup.schedule =
      Schedule(temperature, 0, {{"pressing", 1000, temperature, pressure}, {"rest", 500, temperature, pressure}});
  dem::CellGoals goals;
  goals[2] = {dem::CellControl::stress, -pressure};
  setup.cell_path = dem::CellPath{{}, {goals, goals}};
  dem::Simulation sim(std::move(setup));
  while (!sim.finished()) sim.advance();

  const dem::State& s = sim.state();
  body.cell = s.cell;
  body.cell.velocity_gradient.setZero();
  body.particles.body = s.particles.body;
  body.particles.reference_radius = s.particles.reference_radius;
  body.particles.material = s.particles.material;
  body.particles.id = s.particles.id;
  for (dem::Body& b : body.particles.body) b.velocity.setZero();
  return body;
}

LiveRve::LiveRve(const dem::Scene& scene, const dem::GreenBody& body)
    : sim_(moved_by_an_owner(scene, body)), accepted_(sim_.state()) {}

Vec6 LiveRve::try_step(const Vec6& strain, double end) {
  const double step = end - accepted_.time;
  const double breakpoint = sim_.setup().schedule.next_breakpoint(accepted_.time);
  if (std::abs(end - breakpoint) < same_time * step) end = breakpoint;
  Eigen::VectorXd guess;
  if (velocities_.size() > 0 && foretold_end_ == end)
    guess = velocities_ + motion_ * ((strain - foretold_strain_) / step);
  velocities_.resize(0);
  sim_.restore(accepted_);
  answer_ = sim_.strain({tensor(strain) / step, end, guess.size() > 0 ? &guess : nullptr});
  foretold_end_ = end, foretold_step_ = step, foretold_strain_ = strain;
  return answer_.stress;
}

Mat6 LiveRve::tangent() {
  dem::CellTangent t = sim_.strain_tangent();
  if (answer_.steps == 1) {
    velocities_ = sim_.strain_velocities();
    motion_ = std::move(t.motion);
  }
  return t.stress / foretold_step_;
}

void LiveRve::accept() {
  const double before = accepted_.time;
  accepted_ = sim_.state();
  rate_ = foretold_strain_ / foretold_step_;
  step_ = accepted_.time < sim_.setup().schedule.next_breakpoint(before) ? foretold_step_ : 0;
  velocities_.resize(0);
}

LiveRve::Carried LiveRve::carried(double end) const {
  if (step_ == 0 || accepted_.contacts.neck.empty()) return {};
  const double step = end - accepted_.time;
  return {step * rate_, step / (step + step_)};
}

double LiveRve::density() const {
  double solid = 0;
  for (const double r : accepted_.particles.reference_radius) solid += 4.0 / 3 * M_PI * r * r * r;
  return solid * solid_growth(sim_.setup().schedule.temperature(accepted_.time)) / accepted_.cell.volume();
}

double LiveRve::solid_growth(double temperature) const {
  const auto& setup = sim_.setup();
  const dem::Particles& p = accepted_.particles;
  double cold = 0, warm = 0;
  for (std::size_t k = 0; k < p.size(); ++k) {
    const double cube = std::pow(p.reference_radius[k], 3);
    const double growth =
        1 + setup.materials[p.material[k]].thermal_expansion * (temperature - setup.reference_temperature);
    cold += cube;
    warm += cube * std::pow(growth, 3);
  }
  return warm / cold;
}

std::string LiveRve::image() const {
  dem::Hdf5Writer file("volume element");
  dem::write_state(file, accepted_);
  std::vector<double> motion(rate_.begin(), rate_.end());
  motion.push_back(step_);
  file.list("motion", motion, "");
  return file.image();
}

void LiveRve::restore(const std::string& image) {
  const dem::Hdf5Reader file("volume element", image);
  accepted_ = dem::read_state(file, sim_);
  const auto motion = file.read<double>("motion");
  if (motion.size() != 7) throw FileError("volume element: 7 numbers of its motion are needed");
  rate_ = Eigen::Map<const Vec6>(motion.data());
  step_ = motion[6];
  velocities_.resize(0);
}

std::size_t LiveRve::bytes() const {
  const std::size_t state = sim_.bytes();  // with what belongs to the steps
  return 2 * state + std::size_t(velocities_.size() + motion_.size()) * sizeof(double);
}

}  // namespace densify::coupling
