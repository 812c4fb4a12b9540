#include "dem/io/atomic_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <string>

#include "base/check.h"

namespace densify::dem {

namespace detail {

void throw_file_error(const std::filesystem::path& path, std::string_view action, int error_number) {
  std::string text = path.string() + ": cannot " + std::string(action) + " (" + std::strerror(error_number) + ")";
  switch (error_number) {
    case ENOSPC:
    case EDQUOT:
    case EFBIG:
      text += "; free some space and continue with --resume";
      break;
    case EACCES:
    case EPERM:
    case EROFS:
      text += "; choose a folder that you may write to with --out";
      break;
    case ENOENT:
    case ENOTDIR:
      text += "; check that its folder exists";
      break;
    default:
      break;
  }
  throw FileError(text);
}

int write_all(int descriptor, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t n = ::write(descriptor, bytes.data(), bytes.size());
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) return errno;
    bytes.remove_prefix(std::size_t(n));
  }
  return 0;
}

}  // namespace detail

namespace {

/// A descriptor that is closed at the end of its scope.
struct Descriptor {
  int number;
  explicit Descriptor(int n) : number(n) {}
  ~Descriptor() {
    if (number >= 0) ::close(number);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  /// The value of errno, 0 for success: a network file system may report a full disk only here.
  int close() {
    const int result = ::close(number) == 0 ? 0 : errno;
    number = -1;
    return result;
  }
};

std::filesystem::path folder_of(const std::filesystem::path& path) {
  return path.has_parent_path() ? path.parent_path() : std::filesystem::path(".");
}

/// Makes a rename in the folder durable; some file systems cannot and say so with EINVAL.
void sync_folder(const std::filesystem::path& folder) {
  const Descriptor d(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (d.number < 0 || (::fsync(d.number) != 0 && errno != EINVAL))
    detail::throw_file_error(folder, "write to this folder", errno);
}

[[noreturn]] void abandon(const std::filesystem::path& temporary, const std::filesystem::path& path, int error_number) {
  ::unlink(temporary.c_str());
  detail::throw_file_error(path, "write this file", error_number);
}

}  // namespace

std::filesystem::path temporary_beside(const std::filesystem::path& path) {
  std::filesystem::path temporary = path;
  temporary += ".tmp";
  return temporary;
}

void write_atomically(const std::filesystem::path& path, std::initializer_list<std::string_view> parts,
                      Durability durability) {
  const auto temporary = temporary_beside(path);
  {
    Descriptor d(::open(temporary.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666));
    if (d.number < 0) detail::throw_file_error(path, "write this file", errno);
    for (const auto part : parts)
      if (const int error = detail::write_all(d.number, part)) abandon(temporary, path, error);
    if (durability == Durability::power_loss && ::fsync(d.number) != 0) abandon(temporary, path, errno);
    if (const int error = d.close()) abandon(temporary, path, error);
  }
  if (::rename(temporary.c_str(), path.c_str()) != 0) abandon(temporary, path, errno);
  if (durability == Durability::power_loss) sync_folder(folder_of(path));
}

std::string read_whole_file(const std::filesystem::path& path) {
  const Descriptor d(::open(path.c_str(), O_RDONLY | O_CLOEXEC));
  if (d.number < 0) detail::throw_file_error(path, "read this file", errno);
  std::string content;
  char buffer[1 << 16];
  while (true) {
    const ssize_t n = ::read(d.number, buffer, sizeof buffer);
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) detail::throw_file_error(path, "read this file", errno);
    if (n == 0) return content;
    content.append(buffer, std::size_t(n));
  }
}

}  // namespace densify::dem
