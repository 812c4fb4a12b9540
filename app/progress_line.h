#pragma once
// What long commands share: the line that tells how far they are, and the signals that end them.

#include <atomic>
#include <string>

#include "dem/ensemble.h"

namespace densify::app {

/// SIGINT and SIGTERM set the flag that this returns; a limit on the size of files becomes a failed write.
const std::atomic<bool>& catch_signals();

/// A line that rewrites itself on a terminal; elsewhere one line at every tenth of the way.
class ProgressLine {
 public:
  explicit ProgressLine(bool quiet);

  void show(const dem::Progress&);
  /// "3 of 8 runs", with the share of all work and the wall time that is left [s].
  void show_count(const char* what, std::size_t done, std::size_t all, double share, double seconds_left);
  /// What is being solved and how far it is, 0 to 1.
  void show_solution(const std::string& what, double share);
  /// A line of its own.
  void say(const std::string& line);
  /// To be called before anything else is printed.
  void end();

 private:
  void put(const std::string& line, int tenth);

  bool quiet_, terminal_, open_ = false;
  int last_tenth_ = -1;
};

}  // namespace densify::app
