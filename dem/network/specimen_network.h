#pragma once
// The contact network of a periodic cell, or of the inner region of a specimen in a die, with what its contacts are
// made of: from a simulation as it stands or from a snapshot of a result.

#include "dem/io/hdf5_file.h"
#include "dem/io/scene.h"
#include "dem/network/network.h"

namespace densify::dem {

struct SpecimenNetwork {
  // Moment and specimen.
  double time = unset;              ///< process time [s]
  double temperature = unset;       ///< [K]
  double relative_density = unset;  ///< by envelope (5.5)
  std::string stage;
  double volume = 0;  ///< of the cell or region [m^3]
  Cell cell;          ///< periodic, or not
  /// Edges that leave an inner region end at their contact point, "at a wall"; halved contacts are twice as stiff.
  Network network;
  std::vector<Vec3> position;          ///< of each particle [m]
  std::vector<double> radius;          ///< [m]
  std::vector<std::uint8_t> material;  ///< index
  // Of each edge: the particle at its far end.
  std::vector<double> far_radius;          ///< [m]
  std::vector<std::uint8_t> far_material;  ///< index
};

/// A snapshot of a result.
struct StoredMoment {
  std::string group;  ///< in the file
  double time, temperature, relative_density;
};
std::vector<StoredMoment> stored_moments(const Hdf5Reader&);

/// The network of a snapshot; `scene` is the file's effective input.  Of a specimen between walls it keeps the
/// particles with their centres at least two mean diameters from every wall.  Throws InputError when there is no such
/// region or no cell, FileError when the file lacks something.
SpecimenNetwork read_network(const Hdf5Reader&, const Scene& scene, const StoredMoment&);

/// The network of a simulation in a periodic cell.
SpecimenNetwork network_of(const Simulation&);

}  // namespace densify::dem
