#pragma once
// The state of a simulation as datasets of an HDF5 file, and back with every size and index checked.

#include "dem/io/hdf5_file.h"
#include "dem/simulation.h"

namespace densify::dem {

/// Writes all of the state, groups /state, /particles, /contacts, /walls.  Throws FileError.
void write_state(Hdf5Writer&, const State&);

/// Reads a state for a simulation, whose setup says which histories there are and how many materials and walls.
/// Throws FileError naming what is missing or does not fit.
State read_state(const Hdf5Reader&, const Simulation&);

}  // namespace densify::dem
