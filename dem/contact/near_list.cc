#include "dem/contact/near_list.h"

#include <algorithm>
#include <limits>
#include <numeric>

namespace densify::dem {

namespace {

// Of the list's skin.  Smaller: fewer pairs in a pass, more prunings (half a pass each).
constexpr double share_of_skin = 0.25;

}  // namespace

void NearList::take_all(const ContactList& list) {
  content_ = Content::all;
  places_.resize(list.size());
  std::iota(places_.begin(), places_.end(), 0u);
  bucket_end_.clear();
  for (const auto& bucket : list.buckets) bucket_end_.push_back(bucket.end);
}

void NearList::prune(ContactList& list, const Particles& particles, const Cell& cell) {
  content_ = Content::pruned;
  skin_ = share_of_skin * list.skin;
  const ImageShifts shifts(cell);
  const Body* const body = particles.body.data();
  places_.reserve(list.first.capacity());
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
}

std::size_t NearList::bytes() const {
  return places_.capacity() * sizeof(std::uint32_t) + bucket_end_.capacity() * sizeof(std::size_t);
}

}  // namespace densify::dem
