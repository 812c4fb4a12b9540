#pragma once
// Pictures for ParaView: .vtp files of particles (points), contacts (lines) and the periodic cell (lines) and the .pvd
// collections that give them their times.  Written by hand in VTK's XML format, so that nothing has to be installed.

#include <filesystem>

#include "dem/io/snapshot.h"

namespace densify::dem {

/// Whether files hold the stresses in particles and necks with their parts.
enum class StressFields : std::uint8_t { left_out, written };

/// Particles as points with radius, diameter, material, id, velocity, mean_stress, von_mises_stress and coordination;
/// with stress fields also stress (VTK's order xx yy zz xy yz xz) and, with necks, sintering_mean_stress and
/// viscoelastic_mean_stress.  Throws FileError.
void write_particles_vtp(const std::filesystem::path&, const Snapshot&, StressFields);

/// Contacts as lines from centre to centre with normal_force and, with necks, neck_radius and sintering_force; with
/// stress fields and necks also neck_stress, neck_sintering_stress and neck_viscoelastic_stress, NaN for a contact
/// without neck, and phase.  Throws FileError.
void write_contacts_vtp(const std::filesystem::path&, const Snapshot&, StressFields);

/// A periodic cell as its twelve edges.  Throws FileError.
void write_cell_vtp(const std::filesystem::path&, const Cell&);

/// The folder of all pictures of a run: particles.pvd, contacts.pvd, with a periodic cell cell.pvd, and the files they
/// list.
class Visualisation {
 public:
  /// Starts pictures in a folder, which is made, or goes on after the first `pictures` of it.
  /// Throws FileError, and InputError when the collection to go on with holds fewer.
  Visualisation(std::filesystem::path folder, std::uint64_t pictures, StressFields);

  /// Throws FileError.
  void add(const Snapshot&);

  std::uint64_t pictures() const { return times_.size(); }

 private:
  void write_collection(const std::string& what) const;

  std::filesystem::path folder_;
  StressFields stresses_;
  std::vector<std::string> times_;  // [s], as they stand in the collection
};

}  // namespace densify::dem
