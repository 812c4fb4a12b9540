#include "dem/contact/chunks.h"

#include <algorithm>

#include "dem/parallel.h"

namespace densify::dem {

namespace {

// Particles of a chunk: few enough that its sums stay in the nearest caches, many enough that not every pair crosses a
// border.
constexpr std::size_t usual_size = 512;

}  // namespace

void Chunks::build(const ContactList& list, const NearList& near, std::size_t particles, int threads,
                   bool images_apart) {
  particles_ = particles;
  const std::size_t chunks = std::max<std::size_t>(1, (particles + usual_size / 2) / usual_size);
  const std::size_t buckets = list.buckets.size();
  const auto& places = near.places();
  others_begin_.assign(chunks + 1, 0);
  near_begin_.assign(buckets * chunks + 1, places.size());
  // Anew, since a vector that grows by itself takes up to twice what it needs.
  offsets_i_ = std::vector<std::uint16_t>(places.size());
  offsets_j_ = std::vector<std::uint32_t>(places.size());
  // Sums for others by particle and image, the particle first; what does not cross a face has the image `none`.
  constexpr int image_bits = 5;
  constexpr std::uint64_t image_mask = (1u << image_bits) - 1;
  const auto key_of = [](std::uint32_t j, std::uint8_t image) { return std::uint64_t(j) << image_bits | image; };
  const auto particle_of = [](std::uint64_t key) { return std::uint32_t(key >> image_bits); };
  const auto crosses = [&](std::uint32_t k) { return images_apart && list.image(k) != ImageCode::none; };
  std::vector<std::vector<std::uint64_t>> others(chunks);

  for (std::size_t b = 0; b < buckets; ++b) {
    auto from = places.begin() + std::ptrdiff_t(b == 0 ? 0 : near.bucket_end()[b - 1]);
    const auto end = places.begin() + std::ptrdiff_t(near.bucket_end()[b]);
    for (std::size_t c = 0; c < chunks; ++c) {  // pairs of a bucket ascend by the groups of their first particles
      from = std::partition_point(from, end, [&](std::uint32_t k) { return list.i(k) < begin(c); });
      near_begin_[b * chunks + c] = std::size_t(from - places.begin());
    }
  }
  in_parts(chunks, threads, [&](std::size_t first, std::size_t last) {
    std::vector<std::uint32_t> slot(particles, 0);  // of each particle in the chunk, from 1; 0 for those not in it
    for (std::size_t c = first; c < last; ++c) {
      const std::uint32_t own = begin(c), beyond = begin(c + 1);
      auto& mine = others[c];
      for (std::uint32_t p = own; p < beyond; ++p) slot[p] = p - own + 1;
      for (std::size_t b = 0; b < buckets; ++b)
        for (std::size_t n = near_begin(b, c); n < near_end(b, c); ++n)
          if (const std::uint32_t j = list.j(places[n]); crosses(places[n])) {
            mine.push_back(key_of(j, list.image(places[n])));
          } else if (slot[j] == 0) {
            slot[j] = 1;
            mine.push_back(key_of(j, ImageCode::none));
          }
      std::sort(mine.begin(), mine.end());
      if (images_apart) mine.erase(std::unique(mine.begin(), mine.end()), mine.end());
      for (std::uint32_t k = 0; k < mine.size(); ++k)
        if ((mine[k] & image_mask) == ImageCode::none) slot[particle_of(mine[k])] = beyond - own + k + 1;
      const auto slot_of = [&](std::uint32_t k) {
        if (!crosses(k)) return slot[list.j(k)] - 1;
        const auto found = std::lower_bound(mine.begin(), mine.end(), key_of(list.j(k), list.image(k)));
        return beyond - own + std::uint32_t(found - mine.begin());
      };
      for (std::size_t b = 0; b < buckets; ++b)
        for (std::size_t n = near_begin(b, c); n < near_end(b, c); ++n) {
          offsets_i_[n] = std::uint16_t(8 * (list.i(places[n]) - own));
          offsets_j_[n] = 8 * slot_of(places[n]);
        }
      for (std::uint32_t p = own; p < beyond; ++p) slot[p] = 0;
      for (const std::uint64_t key : mine) slot[particle_of(key)] = 0;
    }
  });

  for (std::size_t c = 0; c < chunks; ++c) others_begin_[c + 1] = others_begin_[c] + others[c].size();
  others_ = std::vector<std::uint32_t>(others_begin_[chunks]);
  other_images_ = std::vector<std::uint8_t>(images_apart ? others_begin_[chunks] : 0);
  incoming_.assign(chunks, {});
  for (std::size_t c = 0; c < chunks; ++c) {
    const auto& mine = others[c];
    for (std::size_t k = 0; k < mine.size(); ++k) {
      others_[others_begin_[c] + k] = particle_of(mine[k]);
      if (images_apart) other_images_[others_begin_[c] + k] = std::uint8_t(mine[k] & image_mask);
    }
    for (std::size_t at = 0, owner = 0; at < mine.size();) {
      while (particle_of(mine[at]) >= begin(owner + 1)) ++owner;
      const std::size_t next = std::size_t(
          std::lower_bound(mine.begin() + std::ptrdiff_t(at), mine.end(), key_of(begin(owner + 1), 0)) - mine.begin());
      incoming_[owner].push_back({others_begin_[c] + at, others_begin_[c] + next});
      at = next;
    }
  }
}

std::size_t Chunks::bytes() const {
  std::size_t b = offsets_i_.capacity() * sizeof(std::uint16_t) +
                  (offsets_j_.capacity() + others_.capacity()) * sizeof(std::uint32_t) +
                  (near_begin_.capacity() + others_begin_.capacity()) * sizeof(std::size_t);
  b += other_images_.capacity();
  for (const auto& i : incoming_) b += i.capacity() * sizeof(Incoming) + sizeof(i);
  return b;
}

}  // namespace densify::dem
