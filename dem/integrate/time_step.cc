#include "dem/integrate/time_step.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "dem/law/friction.h"
#include "dem/parallel.h"

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

/// What the limits of all contacts need.
struct Pass {
  const Particles& particles;
  const ContactList& list;
  const PassPairs& pairs;
  const ImageShifts& shifts;
  const ContactModel& model;
  double time;
  StepRule rule;
};

/// The sums of one chunk: of its own particles and those it has for others.
struct ChunkSums {
  NodeSums *own, *others;
  std::size_t size;  // own particles

  NodeSums& operator[](std::size_t slot) const { return slot < size ? own[slot] : others[slot - size]; }
};

/// Adds near pairs begin to end of one chunk to its sums; returns the smallest limit of a pair by the thesis's rule,
/// infinite with the other.
template <class Law>
double add_pairs(const Law& law, const Pass& pass, std::size_t begin, std::size_t end, const ChunkSums& sums) {
  double smallest = infinity;
  const ContactList& list = pass.list;
  const auto& places = pass.pairs.near.places();
  constexpr std::size_t ahead = 32;  // pairs, to ask for a body that may be far away
  for (std::size_t n = begin; n < end; ++n) {
    const std::size_t k = places[n];
    if (n + ahead < end) __builtin_prefetch(&pass.particles.body[list.j(places[n + ahead])]);
    const Body &a = pass.particles.body[list.i(k)], &b = pass.particles.body[list.j(k)];
    const double reach = a.radius + b.radius;
    const Vec3 branch = b.position - a.position + pass.shifts[list.image(k)];
    const double d2 = branch.squaredNorm();
    bool bound = d2 < reach * reach;
    if constexpr (has_necks<Law>) bound = bound || list.neck[k].phase != NeckPhase::loose;
    if (!bound) continue;
    const double d = std::sqrt(d2);
    NormalInput in;
    in.overlap = d - reach;
    in.rate = 0;  // enters forces, not stiffness, damper or viscosity
    in.elastic_radius = elastic_radius(pass.model, a.radius, b.radius);
    in.sintering_radius = has_necks<Law> ? sintering_radius(pass.model.sintering->radius, a.radius, b.radius) : 0;
    in.reduced_mass = 1 / (a.inverse_mass + b.inverse_mass);
    in.step = 0;
    in.time = pass.time;
    in.flow_share = pass.pairs.pores.share(list.i(k), list.j(k));
    Linearisation l;
    if constexpr (has_necks<Law>)
      l = law.linearise(in, list.neck[k]);
    else
      l = law.linearise(in);
    if (pass.rule == StepRule::thesis) {
      smallest = std::min(smallest, thesis_limit(l, in.reduced_mass));
      continue;
    }
    if (std::isinf(l.stiffness)) l = {0, l.viscosity, 0, 0, 0};  // a viscous contact without spring
    const Linearisation across = tangential_share(l, pass.model, in.reduced_mass);
    const Vec3 normal = branch / d;
    NodeSums &of_i = sums[pass.pairs.chunks.offsets_i()[n] / 8], &of_j = sums[pass.pairs.chunks.offsets_j()[n] / 8];
    for (NodeSums* const sum : {&of_i, &of_j}) {
      sum->stiffness.add(l.stiffness, across.stiffness, normal);
      sum->damping.add(l.damper, across.damper, normal);
    }
  }
  return smallest;
}

/// Sums of the contacts over each particle, chunk by chunk as a pass does; returns as add_pairs.
double add_contacts(const Pass& pass, const PairTable& table, int threads, std::vector<NodeSums>& sums) {
  const Chunks& chunks = pass.pairs.chunks;
  std::vector<NodeSums> for_others(chunks.others().size());
  const double smallest = -largest_of_parts(chunks.count(), threads, [&](std::size_t first, std::size_t last) {
    double smallest_here = infinity;
    for (std::size_t c = first; c < last; ++c) {
      const ChunkSums of_chunk{sums.data() + chunks.begin(c), for_others.data() + chunks.others_begin(c),
                               chunks.size(c)};
      for (std::size_t b = 0; b < pass.list.buckets.size(); ++b) {
        const auto& bucket = pass.list.buckets[b];
        with_law(pass.model, table.row(bucket.material_a, bucket.material_b), !pass.list.neck.empty(),
                 [&](const auto& law) {
                   smallest_here = std::min(
                       smallest_here, add_pairs(law, pass, chunks.near_begin(b, c), chunks.near_end(b, c), of_chunk));
                 });
      }
    }
    return -smallest_here;
  });
  in_parts(chunks.count(), threads, [&](std::size_t first, std::size_t last) {
    for (std::size_t c = first; c < last; ++c)
      for (const auto& part : chunks.incoming(c))
        for (std::size_t k = part.begin; k < part.end; ++k) sums[chunks.others()[k]] += for_others[k];
  });
  return smallest;
}

