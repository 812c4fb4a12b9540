#pragma once
// The folder of a run's results, and when a fresh run may have it.

#include <cstdint>
#include <filesystem>

namespace densify::dem {

enum class Continue : std::uint8_t { fresh, resume };

/// Makes the folder of a run ready; true when it was not there before.  A fresh run takes an empty folder, or one of a
/// run that ended before its first checkpoint (a specimen and a history without rows); a resumed one needs a
/// checkpoint.  Throws InputError and changes nothing otherwise; FileError when the folder cannot be made.
bool open_result_folder(const std::filesystem::path&, Continue);

}  // namespace densify::dem
