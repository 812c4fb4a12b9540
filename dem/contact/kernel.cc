// The contact pass in lanes.  Compiled once for each instruction set (dem/CMakeLists.txt): everything here is in the
// namespace of its own, and no function of another header is used that is not a template over these lanes.

#include "dem/contact/kernel.h"

#include "dem/contact/rows.h"

namespace densify::dem::DENSIFY_ISA {

namespace {

constexpr int width = DENSIFY_LANES;
using Numbers = Lanes<width>;
using Condition = Mask<width>;
using Triple = TripleOf<Numbers>;

constexpr int index_bits = 27;  // as ContactList
constexpr std::uint32_t index_mask = (1u << index_bits) - 1;

constexpr int most = 32, blocks = most / width;  // of one batch

/// The near pairs of a block, one a lane.
struct Block {
  const std::uint32_t* place;
  const std::uint16_t* offset_i;
  const std::uint32_t* offset_j;
};

/// One number of each body i.
inline Numbers gather_i(const double* bodies, const Block& block, int offset) {
  Numbers out;
  for (int l = 0; l < width; ++l) out.v[l] = bodies[block.offset_i[l] + offset];
  return out;
}

inline Triple triple_of(const Row (&rows)[width]) {
  const Columns<width> c = columns<width>(rows);
  return {c.c[0], c.c[1], c.c[2]};
}

/// Relative growth rates of the radii of i and j [1/s].
inline void growth_rates(const KernelJob& job, const Block& block, Numbers& of_i, Numbers& of_j) {
  for (int l = 0; l < width; ++l) {
    const bool swapped = job.material[job.first_particle + block.offset_i[l] / 8] != job.material_a;
    of_i.v[l] = swapped ? job.growth_b : job.growth_a;
    of_j.v[l] = swapped ? job.growth_a : job.growth_b;
  }
}

/// Of its flow that closing pores leave to each contact.
inline Numbers flow_shares(const KernelJob& job, const Block& block) {
  const double* const density = job.pores.density;
  Numbers of_i, of_j;
  for (int l = 0; l < width; ++l) {
    of_i.v[l] = density[job.first_particle + block.offset_i[l] / 8];
    of_j.v[l] = density[job.second[block.place[l]] & index_mask];
  }
  return flow_share(0.5 * job.pores.scale * (of_i + of_j), job.pores.onset);
}

/// Radius, displacement and phase of each neck.
struct Necks {
  Columns<width> column;
  PhasesOf<Condition> phase;
  Condition necked, unsettled;
};

template <class Law>
inline Necks read_necks(const Law& law, const KernelJob& job, const Block& block) {
  static_assert(sizeof(NeckHistory) == 4 * sizeof(double));
  Row rows[width];
  for (int l = 0; l < width; ++l) rows[l] = Row::load(reinterpret_cast<const double*>(job.neck + block.place[l]));
  Necks n;
  n.column = columns<width>(rows);
  typename Condition::Vector phase;
  std::memcpy(&phase, &n.column.c[3], sizeof phase);
  phase &= 0xff;
  const auto is = [&](NeckPhase p) { return Condition{phase == std::int64_t(p)}; };
  n.phase = {is(NeckPhase::loose), is(NeckPhase::sintering), is(NeckPhase::bonded), is(NeckPhase::dormant)};
  n.necked = {~n.phase.loose.v};
  const Condition settled =
      law.active ? n.phase.sintering | n.phase.bonded : n.phase.loose | n.phase.bonded | n.phase.dormant;
  n.unsettled = {~settled.v};
  return n;
}

/// What the rows of the bodies of a block say of its pairs.
struct Place {
  Columns<width> place, rate;  ///< x y z of x_j - x_i and r_i + r_j; v_j - v_i and 1/m_i + 1/m_j
  Numbers radius_i;
};

/// What a block adds to the sums of its particles.
struct Result {
  Columns<width> force, couple, stiffness[2];
  Numbers lever_i, lever_j;  ///< times the couple: torque of i and of j
  unsigned general;          ///< lanes that the general law has to do
};

inline std::uint32_t particle_j(const KernelJob& job, const Block& block, int l) {
  return job.second[block.place[l]] & index_mask;
}

/// Asks for what particles j of a batch of near pairs that is soon to come have.
template <bool friction>
inline void fetch(const KernelJob& job, std::size_t begin, std::size_t end) {
  if (begin + most > end) return;
  for (std::size_t n = begin; n < begin + most; ++n) {
    const std::size_t j = job.second[job.place[n]] & index_mask;
    __builtin_prefetch(job.body + 8 * j);
    if constexpr (friction) __builtin_prefetch(job.spin + 3 * j);
  }
}

template <class Law, bool friction>
inline void find(const KernelJob& job, const Block& block, Place& found) {
  const double* const own = job.body + 8 * std::size_t(job.first_particle);
  Record bodies[width];
  for (int l = 0; l < width; ++l) {
    const std::uint32_t coded = job.second[block.place[l]];
    bodies[l] = Record::between(own + block.offset_i[l], job.body + 8 * std::size_t(coded & index_mask),
                                job.shift + 4 * std::size_t(coded >> index_bits));
  }
  columns(bodies, found.place, found.rate);
  if (needs_radii<Law> || friction || job.growing) found.radius_i = gather_i(own, block, 3);
}

/// Writes the records of a block, but for pairs that the general law has to do.
template <class Law, bool friction>
inline void write_records(const Law& law, const KernelJob& job, const Block& block, const FrameOf<Numbers>& frame,
                          const NormalForceOf<Numbers>& normal, const Numbers& u, const Condition& springs,
                          const Result& result, unsigned lanes) {
  const SpringRecordOf<Numbers> spring = spring_record(law, frame, normal, u, springs);
  const Numbers none = 0.0;
  Row rows[3][width];
  rows_of<width>({result.force.c[0], result.force.c[1], result.force.c[2], normal.total}, rows[0]);
  rows_of<width>({none, none, none, normal.sintering}, rows[1]);
  rows_of<width>({none, none, spring.damping, spring.energy}, rows[2]);
  if constexpr (friction) {
    rows_of<width>({result.couple.c[0], result.couple.c[1], result.couple.c[2], normal.sintering}, rows[1]);
    rows_of<width>({result.lever_i, result.lever_j, spring.damping, spring.energy}, rows[2]);
  }
  for (int l = 0; l < width; ++l) {
    if (!(lanes >> l & 1)) continue;
    double* const record = job.record + RecordLayout::size * std::size_t(block.place[l]);
    rows[0][l].store(record + RecordLayout::force);
    rows[1][l].store(record + RecordLayout::couple);
    rows[2][l].store(record + RecordLayout::levers);
    *reinterpret_cast<bool*>(record + RecordLayout::touching) = true;
  }
}

/// `plain`: no growth, no deforming cell, no closing pores, no stiffness sums, no record.
template <class Law, bool friction, bool plain>
inline void act(const Law& law, const KernelJob& job, const Block& block, const Place& found, Result& result) {
  PairOf<Numbers> pair;
  pair.branch = {found.place.c[0], found.place.c[1], found.place.c[2]};
  pair.reach = found.place.c[3];
  pair.velocity = {found.rate.c[0], found.rate.c[1], found.rate.c[2]};
  pair.inverse_masses = found.rate.c[3];
  const Numbers d2 = dot(pair.branch, pair.branch);
  Condition present = d2 < pair.reach * pair.reach;
  Necks necks;
  if constexpr (has_necks<Law>) {
    necks = read_necks(law, job, block);
    present = present | necks.necked;
  }
  if (!plain && job.gradient) add_flow(pair, job.gradient);
  if (needs_radii<Law> || friction || (!plain && job.growing)) {
    pair.radius_i = found.radius_i;
    pair.radius_j = pair.reach - pair.radius_i;
  }
  FrameOf<Numbers> frame = frame_of(law, job.uniform, pair, d2);
  if (!plain && has_necks<Law> && job.pores.density) frame.in.flow_share = flow_shares(job, block);
  if (!plain && job.growing) {
    Numbers of_i, of_j, growth;
    growth_rates(job, block, of_i, of_j);
    if constexpr (has_necks<Law>)
      growth = thermal_growth(pair.radius_i, pair.radius_j, frame.in.overlap, of_i, of_j, necks.necked);
    else
      growth = thermal_growth(pair.radius_i, pair.radius_j, frame.in.overlap, of_i, of_j, Numbers(1.0) < Numbers(0.0));
    frame.in.rate = frame.in.rate - growth;
  }

  NormalForceOf<Numbers> normal;
  unsigned general = 0;
  NeckOf<Numbers> neck;
  if constexpr (has_necks<Law>) {
    neck = {necks.column.c[0], necks.column.c[1]};
    Condition turning{};
    normal = law.update_settled(frame.in, neck, necks.phase, turning);
    general = bits(present & (turning | necks.unsettled));
  } else {
    normal = law.update(frame.in);
  }

  const Numbers none = 0.0;
  Triple force = select(present, normal.total * frame.normal, Triple{none, none, none});
  if constexpr (friction) {
    Row rows[width];
    for (int l = 0; l < width; ++l)
      rows[l] = Row::load3(job.spin + 3 * (job.first_particle + std::size_t(block.offset_i[l]) / 8));
    const Triple spin_i = triple_of(rows);
    for (int l = 0; l < width; ++l) rows[l] = Row::load3(job.spin + 3 * std::size_t(particle_j(job, block, l)));
    const Triple spin_j = triple_of(rows);
    for (int l = 0; l < width; ++l) rows[l] = Row::load3(job.tangential + 3 * std::size_t(block.place[l]));
    Triple slip = triple_of(rows);
    result.lever_i = pair.radius_i + 0.5 * frame.in.overlap;
    result.lever_j = pair.radius_j + 0.5 * frame.in.overlap;
    const Triple spin = result.lever_i * spin_i + result.lever_j * spin_j;
    Condition sliding_contact = present;
    if constexpr (has_necks<Law>) sliding_contact = present & necks.phase.loose;
    const FrictionOf<Numbers> f =
        friction_of(law, job.uniform, pair, frame, normal, spin, select(sliding_contact, Numbers(1.0), none), slip);
    force = force + f.force;
    result.couple = {f.couple.x, f.couple.y, f.couple.z, none};
    rows_of<width>({slip.x, slip.y, slip.z, none}, rows);
    for (int l = 0; l < width; ++l)
      if (!has_necks<Law> || !(general >> l & 1)) rows[l].store3(job.tangential + 3 * std::size_t(block.place[l]));
  }
  result.force = {force.x, force.y, force.z, none};

  if (!plain && job.next_step > 0) {
    Numbers along;
    if constexpr (has_necks<Law>)
      along = law.step_stiffness(frame.in, neck, necks.phase, job.next_step);
    else
      along = law.step_stiffness(frame.in, job.next_step);
    const auto s = stiffness_of<friction>(law, job.uniform, frame, normal, along, job.next_step);
    const auto present_only = [&](const Numbers& x) { return select(present, x, none); };
    result.stiffness[0] = {present_only(s.xx), present_only(s.yy), present_only(s.zz), present_only(s.xy)};
    result.stiffness[1] = {present_only(s.xz), present_only(s.yz), present_only(s.force), none};
  }
  if (!plain && job.record) {
    const unsigned lanes = bits(present) & ~general;
    if constexpr (has_necks<Law>) {
      Condition springs = present;
      if (law.settings.model == SinteringModel::viscous) springs = springs & Condition{~necks.phase.sintering.v};
      write_records<Law, friction>(law, job, block, frame, normal, select(necks.necked, neck.elastic, frame.in.overlap),
                                   springs, result, lanes);
    } else {
      write_records<Law, friction>(law, job, block, frame, normal, frame.in.overlap, present, result, lanes);
    }
  }
  if constexpr (has_necks<Law>) {
    Row after[width];
    rows_of<width>({neck.radius, neck.elastic, necks.column.c[2], necks.column.c[3]}, after);
    const unsigned stores = bits(present) & ~general;
    for (int l = 0; l < width; ++l)
      if (stores >> l & 1) after[l].store(reinterpret_cast<double*>(job.neck + block.place[l]));
    result.general = general;
  }
}

/// Sums of one pair: force, or force and torque.
template <bool friction>
using Sum = std::conditional_t<friction, Record, Row>;

template <bool friction>
struct Given {
  Sum<friction> i[width], j[width];
  Row stiffness[2][width];
};

/// Does the general law's lanes among the others, so that sums keep the order of the pairs.
template <bool friction>
[[gnu::noinline]] void replace_by_general(const KernelJob& job, std::size_t at, unsigned general,
                                          Given<friction>& given) {
  for (int l = 0; l < width; ++l) {
    if (!(general >> l & 1)) continue;
    double of_i[8], of_j[8], stiffness[8];
    job.general(job, at + std::size_t(l), of_i, of_j, stiffness);
    given.i[l] = Sum<friction>::load(of_i);
    given.j[l] = Sum<friction>::load(of_j);
    given.stiffness[0][l] = Row::load(stiffness);
    given.stiffness[1][l] = Row::load(stiffness + 4);
  }
}

/// `at` is the place of the first in the near list; lanes beyond `count` repeat the last.
template <bool necks, bool friction, bool plain>
inline void add(const KernelJob& job, const Block& block, const Result& result, std::size_t at, int count) {
  Given<friction> given;
  if constexpr (friction) {
    Record records[width];
    records_of(result.force, result.couple, records);
    double lever[2][width];
    result.lever_i.store(lever[0]);
    result.lever_j.store(lever[1]);
    for (int l = 0; l < width; ++l) {
      given.i[l] = records[l].last_times(lever[0][l]);
      given.j[l] = records[l].opposite_last_times(lever[1][l]);
    }
  } else {
    rows_of<width>(result.force, given.i);
    for (int l = 0; l < width; ++l) given.j[l] = given.i[l].opposite();
  }
  if (!plain && job.next_step > 0)
    for (int k = 0; k < 2; ++k) rows_of<width>(result.stiffness[k], given.stiffness[k]);
  if constexpr (necks)
    if (const unsigned general = result.general & ((1u << count) - 1); general != 0)
      replace_by_general(job, at, general, given);
  const std::size_t stride = plain ? (friction ? 8 : 4) : job.stride;
  for (int l = 0; l < width; ++l) {
    if (l >= count) break;
    double* const i = job.sums + stride * block.offset_i[l] / 8;
    double* const j = job.sums + stride * block.offset_j[l] / 8;
    (Sum<friction>::load(i) + given.i[l]).store(i);
    (Sum<friction>::load(j) + given.j[l]).store(j);
    if (plain || !(job.next_step > 0)) continue;
    for (double* const sum : {i, j}) {
      double* const s = sum + (friction ? 8 : 4);
      (Row::load(s) + given.stiffness[0][l]).store(s);
      (Row::load(s + 4) + given.stiffness[1][l]).store(s + 4);
    }
  }
}

/// In three short loops over a few blocks: one long loop fills the processor's window with one block, which then waits
/// for its own roots and divisions.
template <class Law, bool friction, bool plain>
[[gnu::flatten]] void run_pairs(const KernelJob& shared, std::size_t begin, std::size_t end) {
  const KernelJob job = shared;  // nothing that the loops store can change it
  const Law law = *static_cast<const Law*>(job.law);
  Place found[blocks];
  Result result[blocks];
  const auto batch = [&](const Block& first, std::size_t at, int count) {
    const auto block = [&](int b) {
      return Block{first.place + b * width, first.offset_i + b * width, first.offset_j + b * width};
    };
    const int used = (count + width - 1) / width;
    if (job.far) fetch<friction>(job, at + 2 * most, end);
    for (int b = 0; b < used; ++b) find<Law, friction>(job, block(b), found[b]);
    for (int b = 0; b < used; ++b) act<Law, friction, plain>(law, job, block(b), found[b], result[b]);
    for (int b = 0; b < used; ++b) {
      const int left = count - b * width;
      add<has_necks<Law>, friction, plain>(job, block(b), result[b], at + std::size_t(b) * width,
                                           left < width ? left : width);
    }
  };
  std::size_t at = begin;
  for (; at + most <= end; at += most) batch({job.place + at, job.offset_i + at, job.offset_j + at}, at, most);
  if (at == end) return;
  std::uint32_t places[most], offsets_j[most];
  std::uint16_t offsets_i[most];
  for (int l = 0; l < most; ++l) {
    const std::size_t n = at + std::size_t(l) < end ? at + std::size_t(l) : end - 1;
    places[l] = job.place[n], offsets_i[l] = job.offset_i[n], offsets_j[l] = job.offset_j[n];
  }
  batch({places, offsets_i, offsets_j}, at, int(end - at));
}

template <class Law, bool friction>
void run(const KernelJob& job, std::size_t begin, std::size_t end) {
  if (job.gradient || job.growing || job.pores.density || job.next_step > 0 || job.record)
    run_pairs<Law, friction, false>(job, begin, end);
  else
    run_pairs<Law, friction, true>(job, begin, end);
}

}  // namespace

KernelTable table() {
  return {DENSIFY_ISA_NAME,
          width,
          {{{run<KelvinVoigt<LinearSpring>, false>, run<KelvinVoigt<LinearSpring>, true>},
            {run<KelvinVoigt<HertzSpring>, false>, run<KelvinVoigt<HertzSpring>, true>}},
           {{run<SinteringContact<LinearSpring>, false>, run<SinteringContact<LinearSpring>, true>},
            {run<SinteringContact<HertzSpring>, false>, run<SinteringContact<HertzSpring>, true>}}}};
}

}  // namespace densify::dem::DENSIFY_ISA
