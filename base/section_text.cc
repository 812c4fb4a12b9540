#include "base/section_text.h"

#include <cmath>

#include "base/quantity.h"

namespace densify {

std::string toml_quantity(double value, Dimension dimension) {
  if (std::isnan(value)) return "";
  std::string text = format_quantity(value, dimension);
  if (!same_powers(dimension, dim::none)) return toml_text(text);
  if (text.find_first_of(".e") == std::string::npos) text.append(".0");
  return text;
}

std::string type_text(Dimension dimension) {
  if (same_powers(dimension, dim::none)) return "number";
  const std::string unit = si_unit(dimension);
  const std::string name = dimension_name(dimension);
  return name.ends_with(unit) ? name : name + " (" + unit + ")";
}

std::string found_text(const SceneNode& node) {
  switch (node.kind) {
    case SceneNode::Kind::text:
      return toml_text(node.text);
    case SceneNode::Kind::integer:
      return std::to_string(node.integer);
    case SceneNode::Kind::number:
      return std::isfinite(node.number) ? format_quantity(node.number, dim::none) : "a number that is not finite";
    case SceneNode::Kind::flag:
      return node.flag ? "true" : "false";
    default:
      return std::string(kind_name(node.kind));
  }
}

}  // namespace densify
