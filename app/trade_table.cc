#include "app/trade_table.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

namespace densify::app {

namespace {

/// Value of a column of each run at a time, minus that of the converged run of the same number when given.
std::vector<double> values(const std::vector<TradeRun>& runs, const char* column, double time,
                           const std::vector<TradeRun>* converged) {
  std::vector<double> v;
  for (std::size_t k = 0; k < runs.size(); ++k) {
    const auto at = [&](const TradeRun& run) {
      return dem::value_at(run.history, dem::column_index(run.history, column), time);
    };
    v.push_back(at(runs[k]) - (converged ? at((*converged)[k]) : 0.0));
  }
  return v;
}

/// Below this order the sizes are too large for the error to follow them yet.
constexpr double smallest_order = 0.4;

double deviation(const Estimate& e, std::size_t n) {
  return e.standard_error * std::sqrt(double(n));
}

TradeRow trade_row(const std::vector<TradeRun>& runs, const std::vector<TradeRun>& converged,
                   const std::vector<double>& times, double pressed) {
  TradeRow row;
  row.realisations = runs.size();
  const auto n = double(runs.size());
  for (const TradeRun& run : runs) {
    row.wall += run.wall / n;
    row.cpu += run.cpu / n;
    row.steps += run.steps / n;
    row.bytes += run.bytes / n;
    if (row.failure.empty()) row.failure = run.failure;
  }
  for (const TradeRun& run : converged)
    if (row.failure.empty() && !run.failure.empty()) row.failure = "the converged rung failed";
  row.density.resize(times.size());
  row.density_error.resize(times.size());
  if (!row.failure.empty()) return row;
  for (std::size_t p = 0; p < times.size(); ++p) {
    row.density[p] = estimate(values(runs, "relative_density", times[p], nullptr));
    row.density_error[p] = estimate(values(runs, "relative_density", times[p], &converged));
    if (std::abs(row.density_error[p].mean) > std::abs(row.density_error[row.worst].mean)) row.worst = p;
  }
  row.spread = deviation(row.density[row.worst], runs.size());
  row.stress_error = estimate(values(runs, "stress_zz_Pa", times.back(), &converged));
  row.coordination_error = estimate(values(runs, "coordination_number", times.back(), &converged));
  row.peak_stress_error = estimate(values(runs, "stress_zz_Pa", pressed, &converged));
  const double scale = std::abs(estimate(values(converged, "stress_zz_Pa", pressed, nullptr)).mean);
  row.peak_stress_error = {row.peak_stress_error.mean / scale, row.peak_stress_error.standard_error / scale};
  const auto& columns = runs.front().history.columns;
  if (std::find(columns.begin(), columns.end(), "relative_density_error") != columns.end()) {
    row.estimated_error = 0;
    for (const double t : times)
      row.estimated_error =
          std::max(row.estimated_error, estimate(values(runs, "relative_density_error", t, nullptr)).mean);
  }
  return row;
}

std::string csv_text(const std::string& text) {
  std::string field(1, '"');
  for (const char c : text) field.append(c == '"' ? 2 : 1, c);
  field.push_back('"');
  return field;
}

}  // namespace

Estimate estimate(const std::vector<double>& sample) {
  const auto n = double(sample.size());
  double sum = 0, squares = 0;
  for (const double x : sample) sum += x;
  for (const double x : sample) squares += (x - sum / n) * (x - sum / n);
  return {sum / n, n > 1 ? std::sqrt(squares / (n - 1) / n) : dem::unset};
}

std::vector<TradeRow> trade_rows(const Ladder& ladder, const std::vector<std::vector<TradeRun>>& runs,
                                 const std::vector<double>& times, double pressed) {
  std::size_t converged = 0;
  for (std::size_t r = 0; r < ladder.rungs.size(); ++r)
    if (ladder.rungs[r].converged) converged = r;
  std::vector<TradeRow> rows;
  for (std::size_t r = 0; r < runs.size(); ++r) {
    rows.push_back(trade_row(runs[r], runs[converged], times, pressed));
    rows.back().rung = r;
  }
  return rows;
}

std::vector<std::size_t> pareto_front(const std::vector<TradeRow>& rows) {
  std::vector<std::size_t> order;
  for (std::size_t r = 0; r < rows.size(); ++r)
    if (rows[r].failure.empty()) order.push_back(r);
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return rows[a].cpu < rows[b].cpu; });
  std::vector<std::size_t> front;
  for (const std::size_t r : order)
    if (front.empty() || rows[r].error() < rows[front.back()].error()) front.push_back(r);
  return front;
}

