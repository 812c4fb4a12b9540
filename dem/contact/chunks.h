#pragma once
// Contiguous chunks of the particles, each with the near pairs whose first particle is its own.  A chunk sums up the
// forces of its pairs by itself, on its own particles and on the others that its pairs reach; then each particle adds
// what the other chunks have for it, in their order.  The chunks depend on the number of particles alone, so that sums
// do not depend on the number of threads.

#include "dem/contact/near_list.h"

namespace densify::dem {

class Chunks {
 public:
  /// What chunk `from` has for a chunk: its sums [begin, end) among the sums for others.
  struct Incoming {
    std::size_t begin, end;
  };

  /// Divides the particles and sorts the near pairs to their chunks.  With `images_apart` what crosses a face of the
  /// cell has sums of its own, one for each particle and image, so that a pass knows the forces through the faces.
  void build(const ContactList&, const NearList&, std::size_t particles, int threads, bool images_apart = false);

  std::size_t count() const { return near_begin_.empty() ? 0 : others_begin_.size() - 1; }
  /// First particle of a chunk, which holds whole groups of the contact list.
  std::uint32_t begin(std::size_t chunk) const {
    return chunk == count() ? std::uint32_t(particles_)
                            : std::uint32_t(particles_ * chunk / count()) / ContactList::group * ContactList::group;
  }
  std::uint32_t size(std::size_t chunk) const { return begin(chunk + 1) - begin(chunk); }

  /// The near pairs of a bucket in a chunk.
  std::size_t near_begin(std::size_t bucket, std::size_t chunk) const { return near_begin_[bucket * count() + chunk]; }
  std::size_t near_end(std::size_t bucket, std::size_t chunk) const {
    return near_begin_[bucket * count() + chunk + 1];
  }
  /// Of each near pair: 8 x the place of i and of j among the sums of the chunk, its own particles first.
  const std::vector<std::uint16_t>& offsets_i() const { return offsets_i_; }
  const std::vector<std::uint32_t>& offsets_j() const { return offsets_j_; }

  /// The sums for others of all chunks, one after another: of which particle, and where a chunk's begin.
  const std::vector<std::uint32_t>& others() const { return others_; }
  /// The image codes of these particles; empty unless images are apart.
  const std::vector<std::uint8_t>& other_images() const { return other_images_; }
  std::size_t others_begin(std::size_t chunk) const { return others_begin_[chunk]; }
  /// What the other chunks have for a chunk, in their order.
  const std::vector<Incoming>& incoming(std::size_t chunk) const { return incoming_[chunk]; }

  std::size_t bytes() const;

 private:
  std::size_t particles_ = 0;
  std::vector<std::size_t> near_begin_;
  std::vector<std::uint16_t> offsets_i_;
  std::vector<std::uint32_t> offsets_j_, others_;
  std::vector<std::uint8_t> other_images_;
  std::vector<std::size_t> others_begin_;
  std::vector<std::vector<Incoming>> incoming_;
};

}  // namespace densify::dem
