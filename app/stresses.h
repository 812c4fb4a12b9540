#pragma once
// densify stresses: stress in necks, particles and the specimen at chosen moments of a result (thesis 6).

#include "app/chosen_result.h"

namespace densify::app {

struct StressesCommand : ChosenResult {};

/// Returns the exit code; errors are thrown.
int stresses_command(const StressesCommand&);

}  // namespace densify::app
