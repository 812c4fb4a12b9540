#pragma once
// The columns of history.csv and how a row comes about; only columns of features that the scene uses.

#include "dem/io/history_file.h"
#include "dem/measure/energy_balance.h"
#include "dem/measure/error_estimate.h"
#include "dem/measure/measures.h"

namespace densify::dem {

/// What rows need to remember from row to row; travels with the checkpoint.
struct HistoryMemory {
  Envelope initial;                      ///< shrinkage counts from here (5.4)
  double density = unset;                ///< of the row before
  double time = 0;                       ///< of the row before [s]
  double punch_impulse = 0;              ///< integral of the punch force since the row before [N s]
  double punch_time = 0;                 ///< [s]
  std::array<double, 6> cell_impulse{};  ///< integral of the driven cell's stress since the row before [Pa s]
  double cell_time = 0;                  ///< [s]
  EnergySums energy;                     ///< where they are asked for
  ErrorEstimate error;
  double density_error = 0;  ///< estimated, of this row's density

  std::vector<double> numbers() const;
  static HistoryMemory from(std::span<const double> numbers);
  static constexpr std::size_t size = 17 + EnergySums::size;
};

/// Names with units.
std::vector<HistoryColumn> history_columns(const Setup&);

/// The numbers of a row in the order of the columns (without "stage"), and the memory moved on to it.
std::vector<double> history_row(const Simulation&, const Measures&, HistoryMemory&);

}  // namespace densify::dem
