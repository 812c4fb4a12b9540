#pragma once
// Loops over particles and contacts on a given number of threads.

#include <algorithm>
#include <cstddef>
#include <limits>

namespace densify::dem {

namespace detail {
inline std::size_t part(std::size_t n, int t, int threads) {
  return n * std::size_t(t) / std::size_t(threads);
}
}  // namespace detail

/// Calls work(begin, end) for contiguous parts of 0..n, one a thread.  One thread works without a parallel region,
/// since even an idle one costs as much as a whole step of two spheres.
template <class Work>
void in_parts(std::size_t n, int threads, const Work& work) {
  if (threads == 1) {
    work(std::size_t(0), n);
    return;
  }
#pragma omp parallel for num_threads(threads) schedule(static, 1)
  for (int t = 0; t < threads; ++t) work(detail::part(n, t, threads), detail::part(n, t + 1, threads));
}

/// The largest of work(begin, end) over the same parts.
template <class Work>
double largest_of_parts(std::size_t n, int threads, const Work& work) {
  if (threads == 1) return work(std::size_t(0), n);
  double largest = -std::numeric_limits<double>::infinity();
#pragma omp parallel for num_threads(threads) schedule(static, 1) reduction(max : largest)
  for (int t = 0; t < threads; ++t)
    largest = std::max(largest, work(detail::part(n, t, threads), detail::part(n, t + 1, threads)));
  return largest;
}

}  // namespace densify::dem
