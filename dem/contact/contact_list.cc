#include "dem/contact/contact_list.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "base/check.h"
#include "dem/contact/neighbour_search.h"
#include "dem/parallel.h"

namespace densify::dem {

namespace {

using Key = std::uint64_t;
Key key_of(std::uint32_t i, std::uint32_t j, std::uint8_t image) {
  return (Key(i) << (ContactList::index_bits + 5)) | (Key(j) << 5) | image;
}

CandidatePair pair_of(Key key) {
  return {std::uint32_t(key >> (ContactList::index_bits + 5)), std::uint32_t(key >> 5) & ContactList::index_mask,
          std::uint8_t(key & 31)};
}

/// Sorts the pairs of one group of particles, ascending by (i, j), into rounds.
void sort_into_rounds(std::span<const CandidatePair> pairs, std::vector<CandidatePair>& out) {
  std::array<std::size_t, ContactList::group + 1> begin;  // of the pairs of each particle
  std::size_t particles = 0, rounds = 0;
  for (std::size_t k = 0; k < pairs.size(); ++k)
    if (k == 0 || pairs[k].i != pairs[k - 1].i) begin[particles++] = k;
  begin[particles] = pairs.size();
  for (std::size_t p = 0; p < particles; ++p) rounds = std::max(rounds, begin[p + 1] - begin[p]);
  for (std::size_t round = 0; round < rounds; ++round)
    for (std::size_t p = 0; p < particles; ++p)
      if (begin[p] + round < begin[p + 1]) out.push_back(pairs[begin[p] + round]);
}

/// Where the history of a pair was before the rebuild.
struct Kept {
  Key key;
  std::uint32_t place;
};

/// Those of all pairs that have a history, ascending by key.
struct Histories {
  std::vector<Kept> kept;
  std::vector<std::uint32_t> begin;  // of those of each particle i

