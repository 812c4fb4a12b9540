#include "dem/io/result_folder.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <string_view>

#include "base/check.h"
#include "dem/io/atomic_file.h"

namespace densify::dem {

namespace {

namespace fs = std::filesystem;

constexpr const char* lock_name = "run.lock";

/// What may be there before the first checkpoint, besides a history without rows.
constexpr std::array<std::string_view, 6> preliminary = {
    lock_name, "specimen.h5", "specimen.h5.tmp", "particle_sizes.csv", "particle_sizes.csv.tmp", "checkpoint.h5.tmp"};

/// True when nothing would be lost: nothing there, or what a run leaves that ended before its first checkpoint.
bool nothing_to_lose(const fs::path& folder) {
  for (const auto& entry : fs::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    if (std::find(preliminary.begin(), preliminary.end(), name) != preliminary.end()) continue;
    if (name != "history.csv") return false;
    const std::string rows = read_whole_file(entry.path());
    if (std::count(rows.begin(), rows.end(), '\n') > 1) return false;
  }
  return true;
}

}  // namespace

/// Throws InputError unless a run may have the folder; true when it is there.
bool ResultFolder::require_free(Continue mode) const {
  const std::string name = folder_.string();
  const bool there = fs::exists(folder_);
  const bool begun =
      std::any_of(marks_.begin(), marks_.end(), [&](const std::string& mark) { return fs::exists(folder_ / mark); });
  if (mode == Continue::resume) {
    if (begun) return true;
    throw InputError("--resume: " + name + " holds no " + marks_.front() +
                     ", so there is nothing to resume; start the run without --resume" +
                     (there && !nothing_to_lose(folder_) ? " in another folder" : ""));
  }
  if (!there) return false;
  if (!fs::is_directory(folder_))
    throw InputError("--out " + name + ": this is a file, not a folder; choose another name");
  if (!nothing_to_lose(folder_))
    throw InputError("--out " + name + ": the folder holds other results; nothing was changed.  Choose another " +
                     (begun ? "folder, or continue that run with --resume" : "folder, or empty this one"));
  return true;
}

ResultFolder::ResultFolder(fs::path folder, Continue mode, std::vector<std::string> marks)
    : folder_(std::move(folder)), marks_(std::move(marks)) {
  try {
    if (fs::exists(folder_ / lock_name)) lock();  // a run at work is named before what it has written so far
    if (!require_free(mode)) made_ = fs::create_directories(folder_);
    if (lock_.descriptor >= 0) return;
    lock();
    require_free(mode);  // another run may have come and gone since the first look
  } catch (const fs::filesystem_error& error) {
    throw FileError(folder_.string() + ": cannot make or read this folder (" + error.code().message() +
                    "); choose another with --out");
  }
}

ResultFolder::Lock::~Lock() {
  if (descriptor >= 0) ::close(descriptor);
}

void ResultFolder::lock() {
  const fs::path file = folder_ / lock_name;
  lock_.descriptor = ::open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
  if (lock_.descriptor < 0) detail::throw_file_error(file, "write this file", errno);
  if (::flock(lock_.descriptor, LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK) return;  // some disks have no locks
  throw InputError("--out " + folder_.string() +
                   ": another run is at work in this folder; nothing was changed.  Choose another folder, or wait for "
                   "that run to end");
}

void ResultFolder::abandon() {
  if (!made_) return;
  std::error_code in_use;
  const auto entries = std::distance(fs::directory_iterator(folder_, in_use), fs::directory_iterator());
  if (in_use || entries != 1) return;
  fs::remove(folder_ / lock_name, in_use);
  fs::remove(folder_, in_use);
}

}  // namespace densify::dem
