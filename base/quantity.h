#pragma once
// Quantities with units: the only door between what users write ("30 MPa") and the SI numbers inside.

#include <string>
#include <string_view>

#include "base/check.h"
#include "base/dimension.h"

namespace densify {

/// A text that is no quantity of the expected dimension; the caller adds the place.
struct QuantityError : InputError {
  using InputError::InputError;
};

/// The SI value of `text`, such as "4.86 um" or "15 K/min", which must have the powers of `expected`.  Prefixes and
/// powers of ten are exact ("4.86 um" is 4.86e-6 bit for bit).  The offset of degC applies only when the unit is degC
/// alone; "15 degC/min" is a difference.  Throws QuantityError.
double parse_quantity(std::string_view text, Dimension expected);

/// The shortest text that parse_quantity turns back into `si` bit for bit, in the coherent SI unit.  `si` must be
/// finite.
std::string format_quantity(double si, Dimension dimension);

}  // namespace densify