  const Kept* find(const CandidatePair& pair) const {
    const Key key = key_of(pair.i, pair.j, pair.image);
    const Kept *const from = kept.data() + begin[pair.i], *const to = kept.data() + begin[pair.i + 1];
    const Kept* const old = std::lower_bound(from, to, key, [](const Kept& a, Key k) { return a.key < k; });
    return old != to && old->key == key ? old : nullptr;
  }
};

std::vector<Eigen::Vector3i> wrap_into_cell(Particles& particles, const Cell& cell) {
  std::vector<Eigen::Vector3i> moved(particles.size(), Eigen::Vector3i::Zero());
  const Mat3 to_fraction = cell.h.inverse();
  for (std::size_t p = 0; p < particles.size(); ++p) {
    Vec3& x = particles.body[p].position;
    const Vec3 s = to_fraction * (x - cell.origin);
    for (int k = 0; k < 3; ++k) moved[p][k] = int(std::floor(s[k]));
    if (moved[p] != Eigen::Vector3i::Zero()) x -= cell.h * moved[p].cast<double>();
  }
  return moved;
}

/// Under the keys that pairs with a history will have in the new list.
Histories histories(const ContactList& list, const std::vector<Eigen::Vector3i>& moved, const Eigen::Matrix3i& change,
                    const Particles& particles) {
  std::vector<Kept> found;
  for (std::size_t k = 0; k < list.size(); ++k) {
    const bool necked = !list.neck.empty() && list.neck[k].phase != NeckPhase::loose;
    const bool sheared = !list.tangential.empty() && !list.tangential[k].isZero(0);
    if (!necked && !sheared) continue;
    std::uint8_t image = list.image(k);
    if (!moved.empty()) {
      const Eigen::Vector3i n = change * ImageCode::unpack(image) + moved[list.j(k)] - moved[list.i(k)];
      if (n.cwiseAbs().maxCoeff() > 1)
        throw RunError("a contact spans more than one period of the cell (particles " +
                       std::to_string(particles.id[list.i(k)]) + " and " + std::to_string(particles.id[list.j(k)]) +
                       "); use a larger cell");
      image = ImageCode::of(n[0], n[1], n[2]);
    }
    found.push_back({key_of(list.i(k), list.j(k), image), std::uint32_t(k)});
  }
  // A counting sort over i, then the few of each i.
  Histories out{std::vector<Kept>(found.size()), std::vector<std::uint32_t>(particles.size() + 1, 0)};
  const auto particle = [](const Kept& k) { return std::size_t(k.key >> (ContactList::index_bits + 5)); };
  for (const Kept& k : found) ++out.begin[particle(k) + 1];
  for (std::size_t i = 0; i < particles.size(); ++i) out.begin[i + 1] += out.begin[i];
  std::vector<std::uint32_t> next(out.begin.begin(), out.begin.end() - 1);
  for (const Kept& k : found) out.kept[next[particle(k)]++] = k;
  for (std::size_t i = 0; i < particles.size(); ++i)
    std::sort(out.kept.begin() + out.begin[i], out.kept.begin() + out.begin[i + 1],
              [](const Kept& a, const Kept& b) { return a.key < b.key; });
  return out;
}

}  // namespace

void rebuild(ContactList& list, Particles& particles, const Cell& cell, const std::vector<double>& expansion,
             HistoryNeeds needs, int threads, const Eigen::Matrix3i& change) {
  if (particles.size() > ContactList::index_mask)
    throw InputError("powder: more than " + std::to_string(ContactList::index_mask) + " particles are not supported");
  const auto moved = cell.periodic ? wrap_into_cell(particles, cell) : std::vector<Eigen::Vector3i>{};
  const Histories old_histories = histories(list, moved, change, particles);
  // From here on the old histories alone are needed; the other arrays are filled anew where they are.
  const auto old_tangential = std::move(list.tangential);
  const auto old_neck = std::move(list.neck);
  list.tangential.clear();
  list.neck.clear();
  list.buckets.clear();

  std::vector<CandidatePair> pairs;
  pairs.reserve(list.first.capacity());
  find_pairs(particles.body, cell, list.skin, threads, pairs);

  // Necks that have opened beyond the list's reach stay.
  auto less = [](const CandidatePair& a, const CandidatePair& b) {
    return key_of(a.i, a.j, a.image) < key_of(b.i, b.j, b.image);
  };
  const std::size_t found = pairs.size();
  std::size_t at_pair = 0;  // both are sorted
  for (const Kept& old : old_histories.kept) {
    if (old_neck.empty() || old_neck[old.place].phase == NeckPhase::loose) continue;
    const CandidatePair pair = pair_of(old.key);
    while (at_pair < found && less(pairs[at_pair], pair)) ++at_pair;
    if (at_pair == found || less(pair, pairs[at_pair])) pairs.push_back(pair);
  }
  if (pairs.size() > found) std::sort(pairs.begin(), pairs.end(), less);

  // Buckets by pair of materials, the order inside kept (counting sort).
  std::size_t materials = 1;
  for (auto m : particles.material) materials = std::max<std::size_t>(materials, m + 1u);
  auto bucket_of = [&](const CandidatePair& p) {
    auto [a, b] = std::minmax(particles.material[p.i], particles.material[p.j]);
    return a * materials + b;
  };
  std::vector<std::size_t> start(materials * materials + 1, 0);
  for (const auto& p : pairs) ++start[bucket_of(p) + 1];
  for (std::size_t b = 0; b + 1 < start.size(); ++b) start[b + 1] += start[b];

  if (list.first.capacity() < pairs.size()) {  // a vector that grows by itself takes up to twice what it needs
    std::vector<std::uint32_t>().swap(list.first);
    std::vector<std::uint32_t>().swap(list.second);
    list.first.reserve(pairs.size() + pairs.size() / 16);
    list.second.reserve(list.first.capacity());
  }
  list.first.resize(pairs.size());
  list.second.resize(pairs.size());
  if (needs.friction) list.tangential.assign(pairs.size(), Vec3::Zero());
  if (needs.necks) list.neck.assign(pairs.size(), NeckHistory{});
  for (std::size_t b = 0; b + 1 < start.size(); ++b)
    if (start[b + 1] > start[b])
      list.buckets.push_back({start[b], start[b + 1], std::uint8_t(b / materials), std::uint8_t(b % materials)});
  std::vector<std::size_t> next(start.begin(), start.end() - 1);
  std::vector<std::vector<CandidatePair>> of_bucket(start.size() - 1);
  std::vector<CandidatePair> rounds;
  for (std::size_t at = 0; at < pairs.size();) {
    const std::uint32_t group = pairs[at].i / ContactList::group;
    for (auto& b : of_bucket) b.clear();
    for (; at < pairs.size() && pairs[at].i / ContactList::group == group; ++at)
      of_bucket[bucket_of(pairs[at])].push_back(pairs[at]);
    for (std::size_t b = 0; b < of_bucket.size(); ++b) {
      rounds.clear();
      sort_into_rounds(of_bucket[b], rounds);
      for (const CandidatePair& p : rounds) {
        const std::size_t k = next[b]++;
        list.first[k] = p.i;
        list.second[k] = p.j | std::uint32_t(p.image) << ContactList::index_bits;
        if (old_histories.kept.empty()) continue;
        const Kept* const old = old_histories.find(p);
        if (!old) continue;
        if (needs.friction && !old_tangential.empty()) list.tangential[k] = old_tangential[old->place];
        if (needs.necks && !old_neck.empty()) list.neck[k] = old_neck[old->place];
      }
    }
  }

  list.reference_position.resize(particles.size());
  list.largest_radius = 0;
  for (std::size_t p = 0; p < particles.size(); ++p) {
    list.reference_position[p] = particles.body[p].position;
    list.largest_radius = std::max(list.largest_radius, particles.body[p].radius);
  }
  list.reference_h = cell.h;
  list.reference_expansion = expansion;
  ++list.builds;
}

double approach(const ListMoment& then, const Particles& particles, const Cell& cell,
                const std::vector<double>& expansion, int threads) {
  const bool deformed = cell.periodic && cell.h != then.h;
  const Mat3 f = deformed ? Mat3(cell.h * then.h.inverse()) : Mat3(Mat3::Identity());
  const double furthest = largest_of_parts(particles.size(), threads, [&](std::size_t begin, std::size_t end) {
    const Body* const body = particles.body.data();
    const Vec3* const before = then.position.data();
    double part = 0, sum = 0;  // the sum is not finite when any displacement is not
    for (std::size_t p = begin; p < end; ++p) {
      const Vec3& x = body[p].position;
      const double d2 =
          deformed ? (x - cell.origin - f * (before[p] - cell.origin)).squaredNorm() : (x - before[p]).squaredNorm();
      part = std::max(part, d2);
      sum += d2;
    }
    return std::isfinite(sum) ? part : std::numeric_limits<double>::infinity();
  });
  if (std::isinf(furthest)) return unset;
  double growth = 0;
  for (std::size_t m = 0; m < expansion.size(); ++m)
    growth = std::max(growth, std::abs(expansion[m] / then.expansion[m] - 1));
  const double strain = deformed ? (f - Mat3::Identity()).norm() : 0;
  const double reach = 2 * then.largest_radius;
  return 2 * std::sqrt(furthest) + growth * reach + strain * (reach + then.skin);
}

double list_age(const ContactList& list, const Particles& particles, const Cell& cell,
                const std::vector<double>& expansion, int threads) {
  const ListMoment built{list.reference_position, list.reference_h, list.reference_expansion, list.largest_radius,
                         list.skin};
  return approach(built, particles, cell, expansion, threads) / list.skin;
}

}  // namespace densify::dem
