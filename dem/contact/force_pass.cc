#include "dem/contact/force_pass.h"

#include <Eigen/Geometry>

#include "dem/law/friction.h"
#include "dem/parallel.h"

namespace densify::dem {

namespace {

/// A pair as a pass meets it.
struct Pair {
  std::size_t near;     // place in the near list
  std::uint32_t place;  // in the contact list
  std::uint32_t i, j;
};

/// Adds to the particles at once, in the order of the list.
struct DirectSink {
  Vec3 *force, *torque;
  static constexpr bool records = false;

  void skip(const Pair&) const {}
  template <bool with_friction>
  void add(const Pair& pair, const ContactRecord& c) const {
    force[pair.i] += c.force;
    force[pair.j] -= c.force;
    if constexpr (with_friction) {
      torque[pair.i] += c.lever_i * c.couple;
      torque[pair.j] += c.lever_j * c.couple;
    }
  }
};

/// Keeps every contact for a measure; they are added afterwards.
struct RecordSink {
  ContactRecord* record;  // cleared
  static constexpr bool records = true;

  void skip(const Pair&) const {}
  template <bool with_friction>
  void add(const Pair& pair, const ContactRecord& c) const {
    record[pair.place] = c;
  }
};

template <class Law>
const auto& spring_of(const Law& law) {
  if constexpr (has_necks<Law>)
    return law.loose.spring;
  else
    return law.spring;
}

/// What heat adds to the distance at which a pair is at rest [m], from relative growths, or its rate from theirs. Loose
/// spheres meet at their surfaces; through a neck the body is whole, so that only the way from each centre to the
/// neck's plane grows and a bonded packing expands as one body, however unequal its overlaps.
inline double thermal_growth(const Body& a, const Body& b, double overlap, double of_i, double of_j, bool necked) {
  const double cut = necked ? 0.5 * overlap : 0.0;
  return of_i * (a.radius + cut) + of_j * (b.radius + cut);
}

/// Everything uniform over one bucket.  Plain pointers, so that the stores of a pass do not make the compiler read the
/// vectors' ends again.
template <class Law>
struct Bucket {
  Law law;
  FrictionModel friction;
  HertzRadius hertz_radius;
  const std::uint32_t* near;            // places of the near pairs
  const std::uint32_t *first, *second;  // of the contact list
  const Body* body;
  const Vec3* angular_velocity;
  const std::uint8_t* material;
  const Vec3* shift;  // of the image codes; null in a cell that is not periodic
  Vec3* tangential;
  NeckHistory* neck;
  Mat3 velocity_gradient;
  bool deforming;
  double growth_a, growth_b;  // relative growth rate of the radii of both materials since the last pass [1/s]
  std::uint8_t material_a;
  PassTime clock;
  // Only with stiffness sums asked for, one of the two: for the particles, or for each near pair.
  StiffnessSum* stiffness;
  StiffnessShare* stiffness_shares;
  double next_step;  // [s]

