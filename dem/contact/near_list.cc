#include "dem/contact/near_list.h"

#include <algorithm>
#include <limits>
#include <numeric>

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

void NearList::take_all(const ContactList& list) {
  content_ = Content::all;
  places_.resize(list.size());
  std::iota(places_.begin(), places_.end(), 0u);
  bucket_end_.clear();
  for (const auto& bucket : list.buckets) bucket_end_.push_back(bucket.end);
}

void NearList::prune(ContactList& list, const Particles& particles, const Cell& cell) {
  if (content_ == Content::pruned && passes_ > many_passes) share_ = std::max(0.5 * share_, smallest_share);
  if (content_ == Content::pruned && passes_ < few_passes) share_ = std::min(2 * share_, largest_share);
  content_ = Content::pruned;
  passes_ = 0;
  skin_ = share_ * list.skin;
  const ImageShifts shifts(cell);
  const Body* const body = particles.body.data();
  places_.resize(list.size());
  bucket_end_.clear();
  std::size_t count = 0;
  for (const auto& bucket : list.buckets) {
    for (std::size_t k = bucket.begin; k < bucket.end; ++k) {
      const Body &a = body[list.i(k)], &b = body[list.j(k)];
      const double reach = a.radius + b.radius + skin_;
      bool near = (b.position - a.position + shifts[list.image(k)]).squaredNorm() < reach * reach;
      if (!list.neck.empty()) near = near || list.neck[k].phase != NeckPhase::loose;
      places_[count] = std::uint32_t(k);
      count += near;
      if (!near && !list.tangential.empty()) list.tangential[k].setZero();
    }
    bucket_end_.push_back(count);
  }
  places_.resize(count);
  places_.shrink_to_fit();
}

std::size_t NearList::bytes() const {
  return places_.capacity() * sizeof(std::uint32_t) + bucket_end_.capacity() * sizeof(std::size_t);
}

}  // namespace densify::dem
