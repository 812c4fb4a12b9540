#pragma once
// The tables of densify stresses, gathered moment by moment: stresses of the specimen, statistics of particles and
// necks, histograms.

#include "app/result_table.h"
#include "dem/measure/moment_stresses.h"

namespace densify::app {

class StressTables {
 public:
  StressTables();
  void add(const dem::Snapshot&, const dem::MomentStresses&);

  /// macroscopic_stress.csv, particle_stress.csv, neck_stress.csv (with necks) and stress_histograms.csv.
  /// Throws FileError.
  void write_csv(const std::filesystem::path& folder) const;
  /// The same as groups.
  void write_hdf5(dem::Hdf5Writer&) const;
  bool has_necks() const { return !necks_.empty(); }

 private:
  /// What one histogram counts.
  struct Sample {
    double time;
    std::string stage, where, stress, set;
    dem::Group group;
  };
  void add_macroscopic(const dem::Snapshot&, const dem::MomentStresses&);
  void add_particles(const dem::Snapshot&, const dem::MomentStresses&);
  void add_necks(const dem::Snapshot&, const dem::MomentStresses&);
  ResultTable histograms() const;

  ResultTable macroscopic_, particles_, necks_;
  std::vector<Sample> samples_;
};

/// Stresses of every particle and neck of a moment, as lists in a group.
void write_each(dem::Hdf5Writer&, const std::string& group, const dem::Snapshot&, const dem::MomentStresses&);

}  // namespace densify::app
