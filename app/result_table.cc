#include "app/result_table.h"

#include <fmt/core.h>

#include <cmath>

#include "dem/io/atomic_file.h"
#include "dem/io/history_file.h"

namespace densify::app {

namespace {

std::string header(const std::string& column, std::string unit) {
  if (unit.empty()) return column;
  for (auto at = unit.find(' '); at != std::string::npos; at = unit.find(' ')) unit[at] = '_';
  return column + "_" + unit;
}

}  // namespace

ResultTable::ResultTable(std::vector<std::string> text_columns)
    : text_column_(std::move(text_columns)), texts_(text_column_.size()) {}

void ResultTable::add_row(const std::vector<std::string>& texts, const std::vector<Cell>& cells) {
  if (empty())
    for (const Cell& c : cells) column_.push_back(c.column), unit_.push_back(c.unit), values_.emplace_back();
  for (std::size_t c = 0; c < texts_.size(); ++c) texts_[c].push_back(texts[c]);
  for (std::size_t c = 0; c < values_.size(); ++c) values_[c].push_back(cells[c].value);
}

void ResultTable::write_csv(const std::filesystem::path& folder, const std::string& name) const {
  std::string text;
  for (const auto& column : text_column_) text += (text.empty() ? "" : ",") + column;
  for (std::size_t c = 0; c < column_.size(); ++c) text += ',' + header(column_[c], unit_[c]);
  text += '\n';
  for (std::size_t r = 0; r < rows(); ++r) {
    for (std::size_t c = 0; c < texts_.size(); ++c) {
      if (c > 0) text += ',';
      text += dem::csv_field(texts_[c][r]);
    }
    for (const auto& column : values_) text += std::isnan(column[r]) ? ",nan" : fmt::format(",{}", column[r]);
    text += '\n';
  }
  dem::write_atomically(folder / (name + ".csv"), {text}, dem::Durability::kill);
}

void ResultTable::write_hdf5(dem::Hdf5Writer& file, const std::string& group) const {
  for (std::size_t c = 0; c < texts_.size(); ++c) file.texts(group + "/" + text_column_[c], texts_[c]);
  for (std::size_t c = 0; c < column_.size(); ++c) file.list(group + "/" + column_[c], values_[c], unit_[c]);
}

}  // namespace densify::app
