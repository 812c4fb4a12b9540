#pragma once
// Files that a reader finds whole: a kill at any moment leaves the old content or the new one, never a part.

#include <filesystem>
#include <initializer_list>
#include <string>
#include <string_view>

namespace densify::dem {

/// The name under which a file is written before it takes its place: beside it, with ".tmp" appended.
std::filesystem::path temporary_beside(const std::filesystem::path&);

/// What a file outlasts, and so how long writing it takes: some 10 ms a file for the loss of power.
enum class Durability {
  kill,       ///< temporary file and rename
  power_loss  ///< temporary file, fsync, rename, fsync of the folder
};

/// Replaces the file at `path` by the parts one after the other, under a temporary name first.
/// Throws FileError with path and cause (full disk, missing folder or permission); the old file is then untouched and
/// the temporary one removed.
void write_atomically(const std::filesystem::path& path, std::initializer_list<std::string_view> parts, Durability);

/// The content of a file.  Throws FileError with path and cause.
std::string read_whole_file(const std::filesystem::path& path);

namespace detail {
/// Throws FileError "path: cannot <action> (<text of errno>); <what to try>".
[[noreturn]] void throw_file_error(const std::filesystem::path& path, std::string_view action, int error_number);
/// Writes all bytes to an open descriptor; the value of errno, 0 for success.
int write_all(int descriptor, std::string_view bytes);
}  // namespace detail

}  // namespace densify::dem
