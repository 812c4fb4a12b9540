#pragma once
// The whole state of a simulation in one file, bit for bit, so that a resumed run has the trajectory of an
// uninterrupted one.  Layout: a text header of 512 bytes with the length and the checksum of what follows, then HDF5
// (which skips such a header).  Nothing of the content is interpreted before the checksum has been found right.

#include <filesystem>
#include <string>

#include "dem/io/run_position.h"
#include "dem/simulation.h"

namespace densify::dem {

inline constexpr int checkpoint_format = 5;  ///< raised whenever the layout or the meaning of the state changes

/// What a checkpoint belongs to.
struct CheckpointOwner {
  std::string scene;    ///< fingerprint of everything that determines the trajectory
  std::string version;  ///< of Densify
};

/// Writes the state between two steps, atomically.  Throws FileError.
void write_checkpoint(const std::filesystem::path&, const Simulation&, const RunPosition&, const CheckpointOwner&);

/// Restores the state into a simulation made from the same setup.  Throws InputError when the file is missing,
/// truncated, damaged, of another format or of another scene, and leaves the simulation as it was; FileError when it
/// cannot be read at all.
RunPosition read_checkpoint(const std::filesystem::path&, Simulation& to_restore, const CheckpointOwner&);

/// Throws what read_checkpoint would have against the file itself, before there is a simulation to restore.
void require_checkpoint(const std::filesystem::path&, const CheckpointOwner&);

}  // namespace densify::dem
