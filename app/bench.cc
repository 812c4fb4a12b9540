#include "app/bench.h"

#include <fmt/format.h>

#include <cstdio>

#include "app/bench_job.h"
#include "base/check.h"
#include "base/nearest.h"

namespace densify::app {

namespace {

// Rounding of some ten summed contacts; a missing, doubled or stale contact shows at 1e-2 and more.
constexpr double largest_deviation = 1e-9;

const std::vector<std::string> packing_names = {"m2k", "m20k", "p1751"};
const std::vector<std::string> case_names = {"A", "B", "S"};

void require_known(const char* what, const std::string& name, const std::vector<std::string>& known) {
  if (std::find(known.begin(), known.end(), name) != known.end()) return;
  std::string list;
  for (const auto& k : known) list += (list.empty() ? "" : ", ") + k;
  throw InputError(fmt::format("bench: {}: unknown {}{}; give one of {}", name, what, did_you_mean(name, known), list));
}

std::vector<BenchJob> jobs_of(const BenchOptions& options) {
  if (options.threads < 1) throw InputError(fmt::format("bench: {} threads: give at least 1", options.threads));
  const auto packings = options.packings.empty() ? packing_names : options.packings;
  const auto cases = options.cases.empty() ? std::vector<std::string>{"A", "B"} : options.cases;
  std::vector<BenchJob> jobs;
  for (const auto& packing : packings)
    for (const auto& name : cases) {
      require_known("packing", packing, packing_names);
      require_known("case", name, case_names);
      const auto benchmark = name == "A" ? BenchCase::A : name == "B" ? BenchCase::B : BenchCase::S;
      jobs.push_back({packing, benchmark, options.threads, options.steps});
    }
  return jobs;
}

void print_line(const BenchResult& r) {
  fmt::print(
      "{:6} {:4} {:9} {:>6.2f} {:>9}..{:<9} {:>12.2f} {:>12.1f} {:>10.0f} {:>7} {:>6.2f} {:>6.2f} {:>10.1e} {:>8.2f}\n",
      r.packing, r.benchmark, r.particles, r.coordination_number, r.contacts_at_start, r.contacts_at_end,
      1e-6 * r.particle_steps_per_s, r.ns_per_contact_step, r.bytes_per_particle, r.list_builds, r.list_pairs,
      r.near_pairs, r.force_check, r.slowest_over_fastest);
  std::fflush(stdout);
}

}  // namespace

int bench_command(const BenchOptions& options) {
  if (options.features) return bench_features();
  if (options.lists) return bench_lists();
  if (options.scaling) return bench_scaling(options.threads);
  const auto jobs = jobs_of(options);
  if (!options.json)
    fmt::print(
        "packing case particles      z contacts start..end    Mpart-step/s  ns/contact  bytes/part  builds   list   "
        "near  "
        "deviation  spread\n");
  std::string json;
  bool right = true;
  for (const auto& job : jobs) {
    const BenchResult result = run_job(job);
    right = right && !(result.force_check > largest_deviation);
    if (options.json)
      json += (json.empty() ? "" : ",\n ") + to_json(result);
    else
      print_line(result);
  }
  if (options.json) fmt::print("{}\n", jobs.size() == 1 ? json : "[" + json + "]");
  if (right) return 0;
  fmt::print(stderr, "densify: bench: the forces of the contact pass differ from those of a plain double loop\n");
  return 3;
}

}  // namespace densify::app
