#pragma once
// `densify bench`: how fast the contact pass is on the packings of examples/benchmark, and whether it is right.

#include <cstdint>
#include <string>
#include <vector>

namespace densify::app {

struct BenchOptions {
  std::vector<std::string> packings;  ///< m2k, m20k, p1751; none given: all three
  std::vector<std::string> cases;     ///< A, B, S; none given: A and B
  int threads = 1;
  std::uint64_t steps = 0;  ///< steps of one repeat; 0: as many as take about half a second
  bool features = false;    ///< bench_features instead
  bool scaling = false;     ///< bench_scaling instead
  bool lists = false;       ///< bench_lists instead
  bool json = false;        ///< one JSON object (an array of them for several jobs) instead of a table
};

/// One table of case A on m2k with each feature of a scene switched on by itself.
int bench_features();

/// Case A on 2e3, 2e4, 2e5 and 1e6 particles (m2k, m20k and copies of it): time per particle and step, memory.
int bench_scaling(int threads);

/// Pairs that neighbour list and near list hold for one contact, case A with size ratios of 1.1, 12 and 50.
int bench_lists();

/// Runs every packing with every case and prints a line each; returns the exit code, 3 when the forces of a pass differ
/// from those of a plain double loop.  Throws InputError for an unknown name, FileError when the packings are missing.
int bench_command(const BenchOptions&);

}  // namespace densify::app
