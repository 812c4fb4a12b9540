#include "dem/contact/single_pairs.h"

#include <algorithm>

namespace densify::dem {

namespace {

using Triple = TripleOf<double>;

Triple triple(const double* p) {
  return {p[0], p[1], p[2]};
}

void put(double* row, const Triple& v) {
  row[0] = v.x, row[1] = v.y, row[2] = v.z, row[3] = 0;
}

/// What one pair gives to i and j, rows as in KernelJob::sums.
struct Given {
  double i[8] = {}, j[8] = {}, stiffness[8] = {};
};

/// Fills the parts of a record that no force needs.
template <class Law>
void keep(const Law& law, const FrameOf<double>& frame, const NormalForce& f, const NeckHistory* neck,
          ContactRecord& record) {
  record.normal = f.total;
  record.sintering = f.sintering;
  record.touching = true;
  double u = frame.in.overlap;
  bool springs = true;  // a viscous contact has no spring to store energy in
  if constexpr (has_necks<Law>) {
    if (neck->phase != NeckPhase::loose) {
      u = neck->elastic;
      springs = law.settings.model != SinteringModel::viscous || !Law::flows(neck->phase);
    } else if (u >= 0) {
      springs = false;  // the neck was lost in this very step
    }
  }
  const auto kept = spring_record(law, frame, f, u, springs);
  record.damping = kept.damping;
  record.elastic_energy = kept.energy;
}

/// The near pair at a place.
template <class Law, bool friction>
void pair(const KernelJob& job, std::size_t near, Given& given) {
  const Law& law = *static_cast<const Law*>(job.law);
  const std::uint32_t place = job.place[near], coded = job.second[place];
  const std::uint32_t i = job.first_particle + job.offset_i[near] / 8;
  const std::uint32_t j = coded & ContactList::index_mask;
  const double *a = job.body + 8 * std::size_t(i), *b = job.body + 8 * std::size_t(j);
  PairOf<double> pair;
  pair.branch = triple(b) - triple(a) + triple(job.shift + 4 * (coded >> ContactList::index_bits));
  pair.reach = b[3] + a[3];
  pair.radius_i = a[3], pair.radius_j = pair.reach - a[3];
  pair.inverse_masses = b[7] + a[7];
  const double d2 = dot(pair.branch, pair.branch);
  NeckHistory* neck = nullptr;
  bool necked = false;
  if constexpr (has_necks<Law>) {
    neck = job.neck + place;
    necked = neck->phase != NeckPhase::loose;
  }
  double* const sheared = friction ? job.tangential + 3 * std::size_t(place) : nullptr;
  if (!(d2 < pair.reach * pair.reach) && !necked) {
    if constexpr (friction) sheared[0] = sheared[1] = sheared[2] = 0;
    return;
  }
  pair.velocity = triple(b + 4) - triple(a + 4);
  if (job.gradient) add_flow(pair, job.gradient);
  FrameOf<double> frame = frame_of(law, job.uniform, pair, d2);
  frame.in.flow_share = job.pores.share(i, j);
  if (job.growing) {
    const bool swapped = job.material[i] != job.material_a;
    frame.in.rate -=
        thermal_growth(pair.radius_i, pair.radius_j, frame.in.overlap, swapped ? job.growth_b : job.growth_a,
                       swapped ? job.growth_a : job.growth_b, necked);
  }
  NormalForce normal;
  double share = 1;  // of the friction
  if constexpr (has_necks<Law>) {
    normal = law.update(frame.in, *neck);
    share = law.friction_share(*neck, frame.in.time);
  } else {
    normal = law.update(frame.in);
  }
  Triple force = normal.total * frame.normal;
  ContactRecord* const record = job.record ? reinterpret_cast<ContactRecord*>(job.record) + place : nullptr;
  if constexpr (friction) {
    const double lever_i = pair.radius_i + 0.5 * frame.in.overlap, lever_j = pair.radius_j + 0.5 * frame.in.overlap;
    const Triple spin =
        lever_i * triple(job.spin + 3 * std::size_t(i)) + lever_j * triple(job.spin + 3 * std::size_t(j));
    Triple slip = triple(sheared);
    const FrictionOf<double> f = friction_of(law, job.uniform, pair, frame, normal, spin, share, slip);
    sheared[0] = slip.x, sheared[1] = slip.y, sheared[2] = slip.z;
    force = force + f.force;
    put(given.i + 4, lever_i * f.couple);
    put(given.j + 4, lever_j * f.couple);
    if (record) {
      record->couple = Vec3(f.couple.x, f.couple.y, f.couple.z);
      record->lever_i = lever_i;
      record->lever_j = lever_j;
    }
  }
  put(given.i, force);
  put(given.j, -1.0 * force);
  if (job.next_step > 0) {
    double along;
    if constexpr (has_necks<Law>)
      along = law.step_stiffness(frame.in, *neck, job.next_step);
    else
      along = law.step_stiffness(frame.in, job.next_step);
    const StiffnessOf<double> s = stiffness_of<friction>(law, job.uniform, frame, normal, along, job.next_step);
    const double row[8] = {s.xx, s.yy, s.zz, s.xy, s.xz, s.yz, s.force, 0};
    std::copy_n(row, 8, given.stiffness);
  }
  if (record) {
    record->force = Vec3(force.x, force.y, force.z);
    keep(law, frame, normal, neck, *record);
  }
}

template <class Law, bool friction>
void general(const KernelJob& job, std::size_t near, double* of_i, double* of_j, double* stiffness) {
  Given given;
  pair<Law, friction>(job, near, given);
  std::copy_n(given.i, 8, of_i);
  std::copy_n(given.j, 8, of_j);
  std::copy_n(given.stiffness, 8, stiffness);
}

template <class Law>
GeneralLaw of_law(bool friction) {
  return friction ? general<Law, true> : general<Law, false>;
}

}  // namespace

GeneralLaw general_law(bool necks, bool hertz, bool friction) {
  if (necks)
    return hertz ? of_law<SinteringContact<HertzSpring>>(friction) : of_law<SinteringContact<LinearSpring>>(friction);
  return hertz ? of_law<KelvinVoigt<HertzSpring>>(friction) : of_law<KelvinVoigt<LinearSpring>>(friction);
}

}  // namespace densify::dem
