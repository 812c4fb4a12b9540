#pragma once
// Spellings that the readers of a section share.

#include <string>

#include "base/dimension.h"
#include "base/scene_node.h"

namespace densify {

/// A value for TOML: a text with its unit, a number with a point where the dimension is none, nothing for NaN.
std::string toml_quantity(double value, Dimension dimension);

/// The kind for the help: "pressure (Pa)", "number".
std::string type_text(Dimension dimension);

/// What stands in the scene, for messages: the text or number itself, else the kind.
std::string found_text(const SceneNode& node);

}  // namespace densify
