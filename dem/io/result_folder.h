#pragma once
// The folder of a run's results, and when a fresh run may have it.

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace densify::dem {

enum class Continue : std::uint8_t { fresh, resume };

/// The folder of one run, closed to every other run while this object lives: the file run.lock in it is locked, not
/// written, so that a program that was killed leaves no lock behind.
class ResultFolder {
 public:
  /// Makes the folder ready.  `marks`: names of which any, in the folder, says that a run has begun there, the usual
  /// one first.  A fresh run takes an empty folder, or one of a run that had not begun (a specimen and a history
  /// without rows); a resumed one needs a mark.  Throws InputError and changes nothing otherwise, also while another
  /// run holds the folder; FileError when the folder cannot be made.
  ResultFolder(std::filesystem::path, Continue, std::vector<std::string> marks);

  /// Removes the folder again if this object made it and nothing but the lock is in it.
  void abandon();

 private:
  /// An open file whose lock ends with it.
  struct Lock {
    Lock() = default;
    ~Lock();
    Lock(const Lock&) = delete;
    Lock& operator=(const Lock&) = delete;
    int descriptor = -1;
  };
  void lock();

  bool require_free(Continue) const;

  std::filesystem::path folder_;
  std::vector<std::string> marks_;
  bool made_ = false;
  Lock lock_;
};

}  // namespace densify::dem
