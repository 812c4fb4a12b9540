#include "dem/ensemble_history.h"

#include <algorithm>
#include <cmath>

#include "base/check.h"
#include "base/nearest.h"

namespace densify::dem {

double value_at(const History& history, std::size_t column, double time) {
  const auto& t = history.values[0];
  const auto& v = history.values[column];
  const auto later = std::lower_bound(t.begin(), t.end(), time);
  if (later == t.end()) return v.back();
  const auto k = std::size_t(later - t.begin());
  if (*later == time || k == 0) return v[k];
  const double share = (time - t[k - 1]) / (t[k] - t[k - 1]);
  return v[k - 1] + share * (v[k] - v[k - 1]);
}

std::size_t column_index(const History& history, std::string_view name) {
  const auto found = std::find(history.columns.begin(), history.columns.end(), name);
  if (found == history.columns.end())
    throw InputError("\"" + std::string(name) + "\" is no column of the history" + did_you_mean(name, history.columns));
  return std::size_t(found - history.columns.begin());
}

std::vector<double> common_times(const Schedule& schedule, double interval, double end) {
  std::vector<double> times;
  for (double k = 0; k * interval < end; ++k) times.push_back(k * interval);
  for (std::size_t s = 0; s < schedule.stages().size(); ++s)
    if (schedule.stage_end(s) < end) times.push_back(schedule.stage_end(s));
  times.push_back(end);
  std::sort(times.begin(), times.end());
  times.erase(std::unique(times.begin(), times.end()), times.end());
  return times;
}

EnsembleHistory average(std::span<const History> histories, const std::vector<double>& times) {
  EnsembleHistory e;
  e.realisations = histories.size();
  const History& first = histories.front();
  const auto n = double(histories.size());
  e.mean.columns = e.standard_error.columns = first.columns;
  for (std::size_t c = 0; c < first.columns.size(); ++c) {
    auto& mean = e.mean.values.emplace_back();
    auto& error = e.standard_error.values.emplace_back();
    for (const double t : times) {
      double sum = 0, squares = 0;
      for (const History& h : histories) sum += value_at(h, c, t);
      for (const History& h : histories) squares += std::pow(value_at(h, c, t) - sum / n, 2);
      mean.push_back(c == 0 ? t : sum / n);
      error.push_back(c == 0 ? t : n > 1 ? std::sqrt(squares / (n - 1) / n) : std::nan(""));
    }
  }
  // The noise of the mean is that of one run over sqrt(n); the bias stays.
  if (std::count(first.columns.begin(), first.columns.end(), "relative_density_error") > 0) {
    auto& whole = e.mean.values[column_index(e.mean, "relative_density_error")];
    const auto& bias = e.mean.values[column_index(e.mean, "relative_density_bias")];
    for (std::size_t r = 0; r < times.size(); ++r) {
      const double noise = std::max(0.0, whole[r] * whole[r] - bias[r] * bias[r]);
      whole[r] = std::sqrt(bias[r] * bias[r] + noise / n);
    }
  }
  for (const double t : times) {
    const auto& rows = first.values[0];
    const auto row = std::lower_bound(rows.begin(), rows.end(), t);
    e.mean.stage.push_back(row == rows.end() ? first.stage.back() : first.stage[std::size_t(row - rows.begin())]);
  }
  e.standard_error.stage = e.mean.stage;
  return e;
}

void write_ensemble_history(const std::filesystem::path& path, const EnsembleHistory& e) {
  std::vector<HistoryColumn> columns;
  for (std::size_t c = 0; c < e.mean.columns.size(); ++c) {
    columns.push_back({e.mean.columns[c], ""});
    if (c == 0) columns.push_back({"stage", ""});
  }
  for (std::size_t c = 1; c < e.mean.columns.size(); ++c)
    columns.push_back({e.mean.columns[c] + "_standard_error", ""});
  HistoryFile file = HistoryFile::create(path, columns);
  std::vector<double> row;
  for (std::size_t r = 0; r < e.mean.stage.size(); ++r) {
    row.clear();
    for (const auto& column : e.mean.values) row.push_back(column[r]);
    for (std::size_t c = 1; c < e.standard_error.values.size(); ++c) row.push_back(e.standard_error.values[c][r]);
    file.add_row(row, e.mean.stage[r]);
  }
  file.sync();
}

}  // namespace densify::dem
