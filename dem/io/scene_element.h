#pragma once
// The volume element of a scene of something larger.

#include "base/section.h"
#include "dem/io/scene.h"

namespace densify::dem {

/// Reads it from one table of that scene: what it is made of, how it is packed and moved.  Its temperatures are those
/// of the larger scene's process; nothing drives its cell yet.  Throws InputError as read_scene() does, and for what is
/// not a periodic cell.
Scene read_element(Section& element, const Section& process, const Schedule&);

}  // namespace densify::dem