/// The limit of particles begin to end; `stiffest` becomes the stiffest light contact of them [N/m].
StepLimit smallest_limit(const Particles& particles, const PairTable& table, const ContactModel& model,
                         const std::vector<NodeSums>& sums, std::size_t begin, std::size_t end, double& stiffest) {
  StepLimit limit;
  limit.critical = infinity;
  for (std::size_t p = begin; p < end; ++p) {
    const Body& b = particles.body[p];
    // A particle about to touch must find the step small enough for its first contact.
    const PairProperties& like = table.row(particles.material[p], particles.material[p]);
    const double mass = 1 / b.inverse_mass;
    const Linearisation light = light_contact(model, like, b.radius, mass);
    const Linearisation across = tangential_share(light, model, 0.5 * mass);
    stiffest = std::max({stiffest, light.stiffness, across.stiffness});
    const double k = std::max({light.stiffness, across.stiffness, sums[p].stiffness.largest_eigenvalue()});
    const double c = std::max({light.damper, across.damper, sums[p].damping.largest_eigenvalue()});
    constexpr double rounding = 1e-12;  // the limit of most particles is clearly above: no root, no division
    if ((k * limit.critical + 2 * c) * limit.critical < 2 * mass * (1 - rounding)) continue;
    const double own = node_limit(mass, k, c);
    if (own < limit.critical) limit = {own, std::uint32_t(p), 0, {}};
  }
  return limit;
}

/// In one order for every number of threads.
CellStiffness cell_stiffness(const Particles& particles, const PairTable& table, const ContactModel& model,
                             const std::vector<NodeSums>& sums) {
  CellStiffness cell;
  for (std::size_t p = 0; p < particles.size(); ++p) {
    const Body& b = particles.body[p];
    const double twice_square = 2 * b.radius * b.radius;
    cell.stiffness.add(sums[p].stiffness, twice_square);
    cell.damping.add(sums[p].damping, twice_square);
    const Linearisation light =
        light_contact(model, table.row(particles.material[p], particles.material[p]), b.radius, 1 / b.inverse_mass);
    cell.ready_stiffness += twice_square * light.stiffness;
    cell.ready_damping += twice_square * light.damper;
  }
  return cell;
}

}  // namespace

StepLimit critical_step(const Particles& particles, const ContactList& list, const PassPairs& pairs, const Cell& cell,
                        const PairTable& table, const ContactModel& model, Walls& walls, const PunchNode& punch,
                        PassTime clock, StepRule rule, int threads) {
  const std::size_t n = particles.size();
  std::vector<NodeSums> sums(n);
  const ImageShifts shifts(cell);
  const double smallest_pair =
      add_contacts({particles, list, pairs, shifts, model, clock.time, rule}, table, threads, sums);
  walls.add_stiffness(particles, table, model, sums);

  const std::size_t parts = std::size_t(threads);
  std::vector<StepLimit> limits(parts);
  std::vector<double> stiffests(parts);  // light contacts [N/m]
  in_parts(parts, threads, [&](std::size_t t, std::size_t) {
    limits[t] = smallest_limit(particles, table, model, sums, detail::part(n, int(t), threads),
                               detail::part(n, int(t) + 1, threads), stiffests[t]);
  });
  StepLimit limit = limits[0];
  for (const StepLimit& l : limits)
    if (l.critical < limit.critical) limit = l;
  const double stiffest = *std::max_element(stiffests.begin(), stiffests.end());
  if (cell.periodic) limit.cell = cell_stiffness(particles, table, model, sums);
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
