#include "dem/contact/force_pass.h"

#include <Eigen/Geometry>
#include <array>
#include <type_traits>

#include "dem/law/friction.h"

namespace densify::dem {

namespace {

using Shifts = std::array<Vec3, 27>;

Shifts image_shifts(const Cell& cell) {
  Shifts shifts;
  for (std::uint8_t code = 0; code < 27; ++code) shifts[code] = cell.periodic ? cell.shift(code) : Vec3(Vec3::Zero());
  return shifts;
}

/// Adds to the particles at once, in the order of the list.
struct DirectSink {
  Particles& particles;
  static constexpr bool records = false;

  void skip(std::size_t) {}
  template <bool with_friction>
  void add(std::size_t, std::uint32_t i, std::uint32_t j, const ContactRecord& c) {
    particles.force[i] += c.force;
    particles.force[j] -= c.force;
    if constexpr (with_friction) {
      particles.torque[i] += c.lever_i * c.couple;
      particles.torque[j] += c.lever_j * c.couple;
    }
  }
};

/// Keeps every contact for a later sum or a measure.
struct RecordSink {
  std::vector<ContactRecord>& record;
  static constexpr bool records = true;

  void skip(std::size_t k) { record[k] = ContactRecord{}; }
  template <bool with_friction>
  void add(std::size_t k, std::uint32_t, std::uint32_t, const ContactRecord& c) {
    record[k] = c;
  }
};

/// Everything uniform over one bucket.
template <class Law>
struct BucketContext {
  Law law;
  const ContactModel& model;
  const std::vector<Body>& body;
  const std::vector<Vec3>* angular_velocity;
  ContactList& list;
  const Shifts& shifts;
  const Mat3& velocity_gradient;
  bool deforming;
  double growth_a, growth_b;  // relative growth of the radii of both materials since the last pass
  std::uint8_t material_a;
  const std::vector<std::uint8_t>& material;
  PassTime clock;
};

template <class Law>
inline constexpr bool has_necks =
    !std::is_same_v<Law, KelvinVoigt<LinearSpring>> && !std::is_same_v<Law, KelvinVoigt<HertzSpring>>;

template <class Law>
const auto& spring_of(const Law& law) {
  if constexpr (has_necks<Law>)
    return law.loose.spring;
  else
    return law.spring;
}

/// What heat adds to the distance at which a pair is at rest [m].  Loose spheres meet at their surfaces; through a neck
/// the body is whole, so that only the way from each centre to the neck's plane grows and a bonded packing expands as
/// one body, however unequal its overlaps.
inline double thermal_growth(const Body& a, const Body& b, double overlap, double of_i, double of_j, bool necked) {
  const double cut = necked ? 0.5 * overlap : 0.0;
  return of_i * (a.radius + cut) + of_j * (b.radius + cut);
}

/// Pair k of a bucket.  Uniform features (deforming cell, thermal growth) are branches; law, friction and sink are not.
template <bool with_friction, class Law, class Sink>
inline void one_pair(const BucketContext<Law>& c, Sink& sink, std::size_t k) {
  const std::uint32_t i = c.list.i(k), j = c.list.j(k);
  const Body &a = c.body[i], &b = c.body[j];
  const Vec3 branch = b.position - a.position + c.shifts[c.list.image(k)];
  const double reach = a.radius + b.radius, d2 = branch.squaredNorm();
  bool necked = false;
  if constexpr (has_necks<Law>) necked = c.list.neck[k].phase != NeckPhase::loose;
  if (d2 >= reach * reach && !necked) {
    if constexpr (with_friction) c.list.tangential[k].setZero();
    sink.skip(k);
    return;
  }
  const double d = std::sqrt(d2);
  const Vec3 n = branch / d;
  Vec3 v = b.velocity - a.velocity;
  if (c.deforming) v += c.velocity_gradient * branch;
  const double vn = v.dot(n);

  NormalInput in;
  in.overlap = d - reach;
  in.rate = vn;
  if (c.growth_a != 0 || c.growth_b != 0) {
    const bool swapped = c.material[i] != c.material_a;
    const double of_i = swapped ? c.growth_b : c.growth_a, of_j = swapped ? c.growth_a : c.growth_b;
    if (c.clock.step > 0) in.rate -= thermal_growth(a, b, in.overlap, of_i, of_j, necked) / c.clock.step;
  }
  const double product = a.radius * b.radius / reach;
  in.elastic_radius = c.model.hertz_radius == HertzRadius::equivalent ? 2 * product : product;
  in.reduced_mass = 1 / (a.inverse_mass + b.inverse_mass);
  in.step = c.clock.step;
  in.time = c.clock.time;

  NormalForce f;
  if constexpr (has_necks<Law>) {
    in.sintering_radius =
        c.law.settings.radius == SinteringRadius::smaller ? std::min(a.radius, b.radius) : 2 * product;
    f = c.law.update(in, c.list.neck[k]);
  } else {
    in.sintering_radius = 0;
    f = c.law.update(in);
  }

  ContactRecord result;
  result.force = f.total * n;
  if constexpr (with_friction) {
    double share = 1;
    if constexpr (has_necks<Law>) share = c.law.friction_share(c.list.neck[k], in.time);
    result.lever_i = a.radius + 0.5 * in.overlap;
    result.lever_j = b.radius + 0.5 * in.overlap;
    Vec3& slip = c.list.tangential[k];
    if (share > 0) {
      const Vec3 spin = result.lever_i * (*c.angular_velocity)[i] + result.lever_j * (*c.angular_velocity)[j];
      const TangentialInput t{n,
                              v - vn * n - spin.cross(n),
                              share * std::max(0.0, f.sintering - f.total),
                              spring_of(c.law).tangent(in.overlap, in.elastic_radius),
                              in.reduced_mass,
                              in.step};
      const Vec3 ft = coulomb(*c.model.friction, c.model.friction->coefficient, t, slip);
      result.force += ft;
      result.couple = n.cross(ft);
    } else {
      slip.setZero();
    }
  }
  if constexpr (Sink::records) {
    result.normal = f.total;
    result.sintering = f.sintering;
    double u = in.overlap;
    bool springs = true;  // a viscous contact has no spring to store energy in
    if constexpr (has_necks<Law>)
      if (const auto& h = c.list.neck[k]; h.phase != NeckPhase::loose) {
        u = h.elastic;
        springs = c.law.settings.model != SinteringModel::viscous || !Law::flows(h.phase);
      }
    if (springs) {
      const auto& spring = spring_of(c.law);
      result.elastic_energy = spring.energy(u, in.elastic_radius);
      result.damping = f.total - f.sintering - spring.force(u, in.elastic_radius);
    }
    result.touching = true;
  }
  sink.template add<with_friction>(k, i, j, result);
}

template <bool with_friction, class Law, class Sink>
void run(const BucketContext<Law>& c, const ContactList::Bucket& bucket, Sink& sink, int threads) {
  const auto begin = std::ptrdiff_t(bucket.begin), end = std::ptrdiff_t(bucket.end);
  if constexpr (Sink::records) {
#pragma omp parallel for num_threads(threads) if (threads > 1) schedule(static)
    for (std::ptrdiff_t k = begin; k < end; ++k) one_pair<with_friction>(c, sink, std::size_t(k));
  } else {
    for (std::ptrdiff_t k = begin; k < end; ++k) one_pair<with_friction>(c, sink, std::size_t(k));
  }
}

}  // namespace

void ForcePass::list_changed(const ContactList& list, std::size_t particles) {
  if (threads_ == 1) return;
  scratch_.resize(list.size());
  incidence_begin_.assign(particles + 1, 0);
  for (std::size_t k = 0; k < list.size(); ++k) ++incidence_begin_[list.i(k) + 1], ++incidence_begin_[list.j(k) + 1];
  for (std::size_t p = 0; p < particles; ++p) incidence_begin_[p + 1] += incidence_begin_[p];
  incidence_.resize(2 * list.size());
  std::vector<std::size_t> next(incidence_begin_.begin(), incidence_begin_.end() - 1);
  for (std::size_t k = 0; k < list.size(); ++k) {
    incidence_[next[list.i(k)]++] = std::uint32_t(k << 1);
    incidence_[next[list.j(k)]++] = std::uint32_t(k << 1 | 1);
  }
}

// Adds in the order in which the direct sink would, so that the sums are the same bit for bit.
void ForcePass::gather(Particles& particles, const ContactList&) {
  const bool rotates = !particles.torque.empty();
  const auto n = std::ptrdiff_t(particles.size());
#pragma omp parallel for num_threads(threads_) schedule(static)
  for (std::ptrdiff_t p = 0; p < n; ++p) {
    Vec3 force = Vec3::Zero(), torque = Vec3::Zero();
    for (std::size_t q = incidence_begin_[std::size_t(p)]; q < incidence_begin_[std::size_t(p) + 1]; ++q) {
      const ContactRecord& c = scratch_[incidence_[q] >> 1];
      const bool second = incidence_[q] & 1;
      if (second)
        force -= c.force;
      else
        force += c.force;
      if (rotates) torque += (second ? c.lever_j : c.lever_i) * c.couple;
    }
    particles.force[std::size_t(p)] = force;
    if (rotates) particles.torque[std::size_t(p)] = torque;
  }
}

void ForcePass::compute(Particles& particles, ContactList& list, const Cell& cell, const PairTable& table,
                        const std::vector<double>& expansion_step, PassTime clock, std::vector<ContactRecord>* record) {
  const Shifts shifts = image_shifts(cell);
  const bool deforming = cell.periodic && !cell.velocity_gradient.isZero(0);
  const bool stored = threads_ > 1;
  std::vector<ContactRecord>* target = stored ? &scratch_ : record;
  if (target) target->resize(list.size());
  if (!stored) {
    for (auto& f : particles.force) f.setZero();
    for (auto& t : particles.torque) t.setZero();
  }

  for (const auto& bucket : list.buckets) {
    const PairProperties& row = table.row(bucket.material_a, bucket.material_b);
    auto with_law = [&](const auto& law) {
      using Law = std::decay_t<decltype(law)>;
      const BucketContext<Law> context{law,
                                       model_,
                                       particles.body,
                                       &particles.angular_velocity,
                                       list,
                                       shifts,
                                       cell.velocity_gradient,
                                       deforming,
                                       expansion_step[bucket.material_a],
                                       expansion_step[bucket.material_b],
                                       bucket.material_a,
                                       particles.material,
                                       clock};
      auto with_sink = [&](auto&& sink) {
        if (model_.friction)
          run<true>(context, bucket, sink, threads_);
        else
          run<false>(context, bucket, sink, threads_);
      };
      if (target)
        with_sink(RecordSink{*target});
      else
        with_sink(DirectSink{particles});
    };
    with_spring(model_, row, [&](const auto& spring) {
      using Spring = std::decay_t<decltype(spring)>;
      if (list.neck.empty())
        with_law(KelvinVoigt<Spring>{spring, model_.damping_ratio});
      else
        with_law(make_sintering<Spring>(model_, row));
    });
  }

  if (stored) {
    gather(particles, list);
    if (record) *record = scratch_;
  } else if (record) {
    DirectSink sink{particles};
    for (std::size_t k = 0; k < list.size(); ++k) {
      if (model_.friction)
        sink.add<true>(k, list.i(k), list.j(k), (*record)[k]);
      else
        sink.add<false>(k, list.i(k), list.j(k), (*record)[k]);
    }
  }
}

std::size_t ForcePass::bytes() const {
  return scratch_.capacity() * sizeof(ContactRecord) + incidence_.capacity() * sizeof(std::uint32_t) +
         incidence_begin_.capacity() * sizeof(std::size_t);
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
