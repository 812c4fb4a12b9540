#include "app/trade.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <thread>

#include "app/draw.h"
#include "app/progress_line.h"
#include "app/trade_jobs.h"
#include "base/check.h"
#include "base/version.h"
#include "dem/ensemble.h"
#include "dem/io/atomic_file.h"

namespace densify::app {

namespace {

namespace fs = std::filesystem;

/// Where densities are compared: the ends of the stages, and the ladder's own times.
struct Points {
  std::vector<double> times;
  std::vector<std::string> names;
  double pressed = 0;  ///< the last end of a stage under pressure [s]
};

Points points_of(const dem::Scene& scene, const Ladder& ladder) {
  Points p;
  std::vector<std::pair<double, std::string>> all;
  for (std::size_t s = 0; s < scene.schedule.stages().size(); ++s) {
    const double t = scene.schedule.stage_end(s);
    all.emplace_back(t, scene.schedule.stages()[s].name);
    if (scene.schedule.pressure(t) > 0) p.pressed = t;
  }
  for (const double t : ladder.times) all.emplace_back(t, fmt::format("{:g} s", t));
  std::stable_sort(all.begin(), all.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  for (auto& [time, name] : all) {
    p.times.push_back(time);
    p.names.push_back(name);
  }
  if (p.pressed == 0) p.pressed = p.times.back();
  return p;
}

std::vector<std::vector<dem::Scene>> scenes_of(const TradeCommand& command, const Ladder& ladder) {
  std::vector<std::vector<dem::Scene>> scenes;
  for (const Rung& rung : ladder.rungs) {
    std::vector<std::string> overrides = command.overrides;
    overrides.insert(overrides.end(), ladder.set.begin(), ladder.set.end());
    overrides.insert(overrides.end(), rung.set.begin(), rung.set.end());
    overrides.insert(overrides.end(),
                     {fmt::format("realisations={}", ladder.realisations), "output.visualisation=false"});
    try {
      const dem::Scene scene = dem::read_scene(command.scene, overrides);
      auto& of_rung = scenes.emplace_back();
      for (int k = 0; k < ladder.realisations; ++k) of_rung.push_back(dem::realisation(scene, k));
    } catch (const InputError& error) {
      throw InputError("rung \"" + rung.name + "\": " + error.what());
    }
  }
  return scenes;
}

std::string target_text(const Ladder& ladder, const std::vector<TradeRow>& rows, double target) {
  const auto best = cheapest_for(rows, target);
  if (!best) return fmt::format("{:<8g} no rung of this ladder, within twice its standard error", target);
  return fmt::format("{:<8g} \"{}\": {:.3g} s, {:.3g} steps", target, ladder.rungs[rows[*best].rung].name,
                     rows[*best].cpu, rows[*best].steps);
}

void print_trade(const Ladder& ladder, const std::vector<TradeRow>& rows, const Points& points) {
  fmt::print("\n{:<28s}{:>10s}{:>10s}{:>9s}{:>10s}{:>22s}  {:<22s}{:>8s}\n", "rung", "cpu [s]", "wall [s]", "MB",
             "steps", "density error", "at", "spread");
  const auto front = pareto_front(rows);
  for (const TradeRow& row : rows) {
    const Rung& rung = ladder.rungs[row.rung];
    fmt::print("{:<28s}", rung.name);
    if (!row.failure.empty()) {
      fmt::print("  failed: {}\n", row.failure);
      continue;
    }
    const bool best = std::find(front.begin(), front.end(), row.rung) != front.end();
    const std::string error =
        rung.converged ? "converged"
                       : fmt::format("{:+.2e} +- {:.1e}", row.density_error[row.worst].mean, row.standard_error());
    fmt::print("{:>10.3f}{:>10.3f}{:>9.2f}{:>10.0f}{:>22s}  {:<22s}{:>8.1e}{}\n", row.cpu, row.wall, row.bytes * 1e-6,
               row.steps, error, rung.converged ? "" : points.names[row.worst], row.spread, best ? "  *" : "");
  }
  fmt::print(
      "cpu, wall, steps: mean of one realisation without its packing; error: the largest over the points, mean of "
      "{} realisations against the converged rung with its standard error; spread: standard deviation of one "
      "realisation there; * Pareto front\n",
      ladder.realisations);

  fmt::print("\nerror of the mean of n realisations, sqrt(error^2 + spread^2/n), for n times the time\n{:<28s}", "n");
  for (int n = 1; n <= 2 * ladder.realisations; n *= 2) fmt::print("{:>10d}", n);
  for (const std::size_t r : front) {
    fmt::print("\n{:<28s}", ladder.rungs[rows[r].rung].name);
    for (int n = 1; n <= 2 * ladder.realisations; n *= 2) fmt::print("{:>10.1e}", error_of_mean(rows[r], n));
  }

  fmt::print("\n\norders of convergence\n");
  bool any = false;
  for (const Order& o : orders(ladder, rows, points.names)) {
    any = true;
    if (o.seen)
      fmt::print("{}, {}: order {:.2f}, extrapolated {:.5f} ({:+.5f} beyond the smallest)\n", o.family, o.point,
                 o.order, o.limit, o.limit - o.smallest);
    else
      fmt::print("{}, {}: not seen (differences within twice their standard error, or not falling with the size)\n",
                 o.family, o.point);
  }
  if (!any) fmt::print("no family with three sizes of one ratio\n");

  fmt::print("\ncheapest for a density error with two standard errors of at most\n");
  for (const double target : {1e-2, 3e-3, 1e-3}) fmt::print("{}\n", target_text(ladder, rows, target));
}

}  // namespace

int trade_command(const TradeCommand& command) {
  std::vector<std::string> overrides = command.overrides;
  const dem::Scene own = dem::read_scene(command.scene, overrides);
  Ladder ladder = command.ladder.empty() ? built_in_ladder(own) : read_ladder(command.ladder);
  if (command.realisations > 0) ladder.realisations = command.realisations;
  const Points points = points_of(own, ladder);
  if (!points.times.empty() && points.times.back() > own.schedule.end())
    throw InputError("ladder: times: a time after the end of the process; remove it");

  const fs::path folder = command.folder;
  const bool begun = fs::exists(folder) && !fs::is_empty(folder);
  if (begun && !command.resume)
    throw InputError(
        "--out " + folder.string() +
        ": the folder is not empty; nothing was changed.  Choose another folder, or continue with --resume");
  if (!begun && command.resume)
    throw InputError("--resume: " + folder.string() + " holds nothing to resume; start without --resume");

  TradeJobs jobs;
  jobs.scenes = scenes_of(command, ladder);
  jobs.folder = folder;
  jobs.threads = command.threads > 0 ? command.threads : int(std::max(1u, std::thread::hardware_concurrency()));
  jobs.version = std::string(version());
  jobs.stop = &catch_signals();
  ProgressLine line(command.quiet);
  jobs.progress = [&](std::size_t done, std::size_t all, double share, double left) {
    line.show_count("runs", done, all, share, left);
  };
  fs::create_directories(folder);
  const auto runs = run_jobs(jobs);
  line.end();
  const auto rows = trade_rows(ladder, runs, points.times, points.pressed);
  dem::write_atomically(folder / "trade.csv", {trade_csv(ladder, rows, points.names)}, dem::Durability::kill);
  if (command.quiet) return 0;
  print_trade(ladder, rows, points);
  if (draw("plot_trade.py", {folder / "trade.csv", "-o", folder / "trade"}))
    fmt::print("\nplots in {} and {}\n", (folder / "trade.png").string(), (folder / "trade.svg").string());
  fmt::print("table in {}\n", (folder / "trade.csv").string());
  return 0;
}

}  // namespace densify::app