std::optional<std::size_t> cheapest_for(const std::vector<TradeRow>& rows, double target) {
  std::optional<std::size_t> best;
  for (std::size_t r = 0; r < rows.size(); ++r) {
    const TradeRow& row = rows[r];
    // The difference of the converged rung to itself says nothing of its own error.
    const double noise = row.standard_error() > 0 ? row.standard_error() : row.spread / std::sqrt(row.realisations);
    if (!row.failure.empty() || row.error() + 2 * noise > target) continue;
    if (!best || row.cpu < rows[*best].cpu) best = r;
  }
  return best;
}

double error_of_mean(const TradeRow& row, int n) {
  return std::hypot(row.error(), row.spread / std::sqrt(double(n)));
}

std::vector<Order> orders(const Ladder& ladder, const std::vector<TradeRow>& rows,
                          const std::vector<std::string>& points) {
  std::map<std::string, std::vector<std::size_t>> families;
  for (std::size_t r = 0; r < rows.size(); ++r)
    if (!ladder.rungs[r].family.empty() && rows[r].failure.empty()) families[ladder.rungs[r].family].push_back(r);
  std::vector<Order> all;
  for (auto& [name, members] : families) {
    std::sort(members.begin(), members.end(),
              [&](std::size_t a, std::size_t b) { return ladder.rungs[a].size < ladder.rungs[b].size; });
    if (members.size() < 3) continue;
    const auto size = [&](int m) { return ladder.rungs[members[std::size_t(m)]].size; };
    const double ratio = size(1) / size(0);
    if (std::abs(size(2) / size(1) / ratio - 1) > 1e-3) continue;
    for (std::size_t p = 0; p < points.size(); ++p) {
      const auto value = [&](int m) { return rows[members[std::size_t(m)]].density[p]; };
      const auto difference = [&](int m) {  // with its standard error, both runs independent
        return std::pair{value(m + 1).mean - value(m).mean,
                         std::hypot(value(m + 1).standard_error, value(m).standard_error)};
      };
      const auto [fine, fine_error] = difference(0);
      const auto [coarse, coarse_error] = difference(1);
      Order order{name, points[p], false, dem::unset, dem::unset, value(0).mean};
      order.seen = fine * coarse > 0 && std::abs(fine) > 2 * fine_error && std::abs(coarse) > 2 * coarse_error &&
                   std::abs(coarse) > std::abs(fine);
      const double growth = coarse / fine;
      order.order = std::log(growth) / std::log(ratio);
      order.seen = order.seen && order.order >= smallest_order;
      if (order.seen) {
        order.limit = value(0).mean - fine / (growth - 1);
      }
      all.push_back(order);
    }
  }
  return all;
}

std::string trade_csv(const Ladder& ladder, const std::vector<TradeRow>& rows, const std::vector<std::string>& points) {
  std::string csv =
      "rung,settings,realisations,wall_s,cpu_s,steps,memory_bytes,error_relative_density,"
      "error_relative_density_standard_error,worst_point,spread_of_one_realisation,estimated_error,"
      "error_final_stress_Pa,error_final_stress_standard_error_Pa,error_pressed_stress_relative,"
      "error_pressed_stress_relative_standard_error,error_coordination_number,"
      "error_coordination_number_standard_error";
  for (const auto& point : points)
    csv += fmt::format(",{},{},{},{}", csv_text("density at " + point),
                       csv_text("density at " + point + " standard error"), csv_text("error at " + point),
                       csv_text("error at " + point + " standard error"));
  csv += ",failure\n";
  for (const TradeRow& row : rows) {
    const Rung& rung = ladder.rungs[row.rung];
    std::string settings;
    for (const auto& s : rung.set) settings += (settings.empty() ? "" : " ") + s;
    const bool fine = row.failure.empty();
    csv += fmt::format("{},{},{},{:.6g},{:.6g},{:.0f},{:.0f},{:.6g},{:.6g},{},{:.6g},{:.6g}", csv_text(rung.name),
                       csv_text(settings), row.realisations, row.wall, row.cpu, row.steps, row.bytes,
                       fine ? row.error() : dem::unset, row.standard_error(), csv_text(fine ? points[row.worst] : ""),
                       row.spread, row.estimated_error);
    for (const Estimate& e : {row.stress_error, row.peak_stress_error, row.coordination_error})
      csv += fmt::format(",{:.6g},{:.6g}", e.mean, e.standard_error);
    for (std::size_t p = 0; p < points.size(); ++p)
      csv += fmt::format(",{:.8g},{:.6g},{:.6g},{:.6g}", row.density[p].mean, row.density[p].standard_error,
                         row.density_error[p].mean, row.density_error[p].standard_error);
    csv.append(",").append(csv_text(row.failure)).append("\n");
  }
  return csv;
}

}  // namespace densify::app
