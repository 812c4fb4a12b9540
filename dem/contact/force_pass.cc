#include "dem/contact/force_pass.h"

#include <algorithm>

#include "dem/contact/single_pairs.h"
#include "dem/parallel.h"

namespace densify::dem {

namespace {
// Particles whose bodies fill the second cache of a usual processor, 2 MiB.
constexpr std::size_t fits_second_cache = 32768;
}  // namespace

void ForcePass::list_changed() {
  near_.clear();
}

void ForcePass::near_changed(const ContactList& list, std::size_t particles) {
  chunks_.build(list, near_, particles, threads_, images_apart_);
}

void ForcePass::prepare(Particles& particles, ContactList& list, const Cell& cell, const PairTable& table,
                        const std::vector<double>& expansion_step, PassTime clock, std::vector<ContactRecord>* record,
                        const StepStiffness* stiffness) {
  if (near_.empty()) {
    near_.take_all(list);
    near_changed(list, particles.size());
  }
  if (cell.periodic && cell.h != shifts_h_) {
    const ImageShifts shifts(cell);
    for (std::uint8_t code = 0; code < 27; ++code)
      for (int k = 0; k < 4; ++k) shifts_[4 * code + k] = k < 3 ? shifts[code][k] : 0.0;
    shifts_h_ = cell.h;
  }
  auto growth = [&](std::uint8_t m) { return clock.step > 0 ? expansion_step[m] / clock.step : 0.0; };
  const bool deforming = cell.periodic && !cell.velocity_gradient.isZero(0);
  const bool necks = !list.neck.empty(), hertz = model_.elasticity == Elasticity::hertz;
  const std::size_t stride = (model_.friction ? 8 : 4) + (stiffness ? 8 : 0);
  const FrictionModel model = model_.friction.value_or(FrictionModel{});
  const Friction friction(model, model.coefficient);
  const GeneralLaw general = general_law(necks, hertz, model_.friction.has_value());
  static_assert(sizeof(ContactRecord) == RecordLayout::size * sizeof(double));
  buckets_.clear();
  buckets_.reserve(list.buckets.size());  // jobs point to their laws
  for (const auto& named : list.buckets) {
    const PairProperties& row = table.row(named.material_a, named.material_b);
    Law law;
    with_law(model_, row, necks, [&](const auto& l) { law = l; });
    buckets_.push_back({{near_.places().data(),
                         chunks_.offsets_i().data(),
                         chunks_.offsets_j().data(),
                         list.second.data(),
                         list.tangential.empty() ? nullptr : list.tangential[0].data(),
                         list.neck.data(),
                         particles.body[0].position.data(),
                         particles.angular_velocity.empty() ? nullptr : particles.angular_velocity[0].data(),
                         particles.material.data(),
                         particles.size() > fits_second_cache,
                         shifts_.data(),
                         deforming ? cell.velocity_gradient.data() : nullptr,
                         growth(named.material_a) != 0 || growth(named.material_b) != 0,
                         growth(named.material_a),
                         growth(named.material_b),
                         named.material_a,
                         nullptr,
                         {friction, model_.hertz_radius == HertzRadius::equivalent, clock.step, clock.time},
                         pores_,
                         nullptr,
                         stride,
                         0,
                         stiffness ? stiffness->next_step : 0.0,
                         record ? record->data()->force.data() : nullptr,
                         general},
                        law});
    buckets_.back().job.law = std::visit([](const auto& l) -> const void* { return &l; }, buckets_.back().law);
  }
}

namespace {

/// A row of sums as it is kept for other chunks: without its zeros.
struct KeptRow {
  bool rotates, stiffens;

