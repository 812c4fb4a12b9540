#include "dem/forecast.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "dem/contact/force_pass.h"
#include "dem/integrate/time_step.h"
#include "dem/law/friction.h"

namespace densify::dem {

namespace {

/// The smallest grain of a material between two of mean size.
struct Grain {
  std::uint8_t material = 0;
  double radius = std::numeric_limits<double>::infinity();  ///< [m]
  double mass = 0;                                          ///< as integrated [kg]
  double reduced_mass = 0;                                  ///< with one of mean size [kg]
  bool necked = false;
  double neck = 0;  ///< of the viscous model [m]
};

/// Half of the mean diameter, every grain weighted by its volume. [m]
double volume_mean_radius(const PowderSample& powder) {
  double third = 0, fourth = 0;
  for (double d : powder.diameter) {
    third += d * d * d;
    fourth += d * d * d * d;
  }
  return 0.5 * fourth / third;
}

std::vector<Grain> smallest_grains(const Scene& scene, const PowderSample& powder, double mean_radius) {
  std::vector<Grain> grains(scene.materials.size());
  for (std::size_t p = 0; p < powder.diameter.size(); ++p) {
    Grain& g = grains[powder.material[p]];
    g.material = powder.material[p];
    g.radius = std::min(g.radius, 0.5 * powder.diameter[p]);
  }
  std::erase_if(grains, [](const Grain& g) { return std::isinf(g.radius); });
  for (Grain& g : grains) {
    const double sphere = 4.0 / 3 * M_PI * scene.materials[g.material].density * scene.integration.mass_scaling;
    g.mass = sphere * std::pow(g.radius, 3);
    const double other = sphere * std::pow(mean_radius, 3);
    g.reduced_mass = g.mass * other / (g.mass + other);
  }
  return grains;
}

/// Critical step of a grain whose contacts carry a force [s].
double limit_of(const Grain& g, const Scene& scene, const PairProperties& row, double mean_radius, double force,
                double contacts) {
  const ContactModel& model = scene.contact;
  const double radius = elastic_radius(model, g.radius, mean_radius);
  Linearisation l;
  l.stiffness = with_spring(model, row, [&](const auto& spring) {
    return std::max(spring.tangent(spring.displacement(-force, radius), radius), spring.reference_stiffness(radius));
  });
  const double ratio = g.necked ? model.sintering->damping_ratio : model.damping_ratio;
  l.damper = 2 * ratio * std::sqrt(g.reduced_mass * l.stiffness);
  const Linearisation across = tangential_share(l, model, g.reduced_mass);
  // The stiffest direction of three contacts evenly around the grain; fewer lie in one line.
  auto stiffest = [&](double k, double k_t) { return contacts < 3 ? contacts * std::max(k, k_t) : 1.5 * (k + k_t); };
  const double spring_limit =
      node_limit(g.mass, stiffest(l.stiffness, across.stiffness), stiffest(l.damper, across.damper));
  if (g.neck == 0) return spring_limit;
  const double viscosity = std::pow(g.neck, 4) / row.mobility_factor;
  return std::min(spring_limit, node_limit(g.mass, 0, contacts * viscosity));
}

/// d(a^6)/dt = 6 (8 D/pi) r (F_sint + F) (4.31, 4.36, 4.40) up to a_max, where the dashpot ends.
void grow_neck(Grain& g, const Scene& scene, const PairProperties& row, double mean_radius, double force, double step) {
  const double r = sintering_radius(scene.contact.sintering->radius, g.radius, mean_radius);
  const double drive = M_PI * row.surface_energy * (row.cap * r + row.sine * g.neck) + force;
  g.neck = std::min(std::pow(std::pow(g.neck, 6) + 6 * row.mobility_factor * r * drive * step, 1.0 / 6), row.sine * r);
}

/// The smallest grains and their surroundings along the schedule.
class MeanField {
 public:
  MeanField(const Scene& scene, const PowderSample& powder)
      : scene_(scene),
        table_(scene.materials, scene.interfaces, scene.contact),
        mean_radius_(volume_mean_radius(powder)),
        grains_(smallest_grains(scene, powder, mean_radius_)) {
    // The thesis's rule looks at one contact at a time; two spheres have only one.
    const double others = double(powder.diameter.size()) - 1;
    contacts_ = scene.integration.rule == StepRule::thesis ? 1.0 : std::clamp(others, 1.0, 3.0);
    for (const Load& l : scene.loads) load_ = std::max(load_, l.force.norm());
  }

  /// Critical step at a process time, `elapsed` after the last call; without any, before the first neck [s].
  double limit(double time, double elapsed) {
    table_.update(scene_.schedule.temperature(time), time);
    const double force = std::max(load_, scene_.schedule.pressure(time) * 4 * mean_radius_ * mean_radius_);
    double smallest = std::numeric_limits<double>::infinity();
    for (Grain& g : grains_) {
      const PairProperties& row = table_.row(g.material, g.material);
      if (elapsed > 0 && scene_.contact.sintering && row.active) {
        g.necked = true;
        if (scene_.contact.sintering->model == SinteringModel::viscous)
          grow_neck(g, scene_, row, mean_radius_, force, elapsed);
      }
      smallest = std::min(smallest, limit_of(g, scene_, row, mean_radius_, force, contacts_));
    }
    return smallest;
  }

 private:
  const Scene& scene_;
  PairTable table_;
  double mean_radius_;  // [m]
  std::vector<Grain> grains_;
  double contacts_ = 0;
  double load_ = 0;  // [N]
};

}  // namespace

Forecast forecast(const Scene& scene, const PowderSample& powder, double at_start) {
  MeanField field(scene, powder);  // checks that every property the model needs is there
  if (scene.integration.inertia == Inertia::equalised) {
    // The step is chosen and the masses follow.  The control knows its steps only when it runs; three quarters of the
    // largest one were the mean in hot pressing.
    const double step = std::isnan(scene.integration.inertia_measure)
                            ? scene.integration.fixed_step
                            : 0.75 * step_control(scene.integration, scene.schedule).largest_step;
    return {scene.schedule.end() / step, std::numeric_limits<double>::infinity()};
  }
  // A given specimen may hold its grains by more contacts than the mean field.
  const double share = std::min(1.0, at_start / field.limit(0, 0));
  const IntegrationSettings& settings = scene.integration;
  Forecast result;
  result.smallest_limit = at_start;
  constexpr int parts = 50;  // of a stage
  double begin = 0;
  for (std::size_t s = 0; s < scene.schedule.stages().size(); ++s) {
    const double end = scene.schedule.stage_end(s), part = (end - begin) / parts;
    for (int k = 0; k < parts; ++k) {
      const double limit = share * field.limit(begin + (k + 0.5) * part, part);
      result.smallest_limit = std::min(result.smallest_limit, limit);
      double step = std::isnan(settings.fixed_step) ? settings.step_safety * limit : settings.fixed_step;
      if (!std::isnan(settings.largest_step)) step = std::min(step, settings.largest_step);
      result.steps += part / step;
    }
    begin = end;
  }
  return result;
}

}  // namespace densify::dem
