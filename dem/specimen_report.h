#pragma once
// What a finished specimen is like: size statistics with histograms (thesis Figs 5.18-5.21), green density.

#include "dem/powder/compaction.h"

namespace densify::dem {

struct SpecimenReport {
  std::vector<std::string> lines;  ///< in words, for the log and the effective input
  std::string sizes_csv;           ///< histograms by number and by volume, of each material and of all
};

/// The same for a specimen that was just made and for one that was read back.
SpecimenReport report_on(const GreenBody&, const std::vector<Material>&);

}  // namespace densify::dem
