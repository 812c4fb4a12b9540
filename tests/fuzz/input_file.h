#pragma once
// What every fuzz target shares: its bytes as a file, and the ways in which a reader may say no.

#include <unistd.h>

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string_view>

#include "base/check.h"

namespace densify::fuzz {

/// A file of this process that holds the bytes.
inline std::filesystem::path file_with(std::string_view bytes) {
  static const std::filesystem::path path =
      std::filesystem::temp_directory_path() / ("densify-fuzz-" + std::to_string(::getpid()));
  static const bool removed_at_exit = std::atexit([] { std::filesystem::remove(path); }) == 0;
  (void)removed_at_exit;
  std::ofstream(path, std::ios::binary) << bytes;
  return path;
}

/// Runs a reader; refusing is right, everything else that it throws is a finding.
template <class Work>
void must_read_or_refuse(Work&& work) {
  try {
    work();
  } catch (const InputError& error) {
    if (std::string_view(error.what()).empty()) std::abort();  // a refusal says why
  } catch (const FileError&) {
  } catch (const RunError&) {
  }
}

}  // namespace densify::fuzz
