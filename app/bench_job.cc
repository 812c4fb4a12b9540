#include "app/bench_job.h"

#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <ctime>

#include "base/data_path.h"
#include "dem/io/particle_import.h"
#include "dem/measure/measures.h"

namespace densify::app {

namespace {

constexpr double contact_stiffness = 1e5;
constexpr double normal_damping_rate = 250, tangential_damping_rate = 125;  // c over the reduced mass [1/s]
constexpr double mean_mass = 0.523598775598;                                // of a sphere of diameter and density 1
// The packings were relaxed with soft contacts; their worst pair overlaps by 0.175 of the smaller radius.
constexpr double largest_overlap = 0.2;
constexpr int repeats = 5;
constexpr std::uint64_t warm_up_steps = 200;
constexpr double seconds_of_repeat = 0.5;

/// Damping ratio with which two mean particles have c = rate x reduced mass.
double damping_ratio(double rate, double stiffness) {
  const double reduced_mass = 0.5 * mean_mass;
  return rate * reduced_mass / (2 * std::sqrt(reduced_mass * stiffness));
}

/// A material whose necks grow by about a tenth of the radius in the 1e4 steps of a run, and an elastic spring that
/// relaxes slowly enough for the packing to keep its contacts.
dem::Material bench_material() {
  dem::Material m;
  m.name = "sphere";
  m.density = 1;
  constexpr double temperature = 1000;
  m.diffusion.atomic_volume = dem::boltzmann_constant * temperature;  // D_eff = prefactor x width
  m.diffusion.prefactor = 1e-7;
  m.diffusion.activation_enthalpy = 0;
  m.diffusion.grain_boundary_width = 1;
  m.surface_energy = 1;
  m.dihedral_angle = 2.5656;
  m.activation_temperature = 900;
  return m;
}

double seconds_now(int threads) {
  if (threads > 1) return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
  timespec t;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return double(t.tv_sec) + 1e-9 * double(t.tv_nsec);
}

double seconds_of(dem::Simulation& simulation, std::uint64_t steps, const BenchJob& job) {
  constexpr std::uint64_t output_interval = 100;
  const double start = seconds_now(job.threads);
  dem::Recording recording;
  for (std::uint64_t s = 0; s < steps; ++s) {
    const bool row = job.feature == BenchFeature::output && s % output_interval == 0;
    simulation.evaluate(row ? &recording : nullptr);
    if (row) dem::measure(simulation, recording);
    simulation.move();
  }
  return seconds_now(job.threads) - start;
}

std::size_t peak_resident() {
  rusage usage;
  getrusage(RUSAGE_SELF, &usage);
  return std::size_t(usage.ru_maxrss) * 1024;
}

std::string name_of(BenchCase c) {
  return std::string(1, c == BenchCase::A ? 'A' : c == BenchCase::B ? 'B' : 'S');
}

void add_feature(dem::Setup& setup, BenchFeature feature) {
  using namespace dem;
  if (feature == BenchFeature::heating) {
    setup.materials[0].thermal_expansion = 1e-5;
    setup.schedule = Schedule(1000, 0, {{"bench", 1e6, 1100, 0}});
  }
  if (feature == BenchFeature::hertz) {
    // The stiffness k_n at an overlap of 0.01 of the reduced radius: k_n = 3/2 x 4/3 E* R sqrt(0.01), R = 1/4.
    setup.contact.elasticity = Elasticity::hertz;
    const double reduced_modulus = contact_stiffness / (2 * 0.25 * 0.1);
    setup.materials[0].youngs_modulus = PiecewiseLinear({{0.0, 2 * reduced_modulus}, {2000.0, 2 * reduced_modulus}});
    setup.materials[0].poissons_ratio = PiecewiseLinear({{0.0, 0.0}, {2000.0, 0.0}});
  }
  if (feature == BenchFeature::walls) {
    const double margin = 0.5;  // a radius, so that the particles at the faces touch the walls
    for (auto& b : setup.particles.body) b.position += Vec3::Constant(margin) - setup.cell.origin;
    setup.container.shape = ContainerShape::box;
    setup.container.size = setup.cell.h.diagonal() + Vec3::Constant(2 * margin);
    setup.container.punch = false;
    setup.cell = Cell{};
  }
  if (feature == BenchFeature::unguarded) setup.integration.guards.guarding = Guarding::off;
  if (feature == BenchFeature::shear) setup.cell.velocity_gradient(0, 1) = 1e-3;
}

}  // namespace

dem::Setup bench_setup(const BenchJob& job, const std::filesystem::path& packing_file) {
  using namespace dem;
  const ImportedParticles imported = read_lammps_data(packing_file, 1);
  Setup setup{{bench_material()}, {}, {}, {}, {}, Schedule(1000, 0, {{"bench", 1e9, 1000, 0}}), {}, 1000, {}, {}};
  setup.cell = imported.box.value();
  setup.container.shape = ContainerShape::periodic;
  reject_overlaps(imported, setup.cell, largest_overlap);
  const Mat3 h = setup.cell.h;
  setup.cell.h = h * job.copies.cast<double>().asDiagonal();
  const std::size_t particles = imported.size() * std::size_t(job.copies.prod());
  setup.particles.body.reserve(particles);
  setup.particles.reference_radius.reserve(particles);
  setup.particles.material.reserve(particles);
  setup.particles.id.reserve(particles);
  const auto add = [&](const Vec3& at, double radius) {
    setup.particles.id.push_back(std::uint32_t(setup.particles.body.size()));
    setup.particles.body.push_back({at, radius, Vec3::Zero(), 1});
    setup.particles.reference_radius.push_back(radius);
    setup.particles.material.push_back(0);
  };
  const Vec3 middle = setup.cell.wrap(setup.cell.origin + 0.5 * setup.cell.h * Vec3::Ones());
  if (job.giant > 0) add(middle, job.giant);
  for (int x = 0; x < job.copies[0]; ++x)
    for (int y = 0; y < job.copies[1]; ++y)
      for (int z = 0; z < job.copies[2]; ++z)
        for (std::size_t p = 0; p < imported.size(); ++p) {
          const Vec3 at = setup.cell.wrap(imported.position[p] + h * Vec3(x, y, z));
          constexpr double pressed = 0.02;  // of the radius of those left around a giant
          if (job.giant > 0 && (at - middle).norm() < job.giant + (1 - pressed) * imported.radius[p]) continue;
          add(at, imported.radius[p]);
        }

  setup.contact.elasticity = Elasticity::linear;
  setup.contact.normal_stiffness = contact_stiffness;
  setup.contact.damping_ratio = damping_ratio(normal_damping_rate, contact_stiffness);
  if (job.benchmark == BenchCase::B || job.feature == BenchFeature::friction) {
    FrictionModel friction;
    friction.coefficient = friction.wall_coefficient = 0.3;
    friction.tangential_stiffness_ratio = 0.2857;
    friction.tangential_damping_ratio =
        damping_ratio(tangential_damping_rate, friction.tangential_stiffness_ratio * contact_stiffness);
    setup.contact.friction = friction;
  }
  if (job.benchmark == BenchCase::S || job.feature == BenchFeature::sintering) {
    setup.contact.sintering = SinteringSettings{};
    setup.contact.sintering->relaxation_time = 0;
  }
  // 0.15 sqrt(m/k) of the lightest particle; the small ones of p1751 want a quarter of the others' step.
  const double smallest = *std::min_element(imported.radius.begin(), imported.radius.end());
  setup.integration.fixed_step = smallest < 0.4 ? 8e-5 : 3.2e-4;
  setup.integration.skin = 0.2;  // a tenth of the mean diameter
  setup.integration.threads = job.threads;
  add_feature(setup, job.feature);
  return setup;
}

BenchResult run_job(const BenchJob& job) {
  dem::Simulation simulation(bench_setup(job, data_path("benchmark/packings/" + job.packing + ".data")));
  BenchResult result;
  result.packing = job.packing;
  result.benchmark = name_of(job.benchmark);
  result.particles = simulation.state().particles.size();
  result.contacts_at_start = simulation.contacts_now();

  const double warm_up = seconds_of(simulation, warm_up_steps, job) / double(warm_up_steps);
  const std::uint64_t steps = job.steps > 0 ? job.steps : std::uint64_t(seconds_of_repeat / warm_up) + 1;
  std::vector<double> seconds;
  double contacts = double(result.contacts_at_start);
  for (int r = 0; r < repeats; ++r) {
    seconds.push_back(seconds_of(simulation, steps, job));
    contacts += double(simulation.contacts_now());
  }
  contacts /= repeats + 1;
  std::sort(seconds.begin(), seconds.end());
  const double median = seconds[repeats / 2];
  result.steps = repeats * steps;
  result.slowest_over_fastest = seconds.back() / seconds.front();
  result.particle_steps_per_s = double(result.particles) * double(steps) / median;
  result.contacts_at_end = simulation.contacts_now();
  result.coordination_number = 2 * contacts / double(result.particles);
  result.ns_per_contact_step = 1e9 * median / double(steps) / contacts;
  result.bytes_per_particle = double(simulation.bytes()) / double(result.particles);
  result.list_pairs = double(simulation.state().contacts.size()) / double(result.contacts_at_end);
  result.near_pairs = double(simulation.near_pairs()) / double(result.contacts_at_end);
  result.peak_resident = peak_resident();
  constexpr std::size_t largest_checked = 30000;  // the double loop grows with the square of the number
  if (job.feature == BenchFeature::none && result.particles <= largest_checked)
    result.force_check = force_deviation(simulation);
  result.list_builds = simulation.state().contacts.builds;
  return result;
}

std::string to_json(const BenchResult& r) {
  return fmt::format(
      R"({{"packing": "{}", "case": "{}", "particles": {}, "coordination_number": {:.4f}, )"
      R"("ns_per_contact_step": {:.3f}, "particle_steps_per_s": {:.6g}, "bytes_per_particle": {:.1f}, )"
      R"("list_builds": {}, "force_check": {:.3g}, "contacts_at_start": {}, "contacts_at_end": {}, "steps": {}, )"
      R"("slowest_over_fastest": {:.3f}, "list_pairs_per_contact": {:.3f}, "near_pairs_per_contact": {:.3f}, )"
      R"("peak_resident_bytes": {}}})",
      r.packing, r.benchmark, r.particles, r.coordination_number, r.ns_per_contact_step, r.particle_steps_per_s,
      r.bytes_per_particle, r.list_builds, r.force_check, r.contacts_at_start, r.contacts_at_end, r.steps,
      r.slowest_over_fastest, r.list_pairs, r.near_pairs, r.peak_resident);
}

}  // namespace densify::app
