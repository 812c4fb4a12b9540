#pragma once
// history.csv: one row an output time.

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace densify::dem {

/// A column; the unit stands in its name too, and alone for the attribute in result.h5.  The column named "stage"
/// holds text, all others numbers.
struct HistoryColumn {
  std::string name;
  std::string unit;
};

/// Rows appear in the file as they are added, with the fewest digits that give back every bit of a number.
class HistoryFile {
 public:
  /// Starts a file; an old one is replaced.  This and all members throw FileError with path and cause.
  static HistoryFile create(const std::filesystem::path&, const std::vector<HistoryColumn>&);
  /// Goes on after the first `bytes` bytes of a file and drops what is behind them.  Throws InputError when the file is
  /// missing, shorter, or has other columns.
  static HistoryFile resume(const std::filesystem::path&, const std::vector<HistoryColumn>&, std::uint64_t bytes);

  HistoryFile(HistoryFile&&) noexcept;
  HistoryFile& operator=(HistoryFile&&) = delete;
  ~HistoryFile();

  /// Adds a row: the numbers in the order of their columns and the text of `stage`; returns the length of the file.
  std::uint64_t add_row(std::span<const double> numbers, std::string_view stage);
  /// To be called before a checkpoint that relies on bytes(): makes them survive a loss of power.
  void sync();
  std::uint64_t bytes() const { return bytes_; }

 private:
  HistoryFile(std::filesystem::path, std::vector<HistoryColumn>, int descriptor, std::uint64_t bytes);
  void append(std::string_view text);

  std::filesystem::path path_;
  std::vector<HistoryColumn> columns_;
  int descriptor_;
  std::uint64_t bytes_;
};

/// A text as a field of a table; quoted after RFC 4180 when it must be, and always on one line.
std::string csv_field(std::string_view text);

/// The content of a history file.
struct History {
  std::vector<std::string> columns;         ///< names of the columns of numbers
  std::vector<std::vector<double>> values;  ///< of each column
  std::vector<std::string> stage;
};

/// Reads a history file; a last row that a kill left incomplete is passed over.  Throws FileError when it cannot be
/// opened and InputError naming the line that is no row of the table.
History read_history(const std::filesystem::path&);

}  // namespace densify::dem
