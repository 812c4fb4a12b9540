// What each feature of a scene costs, and how cost grows with the number of particles.

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>

#include "app/bench.h"
#include "app/bench_job.h"

namespace densify::app {

namespace {

struct NamedFeature {
  const char* name;
  BenchFeature feature;
};

constexpr NamedFeature features[] = {{"none (case A)", BenchFeature::none},
                                     {"friction and rotation", BenchFeature::friction},
                                     {"thermal expansion, heating", BenchFeature::heating},
                                     {"sintering (Maxwell)", BenchFeature::sintering},
                                     {"Hertz", BenchFeature::hertz},
                                     {"walls of a box", BenchFeature::walls},
                                     {"output every 100 steps", BenchFeature::output},
                                     {"periodic shear", BenchFeature::shear},
                                     {"without guards", BenchFeature::unguarded}};

struct Size {
  const char* packing;
  Eigen::Vector3i copies;
};

}  // namespace

int bench_features() {
  fmt::print("{:28} {:>12} {:>10} {:>6} {:>13} {:>12} {:>10}\n", "feature, on m2k", "ns/contact", "more", "z",
             "ns/part-step", "bytes/part", "more");
  double time = 0, bytes = 0;
  for (const auto& f : features) {
    BenchJob job;
    job.packing = "m2k";
    job.feature = f.feature;
    const BenchResult r = run_job(job);
    if (f.feature == BenchFeature::none) time = r.ns_per_contact_step, bytes = r.bytes_per_particle;
    fmt::print("{:28} {:>12.2f} {:>+9.0f}% {:>6.2f} {:>13.1f} {:>12.0f} {:>+10.0f}\n", f.name, r.ns_per_contact_step,
               100 * (r.ns_per_contact_step / time - 1), r.coordination_number, 1e9 / r.particle_steps_per_s,
               r.bytes_per_particle, r.bytes_per_particle - bytes);
    std::fflush(stdout);
  }
#ifdef DENSIFY_CHECKS
  fmt::print("The contracts between functions are checked in this build.\n");
#else
  fmt::print(
      "The contracts between functions are not checked in this build; DENSIFY_PRESET=audit is the same with them.\n");
#endif
  return 0;
}

int bench_scaling(int threads) {
  const Size sizes[] = {{"m2k", {1, 1, 1}}, {"m20k", {1, 1, 1}}, {"m20k", {5, 2, 1}}, {"m20k", {5, 5, 2}}};
  fmt::print("{:>9} {:>16} {:>10} {:>12} {:>16}\n", "particles", "ns/part-step", "ratio", "bytes/part",
             "peak bytes/part");
  double first = 0;
  for (const auto& size : sizes) {
    BenchJob job;
    job.packing = size.packing;
    job.copies = size.copies;
    job.threads = threads;
    job.steps = 100;  // the same part of the motion for all: it is at first that lists are built often
    const BenchResult r = run_job(job);
    const double ns = 1e9 / r.particle_steps_per_s;
    if (first == 0) first = ns;
    fmt::print("{:>9} {:>16.2f} {:>10.2f} {:>12.0f} {:>16.0f}\n", r.particles, ns, ns / first, r.bytes_per_particle,
               double(r.peak_resident) / double(r.particles));
    std::fflush(stdout);
  }
  return 0;
}

int bench_lists() {
  struct Row {
    const char* ratio;
    const char* packing;
    int copies;
    double giant;
  };
  constexpr Row rows[] = {{"1.1", "m2k", 1, 0}, {"12", "p1751", 1, 0}, {"50", "m20k", 3, 25}};
  fmt::print("{:>10} {:>9} {:>6} {:>18} {:>18} {:>12}\n", "size ratio", "particles", "z", "list/contact",
             "near list/contact", "ns/contact");
  for (const Row& row : rows) {
    BenchJob job;
    job.packing = row.packing;
    job.copies = Eigen::Vector3i::Constant(row.copies);
    job.giant = row.giant;
    job.steps = 100;
    const BenchResult r = run_job(job);
    fmt::print("{:>10} {:>9} {:>6.2f} {:>18.2f} {:>18.2f} {:>12.2f}\n", row.ratio, r.particles, r.coordination_number,
               r.list_pairs, r.near_pairs, r.ns_per_contact_step);
    std::fflush(stdout);
  }
  return 0;
}

}  // namespace densify::app
