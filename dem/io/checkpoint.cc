#include "dem/io/checkpoint.h"

#include <charconv>
#include <cstring>

#include "base/check.h"
#include "dem/io/atomic_file.h"
#include "dem/io/hdf5_file.h"
#include "dem/io/state_image.h"

namespace densify::dem {

namespace {

constexpr std::size_t header_size = 512;  // the smallest that HDF5 skips
constexpr const char* damaged = "the checkpoint is not readable (truncated or damaged)";
constexpr std::string_view magic = "Densify checkpoint, format ";

/// FNV-1a with 64 bits; every step is a bijection, so that no single changed byte goes unseen.
std::uint64_t fnv1a(std::string_view bytes) {
  std::uint64_t hash = 14695981039346656037u;
  for (const char c : bytes) hash = (hash ^ std::uint8_t(c)) * 1099511628211u;
  return hash;
}

/// The header as it must be for these bytes: text that `head -c 512` shows.
std::string header_of(std::string_view image, int format) {
  std::string text(magic);
  text += std::to_string(format) + "\nbytes " + std::to_string(image.size()) + "\nfnv1a " +
          std::to_string(fnv1a(image)) + "\n";
  text.resize(header_size - 1, ' ');
  return text + "\n";
}

[[noreturn]] void refuse(const std::filesystem::path& path, const std::string& why) {
  throw InputError(path.string() + ": " + why + "; start again without --resume");
}

/// Format number of a file that starts as a checkpoint does; 0 when there is none.
int format_of(std::string_view bytes) {
  if (bytes.substr(0, magic.size()) != magic) return 0;
  int format = 0;
  std::from_chars(bytes.data() + magic.size(), bytes.data() + bytes.size(), format);
  return format;
}

}  // namespace

void write_checkpoint(const std::filesystem::path& path, const Simulation& simulation, const RunPosition& position,
                      const CheckpointOwner& owner) {
  Hdf5Writer file(path);
  file.attribute("/", "scene", owner.scene);
  file.attribute("/", "densify_version", owner.version);
  file.list<std::uint64_t>("/run/counts", {position.history_rows, position.history_bytes, position.snapshots}, "");
  file.attribute("/run", "wall_seconds", position.wall_seconds);
  file.list("/run/numbers", position.numbers, "");
  write_state(file, simulation.state());
  const std::string image = file.image();
  write_atomically(path, {header_of(image, checkpoint_format), image}, Durability::power_loss);
}

namespace {

/// The bytes of a checkpoint of this format, checked against its header.
std::string checked_bytes(const std::filesystem::path& path, const CheckpointOwner& owner) {
  if (!std::filesystem::exists(path)) refuse(path, "there is no checkpoint to resume from");
  std::string bytes = read_whole_file(path);
  const std::string_view image = std::string_view(bytes).substr(std::min(bytes.size(), header_size));
  const int format = format_of(bytes);
  if (format == 0 || bytes.compare(0, header_size, header_of(image, format)) != 0) refuse(path, damaged);
  if (format != checkpoint_format)
    refuse(path, "the checkpoint has format " + std::to_string(format) + " and this version of Densify (" +
                     owner.version + ") reads format " + std::to_string(checkpoint_format));
  return bytes;
}

void require_owner(const std::filesystem::path& path, const Hdf5Reader& file, const CheckpointOwner& owner) {
  if (file.attribute<std::string>("/", "scene") != owner.scene)
    refuse(path, "the checkpoint belongs to another scene (or to this one before it was changed)");
}

}  // namespace

void require_checkpoint(const std::filesystem::path& path, const CheckpointOwner& owner) {
  const std::string bytes = checked_bytes(path, owner);
  require_owner(path, Hdf5Reader(path, std::string_view(bytes).substr(header_size)), owner);
}

RunPosition read_checkpoint(const std::filesystem::path& path, Simulation& simulation, const CheckpointOwner& owner) {
  const std::string bytes = checked_bytes(path, owner);
  try {
    const Hdf5Reader file(path, std::string_view(bytes).substr(header_size));
    require_owner(path, file, owner);
    RunPosition position;
    const auto counts = file.read<std::uint64_t>("/run/counts");
    if (counts.size() != 3) refuse(path, damaged);
    position.history_rows = counts[0];
    position.history_bytes = counts[1];
    position.snapshots = counts[2];
    position.wall_seconds = file.attribute<double>("/run", "wall_seconds");
    position.numbers = file.read<double>("/run/numbers");
    simulation.restore(read_state(file, simulation));
    return position;
  } catch (const FileError& problem) {  // the checksum is right, so the file was written for something else
    refuse(path, "the checkpoint does not fit: " + std::string(problem.what()));
  }
}

}  // namespace densify::dem
