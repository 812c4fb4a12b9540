#pragma once
// HDF5 files, written whole or not at all.  A small layer over the C API of HDF5 1.10, serial or parallel, that hides
// it from every header.  The library need not be thread-safe: readers and writers of other threads wait for each other.

#include <cstdint>
#include <filesystem>
#include <mutex>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "dem/io/atomic_file.h"
#include "dem/state/particles.h"

namespace densify::dem {

/// An HDF5 identifier that is closed at the end of its life.
class Hdf5Id {
 public:
  using Close = int (*)(std::int64_t);
  Hdf5Id() = default;
  Hdf5Id(std::int64_t number, Close close) : number_(number), close_(close) {}
  ~Hdf5Id() { reset(); }
  Hdf5Id(Hdf5Id&& other) noexcept : number_(other.number_), close_(other.close_) { other.number_ = -1; }
  Hdf5Id& operator=(Hdf5Id&& other) noexcept {
    std::swap(number_, other.number_);
    std::swap(close_, other.close_);
    return *this;
  }

  std::int64_t get() const { return number_; }
  bool valid() const { return number_ >= 0; }
  /// Closes now; false when the library could not.
  bool reset() {
    const bool fine = number_ < 0 || close_(number_) >= 0;
    number_ = -1;
    return fine;
  }

 private:
  std::int64_t number_ = -1;
  Close close_ = nullptr;
};

/// The turn of one thread in the library; a thread may hold several, for a reader beside a writer.
class Hdf5Turn {
 public:
  Hdf5Turn();

 private:
  std::unique_lock<std::recursive_mutex> turn_;
};

/// Extent of a dataset: `columns` is 1 for a list.
struct Hdf5Shape {
  std::size_t rows = 0, columns = 1;
};

class Hdf5Reader {
 public:
  /// Opens a file for reading.  This and all members throw FileError with path, object and cause.
  explicit Hdf5Reader(std::filesystem::path path);
  /// Opens the bytes of a file; `path` serves messages only.
  Hdf5Reader(std::filesystem::path path, std::string_view image);

  bool has(const std::string& name) const;
  /// True for an object in this very file, not behind a link to another file.
  bool has_own(const std::string& name) const;
  Hdf5Shape shape(const std::string& name) const;
  /// All values of a dataset of double, uint8, uint32 or uint64, row by row.
  template <class T>
  std::vector<T> read(const std::string& name) const;
  std::string text(const std::string& name) const;
  std::vector<std::string> texts(const std::string& name) const;
  /// An attribute of type double, uint64 or std::string.
  template <class T>
  T attribute(const std::string& object, const std::string& name) const;

  const std::filesystem::path& path() const { return path_; }
  std::int64_t id() const { return file_.get(); }

 private:
  Hdf5Turn turn_;  // first to come, last to go
  std::filesystem::path path_;
  Hdf5Id file_;
};

/// A file in the making, put together in memory: the library itself must never meet a full disk, for it does not always
/// survive a failed write.  Datasets and groups are named by their path inside it; missing groups on the way are made.
/// Until commit() nothing at `path` changes; without it nothing ever does.
class Hdf5Writer {
 public:
  /// This and all members throw FileError with path, object and cause.
  explicit Hdf5Writer(std::filesystem::path path);
  Hdf5Writer(const Hdf5Writer&) = delete;
  Hdf5Writer& operator=(const Hdf5Writer&) = delete;

  void group(const std::string& name);
  /// A list of double, uint8, uint32 or uint64; an empty unit writes no attribute `unit`.
  template <class T>
  void list(const std::string& name, const std::vector<T>& values, std::string_view unit);
  /// A table, row by row, with values.size() / columns rows.
  void table(const std::string& name, std::span<const double> values, std::size_t columns, std::string_view unit);
  void table(const std::string& name, const std::vector<Vec3>& values, std::string_view unit);
  void text(const std::string& name, std::string_view value);
  void texts(const std::string& name, const std::vector<std::string>& values);
  void attribute(const std::string& object, const std::string& name, double value);
  void attribute(const std::string& object, const std::string& name, std::uint64_t value);
  void attribute(const std::string& object, const std::string& name, std::string_view value);
  /// A link to an object of another file, whose name is relative to this one's folder.
  void external_link(const std::string& name, const std::string& file, const std::string& object);
  /// Copies an object with all it holds.
  void copy(const Hdf5Reader& from, const std::string& source, const std::string& target);

  /// The bytes of the file as it stands.
  std::string image();
  /// Puts the file in its place, atomically.
  void commit(Durability);

 private:
  void write(const std::string& name, const void* values, std::int64_t type, Hdf5Shape, int rank,
             std::string_view unit);
  void write_attribute(const std::string& object, const std::string& name, std::int64_t type, const void* value);

  Hdf5Turn turn_;  // first to come, last to go
  std::filesystem::path path_;
  Hdf5Id file_, make_groups_, no_times_;
};

}  // namespace densify::dem
