#include "dem/io/result_folder.h"

#include <algorithm>

#include "base/check.h"
#include "dem/io/atomic_file.h"

namespace densify::dem {

namespace {

namespace fs = std::filesystem;

/// True when nothing would be lost: nothing there, or what a run leaves that ended before its first checkpoint.
bool nothing_to_lose(const fs::path& folder) {
  for (const auto& entry : fs::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    if (name == "specimen.h5" || name == "specimen.h5.tmp" || name == "checkpoint.h5.tmp") continue;
    if (name != "history.csv") return false;
    const std::string rows = read_whole_file(entry.path());
    if (std::count(rows.begin(), rows.end(), '\n') > 1) return false;
  }
  return true;
}

}  // namespace

bool open_result_folder(const fs::path& folder, Continue mode) {
  try {
    const std::string name = folder.string();
    const bool there = fs::exists(folder), checkpoint = fs::exists(folder / "checkpoint.h5");
    if (mode == Continue::resume) {
      if (checkpoint) return false;
      throw InputError("--resume: " + name +
                       " holds no checkpoint.h5, so there is nothing to resume; start the run without --resume" +
                       (there && !nothing_to_lose(folder) ? " in another folder" : ""));
    }
    if (!there) return fs::create_directories(folder);
    if (!fs::is_directory(folder))
      throw InputError("--out " + name + ": this is a file, not a folder; choose another name");
    if (!nothing_to_lose(folder))
      throw InputError("--out " + name + ": the folder holds other results; nothing was changed.  Choose another " +
                       (checkpoint ? "folder, or continue that run with --resume" : "folder, or empty this one"));
    return false;
  } catch (const fs::filesystem_error& error) {
    throw FileError(folder.string() + ": cannot make or read this folder (" + error.code().message() +
                    "); choose another with --out");
  }
}

}  // namespace densify::dem
