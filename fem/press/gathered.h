#pragma once
// Lists of which every rank has a part: elements are given to ranks in their order.

#include <deal.II/base/mpi.h>

#include <vector>

namespace densify::fem {

/// The ranks' parts one after the other, on all of them.
inline std::vector<double> gathered(const std::vector<double>& own, MPI_Comm comm) {
  std::vector<double> all;
  for (const auto& part : dealii::Utilities::MPI::all_gather(comm, own))
    all.insert(all.end(), part.begin(), part.end());
  return all;
}

/// Where this rank's part of `own` entries begins.
inline std::size_t first_of_rank(std::size_t own, MPI_Comm comm) {
  std::size_t first = 0;
  const auto sizes = dealii::Utilities::MPI::all_gather(comm, own);
  for (unsigned r = 0; r < dealii::Utilities::MPI::this_mpi_process(comm); ++r) first += sizes[r];
  return first;
}

/// This rank's `own` entries of a list of all; an empty list has none.
inline std::vector<double> own_part(const std::vector<double>& all, std::size_t own, MPI_Comm comm) {
  const auto first = std::ptrdiff_t(first_of_rank(own, comm));
  if (all.empty()) return {};
  return {all.begin() + first, all.begin() + first + std::ptrdiff_t(own)};
}

}  // namespace densify::fem
