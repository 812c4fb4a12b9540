#pragma once
// Numbers for the figures of doc/stability.md: written only when the environment names a folder for them.

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace densify::test {

/// Adds a row to NAME.csv in the folder DENSIFY_STABILITY_TABLES; the first row of a process writes the header.
class Table {
 public:
  Table(const std::string& name, const std::string& header) {
    const char* const folder = std::getenv("DENSIFY_STABILITY_TABLES");
    if (!folder) return;
    const auto path = std::filesystem::path(folder) / (name + ".csv");
    const bool fresh = !std::filesystem::exists(path);
    file_.open(path, std::ios::app);
    file_.precision(6);
    if (fresh) file_ << header << '\n';
  }
  template <class First, class... Rest>
  void row(const First& first, const Rest&... rest) {
    if (!file_.is_open()) return;
    file_ << first;
    ((file_ << ',' << rest), ...);
    file_ << '\n';
  }

 private:
  std::ofstream file_;
};

}  // namespace densify::test
