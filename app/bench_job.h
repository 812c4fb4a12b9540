#pragma once
// One job of the benchmark: a packing, a case, and what was measured.

#include <filesystem>

#include "dem/simulation.h"

namespace densify::app {

/// A: linear spring and damper, no friction, no rotation.  B: A with friction and rotation.  S: sintering necks
/// (Maxwell) at constant temperature.
enum class BenchCase : std::uint8_t { A, B, S };

/// What a job has beside case A, one thing at a time.
enum class BenchFeature : std::uint8_t {
  none,
  friction,   ///< case B
  heating,    ///< thermal expansion while the temperature changes in every step
  sintering,  ///< case S
  hertz,
  walls,     ///< a box around the packing in place of the periodic cell
  output,    ///< a measured row of results every 100 steps
  shear,     ///< a periodic cell that deforms
  unguarded  ///< without what watches over the state
};

struct BenchJob {
  std::string packing;  ///< name of a file of benchmark/packings
  BenchCase benchmark = BenchCase::A;
  int threads = 1;
  std::uint64_t steps = 0;  ///< of one repeat; 0: as many as take about half a second
  BenchFeature feature = BenchFeature::none;
  Eigen::Vector3i copies{1, 1, 1};  ///< of the periodic packing along each edge
  double giant = 0;                 ///< radius of a sphere in the middle that takes the place of others; 0: none
};

/// Times of one thread are its processor time, of several the wall's; medians over the repeats.
struct BenchResult {
  std::string packing, benchmark;
  std::size_t particles = 0;
  std::size_t contacts_at_start = 0, contacts_at_end = 0;
  double coordination_number = 0;   ///< contacts per particle x 2, mean over start, repeats and end
  double particle_steps_per_s = 0;  ///< [1/s]
  double ns_per_contact_step = 0;   ///< [ns]
  double slowest_over_fastest = 0;  ///< of the repeats
  std::uint64_t steps = 0;          ///< of all repeats
  double bytes_per_particle = 0;    ///< state and scratch of the simulation
  std::size_t peak_resident = 0;    ///< of the process so far [B]
  std::size_t list_builds = 0;
  double list_pairs = 0, near_pairs = 0;  ///< pairs of the neighbour list and of the near list per contact, at the end
  double force_check = dem::unset;  ///< largest deviation from the plain double loop, see force_deviation; unset where
                                    ///< it would take minutes or does not know the feature
};

/// What a job simulates, in the reduced units of the packings (mean diameter 1, density 1, k_n = 1e5).
dem::Setup bench_setup(const BenchJob&, const std::filesystem::path& packing_file);

/// Evaluates the next step and compares its forces (and torques) with those that a plain double loop over all pairs,
/// without list, buckets or images, finds from the same state: largest deviation over the largest force (torque) of a
/// contact.
double force_deviation(dem::Simulation&);

BenchResult run_job(const BenchJob&);

/// The result as one JSON object on one line.
std::string to_json(const BenchResult&);

}  // namespace densify::app
