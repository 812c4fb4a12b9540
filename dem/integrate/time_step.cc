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

namespace {

/// Sums of the contacts over each particle [N/m, N s/m].
struct Sums {
  std::vector<StiffnessSum> stiffness, damping;
};

/// Adds the contacts of one bucket; returns the smallest limit of a pair by the thesis's rule, infinite with the other.
template <class Law>
double add_bucket(const Law& law, const ContactList& list, const ContactList::Bucket& bucket,
                  const Particles& particles, const ImageShifts& shifts, const ContactModel& model, double time,
                  StepRule rule, Sums& sums) {
  double smallest = infinity;
  for (std::size_t k = bucket.begin; k < bucket.end; ++k) {
    const std::uint32_t i = list.i(k), j = list.j(k);
    const Body &a = particles.body[i], &b = particles.body[j];
    const double reach = a.radius + b.radius;
    const double d2 = (b.position - a.position + shifts[list.image(k)]).squaredNorm();
    bool bound = d2 < reach * reach;
    if constexpr (has_necks<Law>) bound = bound || list.neck[k].phase != NeckPhase::loose;
    if (!bound) continue;
    NormalInput in;
    in.overlap = std::sqrt(d2) - reach;
    in.rate = 0;  // enters forces, not stiffness, damper or viscosity
    in.elastic_radius = elastic_radius(model, a.radius, b.radius);
    in.sintering_radius = has_necks<Law> ? sintering_radius(model.sintering->radius, a.radius, b.radius) : 0;
    in.reduced_mass = 1 / (a.inverse_mass + b.inverse_mass);
    in.step = 0;
    in.time = time;
    Linearisation l;
    if constexpr (has_necks<Law>)
      l = law.linearise(in, list.neck[k]);
    else
      l = law.linearise(in);
    if (rule == StepRule::thesis) {
      smallest = std::min(smallest, thesis_limit(l, in.reduced_mass));
      continue;
    }
    if (std::isinf(l.stiffness)) l = {0, l.viscosity, 0, 0, 0};  // a viscous contact without spring
    const Linearisation across = tangential_share(l, model, in.reduced_mass);
    const Vec3 n = (b.position - a.position + shifts[list.image(k)]) / std::sqrt(d2);
    for (const std::uint32_t p : {i, j}) {
      sums.stiffness[p].add(l.stiffness, across.stiffness, n);
      sums.damping[p].add(l.damper, across.damper, n);
    }
  }
  return smallest;
}

}  // namespace

StepLimit critical_step(const Particles& particles, const ContactList& list, const Cell& cell, const PairTable& table,
                        const ContactModel& model, Walls& walls, const PunchNode& punch, PassTime clock,
                        StepRule rule) {
  const std::size_t n = particles.size();
  Sums sums{std::vector<StiffnessSum>(n), std::vector<StiffnessSum>(n)};
  const ImageShifts shifts(cell);
  double smallest_pair = infinity;
  for (const auto& bucket : list.buckets) {
    const PairProperties& row = table.row(bucket.material_a, bucket.material_b);
    with_law(model, row, !list.neck.empty(), [&](const auto& law) {
      smallest_pair =
          std::min(smallest_pair, add_bucket(law, list, bucket, particles, shifts, model, clock.time, rule, sums));
    });
  }
  walls.add_stiffness(particles, table, model, sums.stiffness, sums.damping);

  StepLimit limit;
  limit.critical = infinity;
  double stiffest = 0;  // light contact [N/m]
  for (std::size_t p = 0; p < n; ++p) {
    const Body& b = particles.body[p];
    // A particle about to touch must find the step small enough for its first contact.
    const PairProperties& like = table.row(particles.material[p], particles.material[p]);
    const double mass = 1 / b.inverse_mass;
    const Linearisation light = light_contact(model, like, b.radius, mass);
    const Linearisation across = tangential_share(light, model, 0.5 * mass);
    stiffest = std::max({stiffest, light.stiffness, across.stiffness});
    const double own =
        node_limit(mass, std::max({light.stiffness, across.stiffness, sums.stiffness[p].largest_eigenvalue()}),
                   std::max({light.damper, across.damper, sums.damping[p].largest_eigenvalue()}));
    if (own < limit.critical) limit = {own, std::uint32_t(p), 0};
  }
  if (rule == StepRule::thesis) limit.critical = std::min(smallest_pair, limit.critical);
  if (punch.mass > 0) {
    limit.punch_stiffness = walls.stiffness()[punch.wall];
    // The punch of a few particles is lighter than one of them: its first contact, with a rigid plane, is twice as
    // stiff as theirs.
    limit.critical = std::min(limit.critical, node_limit(punch.mass, std::max(limit.punch_stiffness, 2 * stiffest),
                                                         walls.damping()[punch.wall] + 0.5 * punch.own_damping));
  }
  return limit;
}

}  // namespace densify::dem
