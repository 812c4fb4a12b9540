#pragma once
// Particles from other programs: tables with a header line, and LAMMPS data files.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "dem/state/cell.h"
#include "dem/state/particles.h"

namespace densify::dem {

/// Particles as they stand in a file, in its order.
struct ImportedParticles {
  std::string file;                   ///< for messages
  std::vector<Vec3> position;         ///< [m]
  std::vector<double> radius;         ///< [m]
  std::vector<std::string> material;  ///< name, or the type number of a LAMMPS file
  std::vector<int> line;              ///< of each particle, from 1
  std::optional<Cell> box;            ///< of a LAMMPS file that has bounds, as a periodic cell

  std::size_t size() const { return position.size(); }
};

/// Reads a table with columns x, y, z, radius, material in any order, named in the first line, separated by commas or
/// by blanks; `#` starts a comment.
/// @param unit  length of one unit of the file [m]
/// @throws InputError  with file and line for anything unreadable, missing, not finite or not positive
ImportedParticles read_particle_table(const std::filesystem::path& file, double unit);

/// Reads the bounds, the tilts and the section Atoms (id type diameter density x y z) of a LAMMPS data file.
/// @param unit  length of one unit of the file [m]
/// @throws InputError  with file and line, also when there are fewer or more atoms than declared
ImportedParticles read_lammps_data(const std::filesystem::path& file, double unit);

/// Refuses particles that overlap by more than `largest_fraction` of the smaller radius.
/// @param cell  periodic cell, or one that is not periodic for a free arrangement
/// @throws InputError  naming the worst pair and its lines
void reject_overlaps(const ImportedParticles& particles, const Cell& cell, double largest_fraction);

}  // namespace densify::dem
