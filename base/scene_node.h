#pragma once
// The scene file as a tree of plain values, each of which knows where it was written.

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace densify {

/// One value of a scene: its kind, its content, and its place.
struct SceneNode {
  enum class Kind { flag, integer, number, text, list, table, other };

  Kind kind = Kind::table;
  bool flag = false;
  std::int64_t integer = 0;
  double number = 0.0;
  std::string text;
  std::vector<SceneNode> items;    ///< of a list or a table
  std::vector<std::string> names;  ///< of a table, one an item
  int line = 0;                    ///< in the scene file; 0 when it was not written there
  std::string origin;              ///< "--set path.to.key=value" when an override put it there

  /// The member of a table, or null.
  const SceneNode* find(std::string_view name) const;
  SceneNode* find(std::string_view name);
};

/// What a user would call the kind ("a number").
std::string_view kind_name(SceneNode::Kind kind);

/// Parses TOML.  Throws InputError "source:line:column: problem".
SceneNode parse_toml(std::string_view text, std::string_view source_name);

/// Applies "path.to.key=value": the value as TOML where it is TOML, as a text otherwise; list entries are numbered from
/// 1; missing tables are created; an empty value removes the key.  Throws InputError "--set path.to.key=value:
/// problem".
void apply_override(SceneNode& root, std::string_view assignment);

/// `parent.key` as users write it, with quotes round a key that TOML does not take bare.
std::string join_path(std::string_view parent, std::string_view key);

/// A key or a text in the quotes of TOML, escaped.
std::string toml_text(std::string_view text);

}  // namespace densify
