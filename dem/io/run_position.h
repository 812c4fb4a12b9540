#pragma once
// How far a run has come with its files; travels with the checkpoint.

#include <cstdint>
#include <vector>

namespace densify::dem {

struct RunPosition {
  std::uint64_t history_rows = 0;   ///< rows of history.csv, without its header
  std::uint64_t history_bytes = 0;  ///< length of history.csv
  std::uint64_t snapshots = 0;      ///< written so far
  double wall_seconds = 0;          ///< spent so far [s]
  std::vector<double> numbers;      ///< whatever else the run must remember, in its own order
};

}  // namespace densify::dem
