#pragma once
// From a scene to the powder in its container: drawn and packed, or imported.

#include "dem/io/scene.h"
#include "dem/powder/compaction.h"

namespace densify::dem {

/// Draws and packs, or imports, what the scene asks for, without its perturbation.  Throws InputError: empty powder,
/// unreachable density, overlapping import, particle outside its container, ...
GreenBody make_specimen(const Scene&, int threads, const PackingProgress&);

/// Shifts every particle by up to `perturbation.size` of its radius along each axis, in the order of their numbers.
void perturb(GreenBody&, const PerturbationSettings&);

/// The diameters [m] and materials that the scene's powder or import asks for, without packing them.
PowderSample particles_of(const Scene&);

/// Everything that a Simulation of the scene needs.
Setup make_setup(const Scene&, const GreenBody&, int threads);

/// Writes and reads a finished specimen bit for bit, so that a resumed run need not pack again.  Reading throws
/// InputError for a file that is missing or damaged.
void write_specimen(const std::filesystem::path&, const GreenBody&);
GreenBody read_specimen(const std::filesystem::path&);

}  // namespace densify::dem
