#pragma once
// Unit expressions such as "kJ/mol", "N s/m", "g/cm^3", "J/(mol K)".

#include <string>
#include <string_view>

#include "base/dimension.h"

namespace densify {

/// A unit in SI: number * 10^decimal_exponent * multiplier / divisor.
struct Unit {
  Dimension dimension;
  int decimal_exponent = 0;
  double multiplier = 1.0;
  double divisor = 1.0;
};

/// Turns the signs of Unicode into their plain spelling: the micro sign into u, the degree sign with C into degC,
/// raised 2 and 3 into ^2 and ^3, the middle dot into *.
std::string plain_spelling(std::string_view text);

/// Reads a unit expression: symbols with SI prefixes and integer powers, joined by a space, `*` or `/` (which binds
/// only the next symbol or bracket).  Throws QuantityError that names the symbol and the nearest known one.
Unit parse_unit(std::string_view text);

}  // namespace densify
