#include "base/data_path.h"

#include <cstdlib>
#include <string>
#include <system_error>
#include <vector>

#include "base/build_info.h"
#include "base/check.h"

namespace densify {
namespace {

std::vector<std::filesystem::path> data_roots() {
  std::vector<std::filesystem::path> roots;
  if (const char* named = std::getenv("DENSIFY_DATA"); named && *named) roots.emplace_back(named);
  std::error_code failed;
  const auto program = std::filesystem::read_symlink("/proc/self/exe", failed);
  if (!failed) roots.push_back(program.parent_path().parent_path() / "share" / "densify");
  roots.emplace_back(DENSIFY_SOURCE_DATA);
  return roots;
}

}  // namespace

std::filesystem::path data_path(std::string_view relative) {
  DENSIFY_EXPECT(std::filesystem::path(relative).is_relative());
  std::string searched;
  for (const auto& root : data_roots()) {
    auto candidate = root / relative;
    std::error_code unreadable;
    if (std::filesystem::exists(candidate, unreadable)) return candidate;
    searched += (searched.empty() ? "" : ", ") + root.string();
  }
  throw FileError("data file " + std::string(relative) + ": not found (searched " + searched +
                  "); set DENSIFY_DATA to the folder share/densify of an installation");
}

}  // namespace densify
