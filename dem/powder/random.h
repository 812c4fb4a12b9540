#pragma once
// Random numbers that are the same with every standard library: only the engine's raw 64 bits are used.

#include <cstdint>
#include <random>
#include <utility>
#include <vector>

namespace densify::dem {

class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}

  /// Uniform in [0, 1).
  double uniform() { return double(engine_() >> 11) * 0x1p-53; }

  /// Uniform in 0..n-1, n > 0.
  std::uint64_t below(std::uint64_t n) {
    const std::uint64_t biased = -n % n;  // 2^64 mod n: as many of the lowest values would come once too often
    std::uint64_t x;
    do x = engine_();
    while (x < biased);
    return x % n;
  }

  template <class T>
  void shuffle(std::vector<T>& v) {
    for (std::size_t k = v.size(); k > 1; --k) std::swap(v[k - 1], v[below(k)]);
  }

 private:
  std::mt19937_64 engine_;  // its output is prescribed by the C++ standard, that of the distributions is not
};

}  // namespace densify::dem
