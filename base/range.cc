#include "base/range.h"

#include <cmath>

#include "base/quantity.h"

namespace densify {

std::string Range::text(Dimension dimension) const {
  std::string text;
  if (std::isfinite(low)) {
    text.append(low_bound == Bound::inclusive ? ">= " : "> ").append(format_quantity(low, dimension));
  }
  if (std::isfinite(high)) {
    if (!text.empty()) text.append(" and ");
    text.append(high_bound == Bound::inclusive ? "<= " : "< ").append(format_quantity(high, dimension));
  }
  return text;
}

}  // namespace densify