  /// What heat adds to the pair's distance at rest, mean since the last pass [m/s].
  double grown(std::uint32_t i, const Body& a, const Body& b, double overlap, bool necked) const {
    const bool swapped = material[i] != material_a;
    return thermal_growth(a, b, overlap, swapped ? growth_b : growth_a, swapped ? growth_a : growth_b, necked);
  }
};

template <class Law>
double step_stiffness(const Bucket<Law>& c, const NormalInput& in, std::uint32_t place) {
  if constexpr (has_necks<Law>)
    return c.law.step_stiffness(in, c.neck[place], c.next_step);
  else
    return c.law.step_stiffness(in, c.next_step);
}

/// The near pair at `index`.  Uniform features (periodic or deforming cell, thermal growth) are branches; law, friction
/// and sink are not.
template <bool with_friction, bool with_stiffness, class Law, class Sink>
inline void visit(const Bucket<Law>& c, const Sink& sink, std::size_t index) {
  const std::uint32_t place = c.near[index], i = c.first[place], coded = c.second[place];
  const std::uint32_t j = coded & ContactList::index_mask;
  const Pair pair{index, place, i, j};
  const Body &a = c.body[i], &b = c.body[j];
  Vec3 branch = b.position - a.position;
  if (c.shift) branch += c.shift[coded >> ContactList::index_bits];
  const double reach = a.radius + b.radius, d2 = branch.squaredNorm();
  bool necked = false;
  if constexpr (has_necks<Law>) necked = c.neck[place].phase != NeckPhase::loose;
  if (d2 >= reach * reach && !necked) {
    if constexpr (with_friction) c.tangential[place].setZero();
    sink.skip(pair);
    if constexpr (with_stiffness)
      if (c.stiffness_shares) c.stiffness_shares[index] = {Vec3::Zero(), 0, 0, 0};
    return;
  }
  const double d = std::sqrt(d2);
  const Vec3 n = (1 / d) * branch;
  Vec3 v = b.velocity - a.velocity;
  if (c.deforming) v += c.velocity_gradient * branch;
  const double vn = v.dot(n);

  NormalInput in;
  in.overlap = d - reach;
  in.rate = vn;
  if (c.growth_a != 0 || c.growth_b != 0) in.rate -= c.grown(i, a, b, in.overlap, necked);
  const double product = a.radius * b.radius / reach;
  in.elastic_radius = c.hertz_radius == HertzRadius::equivalent ? 2 * product : product;
  in.reduced_mass = 1 / (a.inverse_mass + b.inverse_mass);
  in.step = c.clock.step;
  in.time = c.clock.time;

  NormalForce f;
  if constexpr (has_necks<Law>) {
    in.sintering_radius =
        c.law.settings.radius == SinteringRadius::smaller ? std::min(a.radius, b.radius) : 2 * product;
    f = c.law.update(in, c.neck[place]);
  } else {
    in.sintering_radius = 0;
    f = c.law.update(in);
  }

  ContactRecord result;
  result.force = f.total * n;
  if constexpr (with_friction) {
    double share = 1;
    if constexpr (has_necks<Law>) share = c.law.friction_share(c.neck[place], in.time);
    result.lever_i = a.radius + 0.5 * in.overlap;
    result.lever_j = b.radius + 0.5 * in.overlap;
    Vec3& slip = c.tangential[place];
    if (share > 0) {
      const Vec3 spin = result.lever_i * c.angular_velocity[i] + result.lever_j * c.angular_velocity[j];
      const TangentialInput t{n,
                              v - vn * n - spin.cross(n),
                              share * std::max(0.0, f.sintering - f.total),
                              spring_of(c.law).tangent(in.overlap, in.elastic_radius),
                              in.reduced_mass,
                              in.step};
      const Vec3 ft = coulomb(c.friction, c.friction.coefficient, t, slip);
      result.force += ft;
      result.couple = n.cross(ft);
    } else {
      slip.setZero();
    }
  }
  if constexpr (with_stiffness) {
    const double along = step_stiffness(c, in, place);
    double across = 0;
    if constexpr (with_friction)
      across = tangential_step_stiffness(c.friction, spring_of(c.law).tangent(in.overlap, in.elastic_radius),
                                         in.reduced_mass, c.next_step);
    const double force = std::max(std::abs(f.total), f.sintering);
    if (c.stiffness_shares) {
      c.stiffness_shares[index] = {n, along, across, force};
    } else {
      for (const std::uint32_t p : {i, j}) {
        c.stiffness[p].add(along, across, n);
        c.stiffness[p].force += force;
      }
    }
  }
  if constexpr (Sink::records) {
    result.normal = f.total;
    result.sintering = f.sintering;
    double u = in.overlap;
    bool springs = true;  // a viscous contact has no spring to store energy in
    if constexpr (has_necks<Law>) {
      if (const auto& h = c.neck[place]; h.phase != NeckPhase::loose) {
        u = h.elastic;
        springs = c.law.settings.model != SinteringModel::viscous || !Law::flows(h.phase);
      } else if (in.overlap >= 0) {
        springs = false;  // the neck was lost in this very step
      }
    }
    if (springs) {
      const auto& spring = spring_of(c.law);
      result.elastic_energy = spring.energy(u, in.elastic_radius);
      result.damping = f.total - f.sintering - spring.force(u, in.elastic_radius);
    }
    result.touching = true;
  }
  sink.template add<with_friction>(pair, result);
}

/// Copies bucket and sink so that nothing that the loop stores can change them.
template <bool with_friction, bool with_stiffness, class Law, class Sink>
[[gnu::flatten]] void visit_all(const Bucket<Law> bucket, const Sink sink, std::size_t begin, std::size_t end) {
  for (std::size_t k = begin; k < end; ++k) visit<with_friction, with_stiffness>(bucket, sink, k);
}

}  // namespace

/// Keeps what gather() needs.
struct ForcePass::ShareSink {
  Share* share;
  static constexpr bool records = false;

