#include "dem/integrate/time_step.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "dem/law/friction.h"

namespace densify::dem {

namespace {
constexpr double infinity = std::numeric_limits<double>::infinity();
/// What a contact that forms between two evaluations brings with it: a light contact of two like particles.
Linearisation light_contact(const ContactModel& model, const PairProperties& row, double radius, double mass) {
  const bool sinters = model.sintering && row.active;
  const double ratio = sinters ? model.sintering->damping_ratio : model.damping_ratio;
  Linearisation l;
  l.stiffness = with_spring(model, row, [&](const auto& s) { return s.reference_stiffness(radius); });
  l.damper = 2 * ratio * std::sqrt(0.5 * mass * l.stiffness);
  return l;
}
}  // namespace

double node_limit(double mass, double stiffness, double damping) {
  // The positive root of the quadratic without the difference that cancels when damping rules.
  return 2 * mass / (std::sqrt(damping * damping + 2 * stiffness * mass) + damping);
}

double thesis_limit(const Linearisation& l, double m) {
  if (std::isinf(l.stiffness)) return 4 * m / l.viscosity;
  if (l.stiffness <= 0) return infinity;
  const double omega = std::sqrt(l.stiffness / m);
  const double xi = l.damper / (2 * std::sqrt(m * l.stiffness));
  return std::min(2 / omega * (std::sqrt(1 + xi * xi) - xi), l.viscosity / l.stiffness);
}

StepLimit critical_step(const Particles& particles, const ContactList& list, const Cell& cell, const PairTable& table,
                        const ContactModel& model, Walls& walls, const PunchNode& punch, PassTime clock,
                        StepRule rule) {
  const std::size_t n = particles.size();
  std::vector<double> stiffness(n, 0.0), damping(n, 0.0);
  const std::vector<double> no_growth(table.materials(), 0.0);
  double smallest_pair = infinity;

  for (const auto& bucket : list.buckets)
    with_spring(model, table.row(bucket.material_a, bucket.material_b), [&](const auto& spring) {
      using Spring = std::decay_t<decltype(spring)>;
      const KelvinVoigt<Spring> loose{spring, model.damping_ratio};
      for (std::size_t k = bucket.begin; k < bucket.end; ++k) {
        const NormalInput in = normal_input(model, particles, list, cell, no_growth, clock, k);
        Linearisation l;
        if (list.neck.empty())
          l = loose.linearise(in);
        else
          l = make_sintering<Spring>(model, table.row(bucket.material_a, bucket.material_b))
                  .linearise(in, list.neck[k]);
        if (rule == StepRule::thesis) {
          smallest_pair = std::min(smallest_pair, thesis_limit(l, in.reduced_mass));
          continue;
        }
        const bool dashpot = std::isinf(l.stiffness);  // a viscous contact without spring
        if (!dashpot) l = with_tangential_share(l, model, in.reduced_mass);
        const double k_sum = dashpot ? 0.0 : l.stiffness, c_sum = dashpot ? l.viscosity : l.damper;
        for (std::uint32_t p : {list.i(k), list.j(k)}) {
          stiffness[p] += k_sum;
          damping[p] += c_sum;
        }
      }
    });
  walls.add_stiffness(particles, table, model, stiffness, damping);

  StepLimit limit;
  limit.critical = infinity;
  for (std::size_t p = 0; p < n; ++p) {
    const Body& b = particles.body[p];
    // A particle about to touch must find the step small enough for its first contact.
    const PairProperties& like = table.row(particles.material[p], particles.material[p]);
    const double mass = 1 / b.inverse_mass;
    const Linearisation light = with_tangential_share(light_contact(model, like, b.radius, mass), model, 0.5 * mass);
    const double own = node_limit(mass, std::max(light.stiffness, stiffness[p]), std::max(light.damper, damping[p]));
    if (own < limit.critical) limit = {own, std::uint32_t(p), 0};
  }
  if (rule == StepRule::thesis) limit.critical = std::min(smallest_pair, limit.critical);
  if (punch.mass > 0) {
    limit.punch_stiffness = walls.stiffness()[punch.wall];
    limit.critical = std::min(limit.critical, node_limit(punch.mass, limit.punch_stiffness,
                                                         walls.damping()[punch.wall] + 0.5 * punch.own_damping));
  }
  return limit;
}

}  // namespace densify::dem
