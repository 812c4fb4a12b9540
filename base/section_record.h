#pragma once
// What the visitors of a scene declared: the source of the help, of the effective input and of the search for unknown
// keys.

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "base/scene_node.h"

namespace densify {

struct SectionRecord;

/// One declared key.
struct SectionEntry {
  enum class Kind { value, section, list, named_list };

  std::string key;
  Kind kind = Kind::value;
  std::string type;      ///< "pressure", "whole number", "table", ...
  std::string range;     ///< what is allowed
  std::string fallback;  ///< "required", the default, or "-" for none
  std::string meaning;
  std::string value;                                     ///< in use, as TOML; empty when not set
  std::vector<std::unique_ptr<SectionRecord>> children;  ///< of a section (one), list or named list
  std::vector<std::string> names;                        ///< of a named list, one a child
};

/// One visited table and the keys declared in it, in order.
struct SectionRecord {
  std::string path;
  const SceneNode* table = nullptr;  // owned by the document
  std::vector<std::unique_ptr<SectionEntry>> entries;
};

/// A document between reading and writing: the parsed tree and the record of its visit.
struct SceneState {
  enum class Mode { reading, documenting };

  Mode mode = Mode::reading;
  std::string source_name;
  SceneNode root;
  SectionRecord record;
};

/// "file:line: path", or "--set path=value" for what an override put there.
std::string place_of(const SceneState& state, const SceneNode& node, std::string_view path);

/// All declared keys as aligned lines: path, kind, range, default, meaning.
std::string render_help(const SectionRecord& root);

/// All values in use as TOML, in the order of declaration.
std::string render_effective(const SectionRecord& root);

/// The names of all declared keys, wherever they stand.
std::vector<std::string> declared_keys(const SectionRecord& root);

/// Throws InputError for the first key of a visited table that nobody declared.
void reject_unknown_keys(const SceneState& state);

}  // namespace densify
