// The contact pass in lanes.  Compiled once for each instruction set (dem/CMakeLists.txt): everything here is in the
// namespace of its own, and no function of another header is used that is not a template over these lanes.

#include "dem/contact/kernel.h"

#include "dem/contact/lanes.h"

namespace densify::dem::DENSIFY_ISA {

namespace {

constexpr int width = DENSIFY_LANES;
using Numbers = Lanes<width>;
using Condition = Mask<width>;
using Triple = TripleOf<Numbers>;

/// A block of near pairs; lanes beyond `count` repeat the last.
struct Block {
  std::uint32_t place[width], i[width], j[width], code[width], slot_i[width], slot_j[width];
};

inline void read_block(const KernelJob& job, std::size_t at, int count, Block& block) {
  constexpr std::uint32_t index_bits = 27, index_mask = (1u << index_bits) - 1;  // as ContactList
  for (int l = 0; l < width; ++l) {
    const std::size_t n = at + std::size_t(l < count ? l : count - 1);
    const std::uint32_t k = job.place[n], coded = job.second[k];
    block.place[l] = k;
    block.i[l] = job.first[k];
    block.j[l] = coded & index_mask;
    block.code[l] = coded >> index_bits;
    block.slot_i[l] = block.i[l] - job.first_particle;
    block.slot_j[l] = job.slot[n];
  }
}

inline Numbers gather(const double* base, const std::uint32_t (&index)[width], int stride, int offset) {
  Numbers out;
  for (int l = 0; l < width; ++l) out.v[l] = base[std::size_t(index[l]) * std::size_t(stride) + std::size_t(offset)];
  return out;
}

inline Triple rows3(const double* base, const std::uint32_t (&index)[width]) {
  Row rows[width];
  for (int l = 0; l < width; ++l) rows[l] = Row::load3(base + 3 * std::size_t(index[l]));
  const Columns<width> c = columns<width>(rows);
  return {c.c[0], c.c[1], c.c[2]};
}

/// Relative growth rates of the radii of i and j [1/s].
inline void growth_rates(const KernelJob& job, const Block& block, Numbers& of_i, Numbers& of_j) {
  for (int l = 0; l < width; ++l) {
    const bool swapped = job.material[block.i[l]] != job.material_a;
    of_i.v[l] = swapped ? job.growth_b : job.growth_a;
    of_j.v[l] = swapped ? job.growth_a : job.growth_b;
  }
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

template <class Law, bool friction>
inline void do_block(const Law& law, const KernelJob& job, std::size_t at, int count) {
  Block block;
  read_block(job, at, count, block);

  Row rows[width], rates[width];
  for (int l = 0; l < width; ++l) {
    const double *a = job.body + 8 * std::size_t(block.i[l]), *b = job.body + 8 * std::size_t(block.j[l]);
    rows[l] = Row::load(b) + Row::load(a).opposite();  // x_j - x_i and r_j + r_i
    if (job.shift) rows[l] = rows[l] + Row::load(job.shift + 4 * block.code[l]);
    rates[l] = Row::load(b + 4) + Row::load(a + 4).opposite();
  }
  PairOf<Numbers> pair;
  const Columns<width> place = columns<width>(rows);
  pair.branch = {place.c[0], place.c[1], place.c[2]};
  pair.reach = place.c[3];
  const Numbers d2 = dot(pair.branch, pair.branch);
  Condition present = d2 < pair.reach * pair.reach;
  Necks necks;
  if constexpr (has_necks<Law>) {
    necks = read_necks(law, job, block);
    present = present | necks.necked;
  }
  if constexpr (!friction)
    if (!any(present)) return;

  const Columns<width> rate = columns<width>(rates);
  pair.velocity = {rate.c[0], rate.c[1], rate.c[2]};
  pair.inverse_masses = rate.c[3];
  if (job.gradient) add_flow(pair, job.gradient);
  if (needs_radii<Law> || friction || job.growing) {
    pair.radius_i = gather(job.body, block.i, 8, 3);
    pair.radius_j = gather(job.body, block.j, 8, 3);
  }
  FrameOf<Numbers> frame = frame_of(law, job.uniform, pair, d2);
  if (job.growing) {
    Numbers of_i, of_j, growth;
    growth_rates(job, block, of_i, of_j);
    if constexpr (has_necks<Law>)
      growth = thermal_growth(pair.radius_i, pair.radius_j, frame.in.overlap, of_i, of_j, necks.necked);
    else
      growth = thermal_growth(pair.radius_i, pair.radius_j, frame.in.overlap, of_i, of_j, Numbers(1.0) < Numbers(0.0));
    frame.in.rate = frame.in.rate - growth;
  }

  NormalForceOf<Numbers> normal;
  unsigned general = 0;  // lanes that the general law has to do
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
  Row torque_i[width], torque_j[width];
  Row slips[width];
  if constexpr (friction) {
    const Numbers lever_i = pair.radius_i + 0.5 * frame.in.overlap, lever_j = pair.radius_j + 0.5 * frame.in.overlap;
    const Triple spin = lever_i * rows3(job.spin, block.i) + lever_j * rows3(job.spin, block.j);
    Triple slip = rows3(job.tangential, block.place);
    Condition sliding_contact = present;
    if constexpr (has_necks<Law>) sliding_contact = present & necks.phase.loose;
    FrictionOf<Numbers> f =
        friction_of(law, job.uniform, pair, frame, normal, spin, select(sliding_contact, Numbers(1.0), none), slip);
    force = force + f.force;
    Row couples[width];
    rows_of<width>({f.couple.x, f.couple.y, f.couple.z, none}, couples);
    for (int l = 0; l < width; ++l) {
      torque_i[l] = Row::all(lever_i.v[l]) * couples[l];
      torque_j[l] = Row::all(lever_j.v[l]) * couples[l];
    }
    rows_of<width>({slip.x, slip.y, slip.z, none}, slips);
  }
  Row force_i[width], force_j[width];
  rows_of<width>({force.x, force.y, force.z, none}, force_i);
  for (int l = 0; l < width; ++l) force_j[l] = force_i[l].opposite();

  Row stiff[2][width];
  if (job.next_step > 0) {
    Numbers along;
    if constexpr (has_necks<Law>)
      along = law.step_stiffness(frame.in, neck, necks.phase, job.next_step);
    else
      along = law.step_stiffness(frame.in, job.next_step);
    const auto s = stiffness_of<friction>(law, job.uniform, frame, normal, along, job.next_step);
    const auto present_only = [&](const Numbers& x) { return select(present, x, none); };
    rows_of<width>({present_only(s.xx), present_only(s.yy), present_only(s.zz), present_only(s.xy)}, stiff[0]);
    rows_of<width>({present_only(s.xz), present_only(s.yz), present_only(s.force), none}, stiff[1]);
  }

  if constexpr (has_necks<Law>) {
    Row after[width];
    rows_of<width>({neck.radius, neck.elastic, necks.column.c[2], necks.column.c[3]}, after);
    const unsigned stores = bits(present) & ~general;
    for (int l = 0; l < width; ++l)
      if (l < count && (stores >> l & 1)) after[l].store(reinterpret_cast<double*>(job.neck + block.place[l]));
  }
  if constexpr (friction)
    for (int l = 0; l < width; ++l)
      if (l < count && !(general >> l & 1)) slips[l].store3(job.tangential + 3 * std::size_t(block.place[l]));
  if constexpr (has_necks<Law>) {
    if (general != 0) {
      for (int l = 0; l < width; ++l) {
        if (l >= count || !(general >> l & 1)) continue;
        double of_i[8], of_j[8], stiffness[8];
        job.general(job, at + std::size_t(l), of_i, of_j, stiffness);
        stiff[0][l] = Row::load(stiffness);
        stiff[1][l] = Row::load(stiffness + 4);
        force_i[l] = Row::load(of_i);
        force_j[l] = Row::load(of_j);
        if constexpr (friction) {
          torque_i[l] = Row::load(of_i + 4);
          torque_j[l] = Row::load(of_j + 4);
        }
      }
    }
  }
  const std::size_t stride = job.stride;
  for (int l = 0; l < width; ++l) {
    if (l >= count) break;
    double *const i = job.sums + stride * block.slot_i[l], *const j = job.sums + stride * block.slot_j[l];
    (Row::load(i) + force_i[l]).store(i);
    if constexpr (friction) (Row::load(i + 4) + torque_i[l]).store(i + 4);
    (Row::load(j) + force_j[l]).store(j);
    if constexpr (friction) (Row::load(j + 4) + torque_j[l]).store(j + 4);
  }
  if (job.next_step > 0)
    for (int l = 0; l < width; ++l) {
      if (l >= count) break;
      for (const std::uint32_t slot : {block.slot_i[l], block.slot_j[l]}) {
        double* const sum = job.sums + stride * slot + (friction ? 8 : 4);
        (Row::load(sum) + stiff[0][l]).store(sum);
        (Row::load(sum + 4) + stiff[1][l]).store(sum + 4);
      }
    }
}

template <class Law, bool friction>
[[gnu::flatten]] void run(const KernelJob& shared, std::size_t begin, std::size_t end) {
  const KernelJob job = shared;  // nothing that the loop stores can change it
  const Law law = *static_cast<const Law*>(job.law);
  std::size_t at = begin;
  for (; at + width <= end; at += width) do_block<Law, friction>(law, job, at, width);
  if (at < end) do_block<Law, friction>(law, job, at, int(end - at));
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
