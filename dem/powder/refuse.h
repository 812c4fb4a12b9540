#pragma once

#include <sstream>

#include "base/check.h"

namespace densify::dem {

/// Throws an InputError made of the parts.
template <class... Parts>
[[noreturn]] void refuse(const Parts&... parts) {
  std::ostringstream s;
  (s << ... << parts);
  throw InputError(s.str());
}

}  // namespace densify::dem