  void skip(const Pair& pair) const { share[pair.near] = {Vec3::Zero(), Vec3::Zero(), 0, 0}; }
  template <bool with_friction>
  void add(const Pair& pair, const ContactRecord& c) const {
    share[pair.near] = {c.force, c.couple, c.lever_i, c.lever_j};
  }
};

void ForcePass::list_changed(const ContactList&, std::size_t) {
  near_.clear();
}

void ForcePass::near_changed(const ContactList& list, std::size_t particles) {
  if (threads_ == 1) return;
  const auto& places = near_.places();
  shares_.resize(places.size());
  incidence_begin_.assign(particles + 1, 0);
  for (const std::uint32_t k : places) ++incidence_begin_[list.i(k) + 1], ++incidence_begin_[list.j(k) + 1];
  for (std::size_t p = 0; p < particles; ++p) incidence_begin_[p + 1] += incidence_begin_[p];
  incidence_.resize(2 * places.size());
  std::vector<std::size_t> next(incidence_begin_.begin(), incidence_begin_.end() - 1);
  for (std::size_t n = 0; n < places.size(); ++n) {
    incidence_[next[list.i(places[n])]++] = std::uint32_t(n << 1);
    incidence_[next[list.j(places[n])]++] = std::uint32_t(n << 1 | 1);
  }
}

// Adds in the order in which the direct sink would, so that the sums are the same bit for bit.
void ForcePass::gather(Particles& particles, StepStiffness* stiffness) const {
  const bool rotates = !particles.torque.empty();
  in_parts(particles.size(), threads_, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p) {
      Vec3 force = Vec3::Zero(), torque = Vec3::Zero();
      for (std::size_t q = incidence_begin_[p]; q < incidence_begin_[p + 1]; ++q) {
        const Share& c = shares_[incidence_[q] >> 1];
        const bool second = incidence_[q] & 1;
        if (second)
          force -= c.force;
        else
          force += c.force;
        if (rotates) torque += (second ? c.lever_j : c.lever_i) * c.couple;
      }
      particles.force[p] = force;
      if (rotates) particles.torque[p] = torque;
      if (!stiffness) continue;
      StiffnessSum& sum = stiffness->of[p];
      for (std::size_t q = incidence_begin_[p]; q < incidence_begin_[p + 1]; ++q) {
        const StiffnessShare& c = stiffness_shares_[incidence_[q] >> 1];
        sum.add(c.along, c.across, c.normal);
        sum.force += c.force;
      }
    }
  });
}

/// The sums of a recorded pass, in the order of an unrecorded one.
void ForcePass::add_recorded(Particles& particles, const ContactList& list, const std::vector<ContactRecord>& record) {
  const auto& places = near_.places();
  const DirectSink direct{particles.force.data(), particles.torque.data()};
  const ShareSink share{shares_.data()};
  for (std::size_t n = 0; n < places.size(); ++n) {
    const Pair pair{n, places[n], list.i(places[n]), list.j(places[n])};
    const ContactRecord& c = record[pair.place];
    if (threads_ > 1)
      share.add<true>(pair, c);
    else if (model_.friction)
      direct.add<true>(pair, c);
    else
      direct.add<false>(pair, c);
  }
}

template <class Law>
void ForcePass::run_bucket(const Law& law, std::size_t number, Particles& particles, ContactList& list,
                           const Cell& cell, const std::vector<double>& expansion_step, PassTime clock,
                           std::vector<ContactRecord>* record, StepStiffness* stiffness) {
  const auto& named = list.buckets[number];
  auto growth = [&](std::uint8_t m) { return clock.step > 0 ? expansion_step[m] / clock.step : 0.0; };
  const bool shared = stiffness && threads_ > 1;
  const Bucket<Law> bucket{law,
                           model_.friction.value_or(FrictionModel{}),
                           model_.hertz_radius,
                           near_.places().data(),
                           list.first.data(),
                           list.second.data(),
                           particles.body.data(),
                           particles.angular_velocity.data(),
                           particles.material.data(),
                           cell.periodic ? &(*shifts_)[0] : nullptr,
                           list.tangential.data(),
                           list.neck.data(),
                           cell.velocity_gradient,
                           cell.periodic && !cell.velocity_gradient.isZero(0),
                           growth(named.material_a),
                           growth(named.material_b),
                           named.material_a,
                           clock,
                           stiffness && !shared ? stiffness->of.data() : nullptr,
                           shared ? stiffness_shares_.data() : nullptr,
                           stiffness ? stiffness->next_step : 0.0};
  const std::size_t first = number == 0 ? 0 : near_.bucket_end()[number - 1];
  const std::size_t count = near_.bucket_end()[number] - first;
  auto with = [&](const auto& sink, int threads) {
    in_parts(count, threads, [&](std::size_t begin, std::size_t end) {
      const std::size_t from = first + begin, to = first + end;
      if (model_.friction)
        stiffness ? visit_all<true, true>(bucket, sink, from, to) : visit_all<true, false>(bucket, sink, from, to);
      else
        stiffness ? visit_all<false, true>(bucket, sink, from, to) : visit_all<false, false>(bucket, sink, from, to);
    });
  };
  if (record)
    with(RecordSink{record->data()}, threads_);
  else if (threads_ > 1)
    with(ShareSink{shares_.data()}, threads_);
  else
    with(DirectSink{particles.force.data(), particles.torque.data()}, 1);
}

