#pragma once
// Loops over particles and contacts on a given number of threads.

#include <cstddef>

namespace densify::dem {

/// Calls work(begin, end) for contiguous parts of 0..n, one a thread.  One thread works without a parallel region,
/// since even an idle one costs as much as a whole step of two spheres.
template <class Work>
void in_parts(std::size_t n, int threads, const Work& work) {
  if (threads == 1) {
    work(std::size_t(0), n);
    return;
  }
#pragma omp parallel for num_threads(threads) schedule(static, 1)
  for (int t = 0; t < threads; ++t)
    work(n * std::size_t(t) / std::size_t(threads), n * std::size_t(t + 1) / std::size_t(threads));
}

}  // namespace densify::dem
