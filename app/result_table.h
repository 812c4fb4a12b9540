#pragma once
// A table of results in CSV and HDF5, from one list of columns.

#include <filesystem>
#include <string>
#include <vector>

#include "dem/io/hdf5_file.h"

namespace densify::app {

/// A table in the making; every row has the columns of the first, in its order.
class ResultTable {
 public:
  struct Cell {
    std::string column, unit;
    double value;
  };
  /// Columns of text stand first.
  explicit ResultTable(std::vector<std::string> text_columns);
  void add_row(const std::vector<std::string>& texts, const std::vector<Cell>&);
  bool empty() const { return rows() == 0; }
  std::size_t rows() const { return texts_.front().size(); }

  /// DIR/NAME.csv: columns named <column>_<unit>.  Throws FileError.
  void write_csv(const std::filesystem::path& folder, const std::string& name) const;
  /// Datasets GROUP/<column> with attribute `unit`.
  void write_hdf5(dem::Hdf5Writer&, const std::string& group) const;

 private:
  std::vector<std::string> text_column_, column_, unit_;
  std::vector<std::vector<std::string>> texts_;  // of each column
  std::vector<std::vector<double>> values_;
};

}  // namespace densify::app
