#pragma once
// Every contact of an RVE once, with its law, for whoever builds a system of them outside the hot pass.

#include "dem/boundary/walls.h"

namespace densify::dem {

/// What a contact network is read from; all references must outlive it.
struct ContactWorld {
  const Particles& particles;
  const ContactList& list;
  const Cell& cell;
  const PairTable& table;
  const ContactModel& model;
  const Walls& walls;
  PoreClosure pores = {};
};

/// A contact, or a pair about to be one, as a visitor meets it.
struct ContactView {
  std::uint32_t i, j;  ///< particles; at a wall j is the wall's index
  bool at_wall;
  std::size_t place;  ///< in the contact list, or among the walls' contacts
  Vec3 normal;        ///< from i to j, or to the wall
  Vec3 branch;        ///< from centre to centre, or from centre to wall [m]
  NormalInput input;  ///< at the present positions: rate, step and time are 0
};

namespace detail {

template <class Law, class Visit>
void visit_bucket(const ContactWorld& w, const ContactList::Bucket& bucket, const ImageShifts& shifts, const Law& law,
                  double reach, Visit& visit) {
  for (std::size_t k = bucket.begin; k < bucket.end; ++k) {
    const std::uint32_t i = w.list.i(k), j = w.list.j(k);
    const Body &a = w.particles.body[i], &b = w.particles.body[j];
    const Vec3 branch = b.position - a.position + shifts[w.list.image(k)];
    const NeckHistory* neck = nullptr;
    if constexpr (has_necks<Law>) neck = &w.list.neck[k];
    const bool necked = neck && neck->phase != NeckPhase::loose;
    const double sum = a.radius + b.radius, d2 = branch.squaredNorm();
    if (!necked && d2 >= (sum + reach) * (sum + reach)) continue;
    const double d = std::sqrt(d2);
    NormalInput in;
    in.overlap = d - sum;
    in.rate = in.step = in.time = 0;
    in.elastic_radius = elastic_radius(w.model, a.radius, b.radius);
    in.sintering_radius = neck ? sintering_radius(w.model.sintering->radius, a.radius, b.radius) : 0.0;
    in.reduced_mass = 1 / (a.inverse_mass + b.inverse_mass);
    in.flow_share = w.pores.share(i, j);
    visit(ContactView{i, j, false, k, branch / d, branch, in}, law, neck);
  }
}

}  // namespace detail

/// Calls visit(ContactView, law, neck) for every pair that touches, is joined by a neck or is closer than touching +
/// `reach` [m], then for every particle as close to a wall; `neck` is null where the law has none.
template <class Visit>
void visit_contacts(const ContactWorld& w, double reach, Visit&& visit) {
  const ImageShifts shifts(w.cell);
  for (const auto& bucket : w.list.buckets) {
    const PairProperties& row = w.table.row(bucket.material_a, bucket.material_b);
    with_law(w.model, row, !w.list.neck.empty(),
             [&](const auto& law) { detail::visit_bucket(w, bucket, shifts, law, reach, visit); });
  }
  std::vector<double> moduli;
  if (!w.walls.contacts().empty())
    for (std::size_t m = 0; m < w.table.materials(); ++m)
      moduli.push_back(w.walls.modulus(w.table, w.model, std::uint8_t(m)));
  for (std::size_t c = 0; c < w.walls.contacts().size(); ++c) {
    const WallContact& contact = w.walls.contacts()[c];
    const Body& b = w.particles.body[contact.particle];
    Vec3 n;
    const double gap = Walls::gap(w.walls.wall[contact.wall], b.position, n);
    if (gap >= b.radius + reach) continue;
    const NeckHistory* const none = nullptr;
    with_wall_law(w.model, moduli[w.particles.material[contact.particle]], [&](const auto& law) {
      visit(ContactView{contact.particle, contact.wall, true, c, n, gap * n, wall_input(b, gap, 0, {0, 0})}, law, none);
    });
  }
}

}  // namespace densify::dem
