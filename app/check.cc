#include "app/check.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "base/check.h"
#include "dem/integrate/time_step.h"
#include "dem/specimen.h"
#include "dem/specimen_report.h"

namespace densify::app {

namespace {

// For a forecast before any packing exists: a pressed powder has about seven contacts a particle of mean size, their
// number grows with the surface, and their springs are compressed by about 3 % of the radius (hot pressing of NiAl at
// 30 MPa).  Measured cost of a particle and step on one core of a 2020s x86-64: about 1e-7 s.
constexpr double contacts_when_pressed = 7, elastic_overlap = 0.03, seconds_per_particle_step = 1e-7;
constexpr double bytes_per_particle = 600, bytes_of_record = 1100;

double forecast_limit(const dem::Scene& scene, const dem::PowderSample& powder) {
  dem::PairTable table(scene.materials, scene.interfaces, scene.contact);
  table.update(scene.schedule.temperature(0), 0);
  double mean = 0, limit = std::numeric_limits<double>::infinity();
  for (double d : powder.diameter) mean += 0.5 * d / double(powder.diameter.size());
  for (std::size_t p = 0; p < powder.diameter.size(); ++p) {
    const double r = 0.5 * powder.diameter[p];
    const std::uint8_t m = powder.material[p];
    const double mass = scene.integration.mass_scaling * scene.materials[m].density * 4.0 / 3 * M_PI * r * r * r;
    const double k = dem::with_spring(scene.contact, table.row(m, m), [&](const auto& spring) {
      return spring.tangent(-elastic_overlap * r, 0.5 * r);
    });
    const double contacts = std::max(4.0, contacts_when_pressed * (r / mean) * (r / mean));
    limit = std::min(limit, dem::node_limit(mass, contacts * k, 0));
  }
  return limit;
}

int check(const dem::Scene& scene, const CheckCommand& command) {
  const dem::PowderSample powder = dem::particles_of(scene);
  const auto n = double(powder.diameter.size());
  double limit;
  if (scene.import) {
    const dem::GreenBody body = dem::make_specimen(scene, command.threads, {});
    dem::Simulation sim(dem::make_setup(scene, body, command.threads));
    sim.require_stable_step();
    limit = sim.step_limit().critical;
    for (const auto& line : dem::report_on(body, scene.materials).lines) fmt::print("{}\n", line);
    fmt::print("critical step at the start      {:.4g} s\n", limit);
  } else {
    // Constructing the table checks that every property the model needs is there.
    limit = forecast_limit(scene, powder);
    fmt::print("particles                       {:.0f}\n", n);
    fmt::print("critical step when pressed      {:.4g} s (forecast: {:.0f} contacts at {:.0f} % elastic overlap)\n",
               limit, contacts_when_pressed, 100 * elastic_overlap);
  }
  double step =
      std::isnan(scene.integration.fixed_step) ? scene.integration.step_safety * limit : scene.integration.fixed_step;
  // The control knows its steps only when it runs: a third of the largest one was the mean in hot pressing.
  if (!std::isnan(scene.integration.inertia_measure))
    step = dem::step_control(scene.integration, scene.schedule).largest_step / 3;
  const double steps = scene.schedule.end() / step;
  const double bytes = n * (bytes_per_particle + (command.threads > 1 ? bytes_of_record : 0));
  fmt::print("process time                    {:.6g} s in {} stages, peak temperature {:.1f} K\n", scene.schedule.end(),
             scene.schedule.stages().size(), scene.schedule.peak_temperature());
  fmt::print("steps                           about {:.2g} of {:.3g} s\n", steps, step);
  fmt::print("memory                          about {:.3g} MB for the state\n", bytes * 1e-6);
  fmt::print("time                            about {:.2g} s on {} thread{} (at 1e-7 s a particle and step)\n",
             steps * n * seconds_per_particle_step / command.threads, command.threads, command.threads == 1 ? "" : "s");
  fmt::print("the scene is valid\n");
  return 0;
}

}  // namespace

int check_command(const CheckCommand& command) {
  const dem::Scene scene = dem::read_scene(command.scene, command.overrides);
  try {
    return check(scene, command);
  } catch (const InputError& error) {
    throw InputError(scene.placed(error.what()));
  }
}

}  // namespace densify::app
