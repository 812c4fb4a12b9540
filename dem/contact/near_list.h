#pragma once
// The pairs of the contact list that may touch in the next few steps: a list pruned from the list.  Which pairs these
// are never changes a result, only its cost, so that no checkpoint holds them.

#include <array>

#include "dem/contact/contact_list.h"

namespace densify::dem {

/// The translations h n of the 27 image codes [m]; zero in a cell that is not periodic.
class ImageShifts {
 public:
  explicit ImageShifts(const Cell& cell) {
    for (std::uint8_t code = 0; code < shift_.size(); ++code)
      shift_[code] = cell.periodic ? cell.shift(code) : Vec3(Vec3::Zero());
  }
  const Vec3& operator[](std::uint8_t code) const { return shift_[code]; }

 private:
  std::array<Vec3, 27> shift_;
};

class NearList {
 public:
  /// Forgets the pairs and gives their memory back, for a rebuild of the contact list.
  void clear();
  bool empty() const { return content_ == Content::nothing; }

  /// All pairs of the list, good for as long as the list is.
  void take_all(const ContactList&);

  /// The pairs that are closer than touching + skin() and those with a neck, in the order of the list.  A pair left out
  /// loses its friction spring, as every pair does that does not touch.
  void prune(ContactList&, const Particles&, const Cell&, int threads);

  /// To be called in every pass: prunings that serve many make the skin smaller.
  void count_pass() { ++passes_; }
  /// True when a smaller skin would do: particles nearly at rest would otherwise never be pruned again.
  bool too_wide() const;

  /// How far the surfaces of two particles may approach after prune() until it must be pruned again [m].
  double skin() const { return skin_; }

  /// Places in the contact list, ascending; those of bucket b end at bucket_end()[b].
  const std::vector<std::uint32_t>& places() const { return places_; }
  const std::vector<std::size_t>& bucket_end() const { return bucket_end_; }

  std::size_t bytes() const;

 private:
  enum class Content : std::uint8_t { nothing, all, pruned };

  Content content_ = Content::nothing;
  std::vector<std::uint32_t> places_;
  std::vector<std::size_t> bucket_end_;
  double skin_ = 0;           // [m]
  double share_ = 0.25;       // of the list's skin
  std::uint64_t passes_ = 0;  // since prune()
};

}  // namespace densify::dem
