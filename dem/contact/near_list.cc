#include "dem/contact/near_list.h"

#include <algorithm>
#include <limits>
#include <numeric>

#include "dem/parallel.h"

namespace densify::dem {

namespace {

// The near skin is halved when a pruning served many passes, since fewer pairs then cost less, and doubled when it
// served few: a pruning costs about as much as two passes.
constexpr std::uint64_t few_passes = 100, many_passes = 400;
constexpr double largest_share = 0.25, smallest_share = 0.25 / 16;  // of the list's skin

}  // namespace

void NearList::clear() {
  const double share = share_;
  *this = NearList();
  share_ = share;
}

bool NearList::too_wide() const {
  return content_ == Content::pruned && passes_ > many_passes && share_ > smallest_share;
}

void NearList::take_all(const ContactList& list) {
  content_ = Content::all;
  places_.resize(list.size());
  std::iota(places_.begin(), places_.end(), 0u);
  bucket_end_.clear();
  for (const auto& bucket : list.buckets) bucket_end_.push_back(bucket.end);
}

void NearList::prune(ContactList& list, const Particles& particles, const Cell& cell, int threads) {
  if (content_ == Content::pruned && passes_ > many_passes) share_ = std::max(0.5 * share_, smallest_share);
  if (content_ == Content::pruned && passes_ < few_passes) share_ = std::min(2 * share_, largest_share);
  content_ = Content::pruned;
  passes_ = 0;
  skin_ = share_ * list.skin;
  const ImageShifts shifts(cell);
  const Body* const body = particles.body.data();
  places_.resize(list.size());
  const std::size_t parts = std::size_t(threads);
  std::vector<std::size_t> ends(parts);  // of what each part keeps, at the front of its range
  in_parts(parts, threads, [&](std::size_t t, std::size_t) {
    std::size_t count = detail::part(list.size(), int(t), threads);
    for (std::size_t k = count, end = detail::part(list.size(), int(t) + 1, threads); k < end; ++k) {
      const Body &a = body[list.i(k)], &b = body[list.j(k)];
      const double reach = a.radius + b.radius + skin_;
      bool near = (b.position - a.position + shifts[list.image(k)]).squaredNorm() < reach * reach;
      if (!list.neck.empty()) near = near || list.neck[k].phase != NeckPhase::loose;
      places_[count] = std::uint32_t(k);
      count += near;
      if (!near && !list.tangential.empty()) list.tangential[k].setZero();
    }
    ends[t] = count;
  });
  std::size_t count = ends[0];
  for (std::size_t t = 1; t < parts; ++t) {
    const auto from = places_.begin() + std::ptrdiff_t(detail::part(list.size(), int(t), threads));
    const auto to = places_.begin() + std::ptrdiff_t(ends[t]);
    count = std::size_t(std::copy(from, to, places_.begin() + std::ptrdiff_t(count)) - places_.begin());
  }
  places_.resize(count);
  places_.shrink_to_fit();
  bucket_end_.clear();
  for (const auto& bucket : list.buckets)
    bucket_end_.push_back(
        std::size_t(std::lower_bound(places_.begin(), places_.end(), std::uint32_t(bucket.end)) - places_.begin()));
}

std::size_t NearList::bytes() const {
  return places_.capacity() * sizeof(std::uint32_t) + bucket_end_.capacity() * sizeof(std::size_t);
}

}  // namespace densify::dem
