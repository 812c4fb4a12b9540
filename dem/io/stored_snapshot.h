#pragma once
// A snapshot back from a result.

#include "dem/io/hdf5_file.h"
#include "dem/io/snapshot.h"

namespace densify::dem {

/// The snapshot in a group of result.h5, such as /snapshots/000003.  Throws FileError when something is missing or does
/// not fit, InputError when an earlier version wrote no contacts with walls.
Snapshot read_snapshot(const Hdf5Reader&, const std::string& group);

}  // namespace densify::dem
