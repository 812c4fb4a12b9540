#pragma once
// The contact law of one pair: what the lanes leave to it.

#include "dem/contact/force_pass.h"
#include "dem/contact/kernel.h"

namespace densify::dem {

/// The general law for one kind of contact.
GeneralLaw general_law(bool necks, bool hertz, bool friction);

}  // namespace densify::dem