void ForcePass::compute(Particles& particles, ContactList& list, const Cell& cell, const PairTable& table,
                        const std::vector<double>& expansion_step, PassTime clock, std::vector<ContactRecord>* record,
                        StepStiffness* stiffness) {
  if (near_.empty()) {
    near_.take_all(list);
    near_changed(list, particles.size());
  }
  if (cell.periodic && (!shifts_ || cell.h != shifts_h_)) {
    shifts_.emplace(cell);
    shifts_h_ = cell.h;
  }
  if (record) record->assign(list.size(), ContactRecord{});
  if (stiffness) stiffness->of.assign(particles.size(), StiffnessSum{});
  if (stiffness && threads_ > 1) stiffness_shares_.resize(near_.places().size());
  if (threads_ == 1) {
    std::fill(particles.force.begin(), particles.force.end(), Vec3(Vec3::Zero()));
    std::fill(particles.torque.begin(), particles.torque.end(), Vec3(Vec3::Zero()));
  }
  for (std::size_t b = 0; b < list.buckets.size(); ++b) {
    const PairProperties& row = table.row(list.buckets[b].material_a, list.buckets[b].material_b);
    auto run = [&](const auto& law) {
      run_bucket(law, b, particles, list, cell, expansion_step, clock, record, stiffness);
    };
    with_spring(model_, row, [&](const auto& spring) {
      using Spring = std::decay_t<decltype(spring)>;
      if (list.neck.empty())
        run(KelvinVoigt<Spring>{spring, model_.damping_ratio});
      else
        run(make_sintering<Spring>(model_, row));
    });
  }
  if (record) add_recorded(particles, list, *record);
  if (threads_ > 1) gather(particles, stiffness);
}

std::size_t ForcePass::bytes() const {
  return near_.bytes() + shares_.capacity() * sizeof(Share) + stiffness_shares_.capacity() * sizeof(StiffnessShare) +
         incidence_.capacity() * sizeof(std::uint32_t) + incidence_begin_.capacity() * sizeof(std::size_t);
}

NormalInput normal_input(const ContactModel& model, const Particles& particles, const ContactList& list,
                         const Cell& cell, const std::vector<double>& expansion_step, PassTime clock, std::size_t k) {
  const std::uint32_t i = list.i(k), j = list.j(k);
  const Body &a = particles.body[i], &b = particles.body[j];
  Vec3 branch = b.position - a.position;
  if (cell.periodic) branch += cell.shift(list.image(k));
  const double d = branch.norm();
  Vec3 v = b.velocity - a.velocity;
  if (cell.periodic) v += cell.velocity_gradient * branch;
  NormalInput in;
  in.overlap = d - a.radius - b.radius;
  const bool necked = !list.neck.empty() && list.neck[k].phase != NeckPhase::loose;
  const double grown = thermal_growth(a, b, in.overlap, expansion_step[particles.material[i]],
                                      expansion_step[particles.material[j]], necked);
  in.rate = v.dot(branch) / d - (clock.step > 0 ? grown / clock.step : 0.0);
  in.elastic_radius = elastic_radius(model, a.radius, b.radius);
  in.sintering_radius = model.sintering ? sintering_radius(model.sintering->radius, a.radius, b.radius) : 0;
  in.reduced_mass = 1 / (a.inverse_mass + b.inverse_mass);
  in.step = clock.step;
  in.time = clock.time;
  return in;
}

}  // namespace densify::dem
