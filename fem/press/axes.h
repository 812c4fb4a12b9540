#pragma once
// Two and three dimensions under one roof: axes of a component, and what an integral over the mesh stands for.

#include <numbers>

namespace densify::fem {

/// Of a component of the displacement, among r theta z (dim = 2) or x y z.
template <int dim>
constexpr int axis(int component) {
  return dim == 2 && component == 1 ? 2 : component;
}

/// What an integral over the mesh at the radius r, or the coordinate x, is multiplied by for the whole cylinder.
template <int dim>
constexpr double around(double r) {
  return dim == 3 ? 4.0 : 2 * std::numbers::pi * r;
}

}  // namespace densify::fem
