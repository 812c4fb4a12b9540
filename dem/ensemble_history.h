#pragma once
// Mean and standard error of the histories of several realisations, on common times.

#include <filesystem>
#include <span>

#include "base/schedule.h"
#include "dem/io/history_file.h"

namespace densify::dem {

/// Columns over time of an ensemble; `time_s` stands in both parts.
struct EnsembleHistory {
  std::size_t realisations = 0;
  History mean;
  History standard_error;  ///< sample standard deviation over sqrt(n); nan for one realisation
};

/// Values of a column at a time, linear between rows [unit of the column].  Rows are in order of time; a time outside
/// them gets the nearest row's.
double value_at(const History&, std::size_t column, double time);

/// Index of a column of numbers.  Throws InputError with the nearest name when there is none.
std::size_t column_index(const History&, std::string_view name);

/// The times at which an ensemble is reported [s]: start, multiples of the interval, ends of stages, up to `end`.
std::vector<double> common_times(const Schedule&, double interval, double end);

/// Mean and standard error of every column at the times; of `relative_density_error` what is left of it for the mean.
/// All histories have the same columns; a row's stage is that of the first history, where a time at the end of a stage
/// belongs to the stage that it ends.
EnsembleHistory average(std::span<const History>, const std::vector<double>& times);

/// One table: the columns of a history with the means, then `<column>_standard_error` of each but the time.  Throws
/// FileError.
void write_ensemble_history(const std::filesystem::path&, const EnsembleHistory&);

}  // namespace densify::dem
