#pragma once
// What a run says of a scene's numbers in its effective input.

#include "dem/io/scene.h"
#include "dem/specimen_report.h"

namespace densify::dem {

/// The numbers behind the scene's numbers, as comments that a scene reader skips.
std::string derived_numbers(const Scene&, Simulation&, const SpecimenReport&);

}  // namespace densify::dem
