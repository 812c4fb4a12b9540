#include "coupling/tabulate.h"

#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <mutex>
#include <thread>

#include "base/check.h"
#include "base/version.h"
#include "coupling/point_path.h"
#include "coupling/table_law.h"
#include "dem/specimen.h"
#include "fem/press/viscous_solid.h"

namespace densify::coupling {

namespace {

constexpr double check_heating = 2;  // over the heating rates of the process, of the path that is not in the table

std::string name_of(PathKind kind) {
  return kind == PathKind::die ? "die" : kind == PathKind::hydrostatic ? "hydrostatic" : "free";
}

struct Job {
  ElementPath path;
  int element;
};

/// Runs jobs on threads; the first error ends all.
class Jobs {
 public:
  Jobs(const dem::Scene& element, std::vector<Job> jobs, const TableOptions& options)
      : element_(element), jobs_(std::move(jobs)), options_(options), share_(jobs_.size(), 0.0) {
    records_.resize(jobs_.size(), PathRecord{element.schedule, {}});
  }

  std::vector<PathRecord> run();

 private:
  void work();
  void one(std::size_t k);

  const dem::Scene& element_;
  const std::vector<Job> jobs_;
  const TableOptions& options_;
  std::vector<PathRecord> records_;
  std::mutex mutex_;
  std::condition_variable ended_;
  std::vector<double> share_;
  std::size_t next_ = 0, done_ = 0;
  int working_ = 0;
  std::atomic<bool> stop_ = false;
  std::exception_ptr error_;
};

void Jobs::one(std::size_t k) {
  const Job& job = jobs_[k];
  dem::Scene scene = element_;
  if (scene.packing) scene.packing->seed += std::uint64_t(job.element);
  try {
    records_[k] = run_path(scene, job.path, [&](double share) {
      if (stop_) throw Interrupted("interrupted; no table is written");
      const std::lock_guard lock(mutex_);
      share_[k] = share;
    });
  } catch (const RunError& error) {
    throw RunError(fmt::format("element {}, path {} with {:g} times the pressure: {}", job.element + 1,
                               name_of(job.path.kind), job.path.pressure_factor, error.what()));
  }
}

void Jobs::work() {
  for (;;) {
    std::size_t k = 0;
    {
      const std::lock_guard lock(mutex_);
      if (next_ == jobs_.size() || stop_) break;
      k = next_++;
    }
    try {
      one(k);
    } catch (...) {
      const std::lock_guard lock(mutex_);
      if (!error_) error_ = std::current_exception();
      stop_ = true;
    }
    const std::lock_guard lock(mutex_);
    share_[k] = 1, ++done_;
  }
  const std::lock_guard lock(mutex_);
  --working_;
  ended_.notify_all();
}

std::vector<PathRecord> Jobs::run() {
  working_ = std::clamp(options_.threads, 1, int(jobs_.size()));
  std::vector<std::thread> threads;
  for (int t = 0, n = working_; t < n; ++t) threads.emplace_back([this] { work(); });
  {
    std::unique_lock lock(mutex_);
    while (working_ > 0) {
      ended_.wait_for(lock, std::chrono::milliseconds(250));
      if (options_.stop && *options_.stop) stop_ = true;
      TableProgress now{done_, jobs_.size(), 0};
      for (const double s : share_) now.share += s / double(jobs_.size());
      lock.unlock();
      if (options_.progress) options_.progress(now);
      lock.lock();
    }
  }
  for (auto& t : threads) t.join();
  if (error_) std::rethrow_exception(error_);
  if (stop_) throw Interrupted("interrupted; no table is written");
  return std::move(records_);
}

/// The pressure between two branches, or near the only one.
double check_pressure(const std::vector<double>& factors) {
  return factors.size() > 1 ? std::sqrt(factors[0] * factors[1]) : 0.8 * factors[0];
}

TableCheck checked(const ResponseTable& table, const ElementPath& path, const std::vector<PathRecord>& records) {
  TableCheck c;
  c.pressure_factor = path.pressure_factor;
  c.heating_factor = path.heating_factor;
  const fem::ViscousSolid material(std::make_shared<TableLaw>(table, true));
  // Mean of the elements at the times of the first, as far as all go.
  double end = std::numeric_limits<double>::infinity();
  for (const PathRecord& r : records) end = std::min(end, r.points.back().time);
  std::vector<ShapePreserving> curves;
  double start = 0;
  for (const PathRecord& r : records) {
    std::vector<double> time;
    std::vector<double> density;
    for (const PathPoint& p : r.points)
      if (time.empty() || p.time > time.back()) time.push_back(p.time), density.push_back(p.unloaded);
    start = std::max(start, time.front());
    curves.emplace_back(time, Eigen::Map<const Eigen::RowVectorXd>(density.data(), Eigen::Index(density.size())));
  }
  const double last = table.sintering.front().nodes.back().density;
  for (const PathPoint& p : records.front().points) {
    if (p.time < start || p.time > end) continue;
    double mean = 0;
    for (const auto& curve : curves) mean += curve(p.time)[0] / double(curves.size());
    if (mean > last) break;
    c.time.push_back(p.time), c.temperature.push_back(p.temperature), c.element.push_back(mean);
  }
  c.table = drive_point(material, records.front().schedule, PathKind::die, table.cold.front().density, c.time);
  for (std::size_t k = 0; k < c.time.size(); ++k) {
    double& error = c.temperature[k] < table.activation_temperature ? c.loose_error : c.error;
    error = std::max(error, std::abs(c.table[k] - c.element[k]));
  }
  return c;
}

}  // namespace

ResponseTable tabulate(const dem::Scene& element, const TableSettings& settings, const TableOptions& options) {
  ResponseTable t;
  t.activation_temperature = activation_of(element);
  t.revision = git_revision();
  const dem::Material& material = element.materials[0];
  t.material = material.name;
  t.particles = dem::particles_of(element).diameter.size();
  t.elements = std::size_t(settings.elements);
  t.reference_temperature = element.schedule.peak_temperature();
  t.diffusion = dem::complete_interface(element.materials, 0, 0, element.interfaces).diffusion;
  t.thermal_expansion = material.thermal_expansion;
  t.youngs_modulus = material.youngs_modulus;

  std::vector<ElementPath> paths;
  for (const double factor : settings.pressure_factors)
    paths.push_back({PathKind::die, factor, 1, settings.end_density, settings.longest_hold});
  for (const PathKind kind : {PathKind::hydrostatic, PathKind::free})
    paths.push_back({kind, 1, 1, settings.end_density, settings.longest_hold});
  const ElementPath untold{PathKind::die, check_pressure(settings.pressure_factors), check_heating,
                           settings.end_density, settings.longest_hold};
  paths.push_back(untold);
  std::vector<Job> jobs;
  for (const ElementPath& path : paths)
    for (int k = 0; k < settings.elements; ++k) jobs.push_back({path, k});
  const std::vector<PathRecord> records = Jobs(element, jobs, options).run();

  const auto of_path = [&](std::size_t p) {
    const auto first = records.begin() + std::ptrdiff_t(p * t.elements);
    return std::vector<PathRecord>(first, first + std::ptrdiff_t(t.elements));
  };
  t.cold = average_cold(of_path(settings.pressure_factors.size() - 1));
  for (std::size_t p = 0; p + 1 < paths.size(); ++p)
    t.sintering.push_back(average_sintering(of_path(p), name_of(paths[p].kind), paths[p].pressure_factor));
  t.check = checked(t, untold, of_path(paths.size() - 1));
  return t;
}

}  // namespace densify::coupling
