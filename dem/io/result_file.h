#pragma once
// result.h5 and the snapshots of a run; the layout is in doc/results.md.  While a run goes on, every snapshot is a file
// of its own, DIR/snapshots/NNNNNN.h5, and result.h5 links to them; each is replaced whole, so that the folder can be
// read at any moment.  In the end all become one file.

#include "dem/io/history_file.h"
#include "dem/io/snapshot.h"

namespace densify::dem {

/// What a result file says of its run.
struct RunDescription {
  std::string effective_input;  ///< text of the scene with every derived number
  std::string version;          ///< of Densify
  std::string git_revision;
  std::vector<HistoryColumn> history_columns;  ///< units of the columns of DIR/history.csv
};

class ResultFile {
 public:
  /// Starts results in an existing folder, or goes on after the first `snapshots` snapshots of it and drops later ones.
  /// Throws FileError, and InputError when a snapshot to go on with is missing.
  ResultFile(std::filesystem::path folder, RunDescription, std::uint64_t snapshots);

  /// Writes a snapshot and result.h5 with the history so far.  Throws FileError.
  void add_snapshot(const Snapshot&);
  /// The run is complete: gathers history and all snapshots in result.h5 and removes the folder of snapshots; with
  /// more than `largest` bytes of them they stay in files of their own.  Throws FileError; all files are then as
  /// before.
  void consolidate(std::uintmax_t largest);
  static constexpr std::uintmax_t usual_largest = 512u << 20;  ///< the file is put together in memory [bytes]

  std::uint64_t snapshots() const { return snapshots_; }
  std::filesystem::path path() const { return folder_ / "result.h5"; }

 private:
  std::filesystem::path snapshot_path(std::uint64_t) const;
  void recover_snapshots() const;
  void write_linked(bool complete) const;

  std::filesystem::path folder_;
  RunDescription description_;
  std::uint64_t snapshots_;
};

}  // namespace densify::dem
