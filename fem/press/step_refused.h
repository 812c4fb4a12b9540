#pragma once
// A step that cannot be taken, but perhaps a shorter one can.

#include <stdexcept>

namespace densify::fem {

struct StepRefused : std::runtime_error {
  using std::runtime_error::runtime_error;
};

}  // namespace densify::fem
