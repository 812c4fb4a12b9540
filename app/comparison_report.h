#pragma once
// What densify compare-moduli says on the screen.

#include "app/comparison.h"

namespace densify::app {

/// The dense body with its bounds; E and nu, a line a density, a column a route and a curve; routes above the upper
/// bound.
void print_comparison(const std::string& name, const DenseBody&, const std::vector<Route>&);
/// A line a route and reference.
void print_deviations(const std::vector<Deviation>&);

}  // namespace densify::app
