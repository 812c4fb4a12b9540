#pragma once
// What a body in the die is made of at a moment, whatever the number of ranks.

#include <vector>

namespace densify::fem {

struct PressState {
  std::vector<double> displacement, before;  ///< of the elements' degrees of freedom, element by element [m]
  std::vector<double> points;                ///< of each: F (9), volume ratio, rotation (9), then the material's state
  std::vector<double> wall;                  ///< of each of its points: friction (3) [Pa], 1 if closed
  double temperature = 0;                    ///< [K]
  double last_step = 0;                      ///< [s]
  double largest_scale = 0, shear = 0;       ///< [N], [Pa/m]
  double punch_closed = 1;                   ///< 1: a driven punch touches the body
};

}  // namespace densify::fem
