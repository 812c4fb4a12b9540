#include "dem/integrate/time_step.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace densify::dem {

namespace {
constexpr double infinity = std::numeric_limits<double>::infinity();
// A rolling and sliding solid sphere answers a tangential spring with 1/m + r^2/J = 3.5/m.
constexpr double rotation_factor = 3.5;
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
  const double tangential = model.friction ? rotation_factor * model.friction->tangential_stiffness_ratio : 0.0;
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
        if (rule == StepRule::thesis) smallest_pair = std::min(smallest_pair, thesis_limit(l, in.reduced_mass));
        const double factor = std::max(1.0, tangential);
        const bool dashpot = std::isinf(l.stiffness);  // a viscous contact without spring
        const double k_sum = dashpot ? 0.0 : factor * l.stiffness, c_sum = dashpot ? l.viscosity : factor * l.damper;
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
    const double light = with_spring(model, table.row(particles.material[p], particles.material[p]),
                                     [&](const auto& s) { return s.reference_stiffness(b.radius); });
    const double own = node_limit(1 / b.inverse_mass, std::max(light, stiffness[p]), damping[p]);
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
