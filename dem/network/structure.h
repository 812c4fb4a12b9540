#pragma once
// What holds together in a contact network: coordination, fabric, islands, and whether one of them spans the cell.

#include "dem/network/specimen_network.h"

namespace densify::dem {

struct NetworkStructure {
  std::size_t particles = 0, contacts = 0, necks = 0;
  double coordination = 0;     ///< mean number of contacts of a particle
  Mat3 fabric = Mat3::Zero();  ///< mean of n n^T over the contacts, trace 1
  std::size_t rattlers = 0;    ///< particles without any contact
  std::size_t loose = 0;     ///< with fewer than four contacts to others of four: normal springs alone do not hold them
  std::size_t islands = 0;   ///< parts that no contact connects, without the rattlers
  std::size_t spanning = 0;  ///< particles of the islands that span
  /// Directions in which an island is connected to its own images: 3 for a body.  Of a region: 3 when an island has
  /// contacts with the surroundings in enough directions, 0 otherwise.
  int directions = 0;
};

NetworkStructure structure_of(const SpecimenNetwork&);

}  // namespace densify::dem
