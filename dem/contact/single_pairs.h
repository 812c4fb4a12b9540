#pragma once
// The contact pass pair by pair: what the lanes leave to the general law, and passes that keep a record.

#include "dem/contact/force_pass.h"
#include "dem/contact/kernel.h"

namespace densify::dem {

/// Both for one kind of law.
struct SinglePairs {
  decltype(KernelJob::general) general;
  /// A kernel that does the same as those in lanes, bit for bit, and fills the records by place in the contact list.
  void (*record)(const KernelJob&, std::size_t begin, std::size_t end, ContactRecord*);
};

SinglePairs single_pairs(bool necks, bool hertz, bool friction);

}  // namespace densify::dem