  std::size_t size() const { return 3 + (rotates ? 3 : 0) + (stiffens ? 7 : 0); }
  void keep(const double* row, double* kept) const {
    for (int k = 0; k < 3; ++k) *kept++ = row[k];
    if (rotates)
      for (int k = 4; k < 7; ++k) *kept++ = row[k];
    if (stiffens) std::copy_n(row + (rotates ? 8 : 4), 7, kept);
  }
};

void add(StiffnessSum& sum, const double* v) {
  sum.xx += v[0], sum.yy += v[1], sum.zz += v[2], sum.xy += v[3], sum.xz += v[4], sum.yz += v[5], sum.force += v[6];
}

}  // namespace

void ForcePass::run_chunk(std::size_t chunk, Particles& particles, std::vector<double>& sums,
                          StepStiffness* stiffness) {
  const bool rotates = model_.friction.has_value();
  const KeptRow kept{rotates, stiffness != nullptr};
  const std::uint32_t first = chunks_.begin(chunk), own = chunks_.size(chunk);
  const std::size_t others = chunks_.others_begin(chunk), other_count = chunks_.others_begin(chunk + 1) - others;
  const std::size_t stride = (rotates ? 8 : 4) + (stiffness ? 8 : 0);
  sums.assign(stride * (own + other_count), 0.0);
  for (std::size_t b = 0; b < buckets_.size(); ++b) {
    const Law& law = buckets_[b].law;
    KernelJob job = buckets_[b].job;
    job.sums = sums.data();
    job.first_particle = first;
    const std::size_t begin = chunks_.near_begin(b, chunk), end = chunks_.near_end(b, chunk);
    const bool necks = law.index() >= 2, hertz = law.index() % 2 == 1;
    kernels_->kernel[necks][hertz][rotates](job, begin, end);
  }
  const double* row = sums.data();
  for (std::uint32_t p = first; p < first + own; ++p, row += stride) {
    particles.force[p] = Vec3(row[0], row[1], row[2]);
    if (rotates) particles.torque[p] = Vec3(row[4], row[5], row[6]);
    if (stiffness) add(stiffness->of[p] = StiffnessSum{}, row + stride - 8);
  }
  double* out = for_others_.data() + kept.size() * others;
  for (std::size_t k = 0; k < other_count; ++k, row += stride, out += kept.size()) kept.keep(row, out);
}

void ForcePass::add_incoming(std::size_t chunk, Particles& particles, StepStiffness* stiffness) const {
  const bool rotates = model_.friction.has_value();
  const KeptRow kept{rotates, stiffness != nullptr};
  for (const auto& part : chunks_.incoming(chunk))
    for (std::size_t k = part.begin; k < part.end; ++k) {
      const double* const row = for_others_.data() + kept.size() * k;
      const std::uint32_t p = chunks_.others()[k];
      particles.force[p] += Vec3(row[0], row[1], row[2]);
      if (rotates) particles.torque[p] += Vec3(row[3], row[4], row[5]);
      if (stiffness) add(stiffness->of[p], row + (rotates ? 6 : 3));
    }
}

void ForcePass::compute(Particles& particles, ContactList& list, const Cell& cell, const PairTable& table,
                        const std::vector<double>& expansion_step, PassTime clock, std::vector<ContactRecord>* record,
                        StepStiffness* stiffness) {
  if (record) record->assign(list.size(), ContactRecord{});
  prepare(particles, list, cell, table, expansion_step, clock, record, stiffness);
  near_.count_pass();
  if (stiffness) stiffness->of.resize(particles.size());
  const std::size_t kept = KeptRow{model_.friction.has_value(), stiffness != nullptr}.size() * chunks_.others().size();
  if (for_others_.size() != kept) for_others_ = std::vector<double>(kept);
  const int threads = int(std::min(std::size_t(threads_), chunks_.count()));
  sums_.resize(std::size_t(threads));
  in_parts(std::size_t(threads), threads, [&](std::size_t t, std::size_t) {
    const std::size_t end = detail::part(chunks_.count(), int(t) + 1, threads);
    for (std::size_t c = detail::part(chunks_.count(), int(t), threads); c < end; ++c)
      run_chunk(c, particles, sums_[t], stiffness);
  });
  in_parts(chunks_.count(), threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t c = begin; c < end; ++c) add_incoming(c, particles, stiffness);
  });
}

Mat3 ForcePass::virial(const Particles& particles, const Cell& cell) const {
  // Each sum serially and in one order, so that it does not depend on the number of threads.
  Mat3 sum = Mat3::Zero();
  for (std::size_t p = 0; p < particles.size(); ++p)
    sum -= particles.force[p] * (particles.body[p].position - cell.origin).transpose();
  const std::size_t others = chunks_.others().size();
  if (others == 0) return sum;
  std::array<Vec3, 27> through;
  through.fill(Vec3::Zero());
  const std::size_t kept = for_others_.size() / others;
  for (std::size_t k = 0; k < others; ++k)
    through[chunks_.other_images()[k]] += Eigen::Map<const Vec3>(for_others_.data() + kept * k);
  for (std::uint8_t code = 0; code < 27; ++code) sum -= through[code] * cell.shift(code).transpose();
  return sum;
}

std::size_t ForcePass::bytes() const {
  std::size_t b = near_.bytes() + chunks_.bytes() + for_others_.capacity() * sizeof(double);
  for (const auto& s : sums_) b += s.capacity() * sizeof(double);
  return b;
}

}  // namespace densify::dem
