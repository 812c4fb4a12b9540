#pragma once
// The tables of densify moduli: one row a moment and contact model, in CSV and HDF5 from one list of columns.

#include <filesystem>

#include "dem/network/moduli.h"

namespace densify::app {

/// A table in the making; every row has the columns of the first, in its order.
class ResultTable {
 public:
  struct Cell {
    std::string column, unit;
    double value;
  };
  void add_row(std::string label, const std::vector<Cell>&);
  bool empty() const { return label_.empty(); }

  /// DIR/NAME.csv: the label under `label_name`, then columns named <column>_<unit>.  Throws FileError.
  void write_csv(const std::filesystem::path& folder, const std::string& name, const std::string& label_name) const;
  /// Datasets GROUP/<column> with attribute `unit`.
  void write_hdf5(dem::Hdf5Writer&, const std::string& group, const std::string& label_name) const;

 private:
  std::vector<std::string> label_, column_, unit_;
  std::vector<std::vector<double>> values_;  // of each column
};

/// Columns of a moment and its network.
std::vector<ResultTable::Cell> moment_cells(const dem::SpecimenNetwork&, const dem::NetworkStructure&);
/// Columns of a tensor: isotropic parts, 21 constants relaxed and affine, checks.
std::vector<ResultTable::Cell> stiffness_cells(const dem::TensorAnswer&);
std::vector<ResultTable::Cell> viscosity_cells(const dem::ViscousAnswer&);

}  // namespace densify::app
