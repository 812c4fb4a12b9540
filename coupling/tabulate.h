#pragma once
// From a scene with a volume element to its response table.

#include <atomic>
#include <functional>

#include "coupling/element_path.h"
#include "coupling/response_table.h"

namespace densify::coupling {

/// What a table is made of.
struct TableSettings {
  std::vector<double> pressure_factors{0.5, 1.0, 1.5};  ///< over the process's pressures, growing: branches of path die
  int elements = 3;                                     ///< averaged, seeds of the packing counted up
  double end_density = 0.985;                           ///< relative, where the paths end
  double longest_hold = 36000;                          ///< at the highest temperature, for it [s]
};

/// One path of one element, and how far all are.
struct TableProgress {
  std::size_t done = 0, all = 0;
  double share = 0;
};

struct TableOptions {
  int threads = 1;                                     ///< paths at a time
  std::function<void(const TableProgress&)> progress;  ///< about four times a second; may be empty
  const std::atomic<bool>* stop = nullptr;             ///< set by a signal
};

/// Leads elements along the paths, averages them, and compares the table with a path that is not in it: of a pressure
/// between two branches and twice the heating rates.  Throws InputError, RunError (naming the path), Interrupted.
ResponseTable tabulate(const dem::Scene& element, const TableSettings&, const TableOptions&);

/// The nodes that several elements have in common, as means.  Throws RunError when they have too few points for it.
std::vector<ColdNode> average_cold(const std::vector<PathRecord>&);
SinteringBranch average_sintering(const std::vector<PathRecord>&, const std::string& path, double pressure_factor);

}  // namespace densify::coupling
