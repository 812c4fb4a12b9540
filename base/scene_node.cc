#include "base/scene_node.h"

#include <toml++/toml.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <optional>
#include <utility>

#include "base/check.h"

namespace densify {
namespace {

SceneNode convert(const toml::node& source) {
  SceneNode node;
  node.line = static_cast<int>(source.source().begin.line);
  if (const auto* table = source.as_table()) {
    node.kind = SceneNode::Kind::table;
    for (const auto& [key, member] : *table) {
      node.names.emplace_back(key.str());
      node.items.push_back(convert(member));
    }
  } else if (const auto* array = source.as_array()) {
    node.kind = SceneNode::Kind::list;
    for (const toml::node& item : *array) node.items.push_back(convert(item));
  } else if (const auto* text = source.as_string()) {
    node.kind = SceneNode::Kind::text;
    node.text = text->get();
  } else if (const auto* integer = source.as_integer()) {
    node.kind = SceneNode::Kind::integer;
    node.integer = integer->get();
  } else if (const auto* number = source.as_floating_point()) {
    node.kind = SceneNode::Kind::number;
    node.number = number->get();
  } else if (const auto* flag = source.as_boolean()) {
    node.kind = SceneNode::Kind::flag;
    node.flag = flag->get();
  } else {
    node.kind = SceneNode::Kind::other;
  }
  return node;
}

void set_origin(SceneNode& node, const std::string& origin) {
  node.line = 0;
  node.origin = origin;
  for (SceneNode& item : node.items) set_origin(item, origin);
}

SceneNode parse_value(const std::string& text) {
  try {
    SceneNode root = parse_toml("v = " + text, "");
    if (root.items.size() == 1 && text.find('\n') == std::string::npos) return std::move(root.items.front());
  } catch (const InputError&) {  // not TOML: the shell has eaten the quotes
  }
  SceneNode node;
  node.kind = SceneNode::Kind::text;
  node.text = text;
  return node;
}

// The keys of a dotted path and where the `=` behind it stands; nothing when there is no such path.
std::optional<std::pair<std::vector<std::string>, std::size_t>> split_path(std::string_view text) {
  std::vector<std::string> keys(1);
  char quote = '\0';
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (quote != '\0') {
      if (c == quote) {
        quote = '\0';
      } else {
        keys.back().push_back(c);
      }
    } else if (c == '"' || c == '\'') {
      quote = c;
    } else if (c == '.' || c == '=') {
      if (keys.back().empty()) return std::nullopt;
      if (c == '=') return std::pair{keys, i};
      keys.emplace_back();
    } else if (c != ' ') {
      keys.back().push_back(c);
    }
  }
  return std::nullopt;
}

SceneNode& list_entry(SceneNode& list, const std::string& key, const std::string& path, const std::string& origin) {
  std::size_t index = 0;
  const auto [end, error] = std::from_chars(key.data(), key.data() + key.size(), index);
  const std::size_t size = list.items.size();
  if (error != std::errc() || end != key.data() + key.size() || index < 1 || index > size) {
    throw InputError(origin + ": " + path + " is a list; number its entries from 1 to " + std::to_string(size) +
                     ", as in " + path + ".1");
  }
  return list.items[index - 1];
}

}  // namespace

const SceneNode* SceneNode::find(std::string_view name) const {
  const auto at = std::find(names.begin(), names.end(), name);
  return at == names.end() ? nullptr : &items[static_cast<std::size_t>(at - names.begin())];
}

SceneNode* SceneNode::find(std::string_view name) {
  return const_cast<SceneNode*>(std::as_const(*this).find(name));  // the tree itself is not const here
}

std::string_view kind_name(SceneNode::Kind kind) {
  switch (kind) {
    case SceneNode::Kind::flag:
      return "true or false";
    case SceneNode::Kind::integer:
      return "a whole number";
    case SceneNode::Kind::number:
      return "a number";
    case SceneNode::Kind::text:
      return "a text";
    case SceneNode::Kind::list:
      return "a list";
    case SceneNode::Kind::table:
      return "a table";
    case SceneNode::Kind::other:
      break;
  }
  return "a date or time";
}

SceneNode parse_toml(std::string_view text, std::string_view source_name) {
  try {
    SceneNode root = convert(toml::parse(text, source_name));
    root.line = 0;  // the root is the whole file; a key missing there has no line
    return root;
  } catch (const toml::parse_error& e) {
    const toml::source_position at = e.source().begin;
    throw InputError(std::string(source_name) + ":" + std::to_string(at.line) + ":" + std::to_string(at.column) + ": " +
                     std::string(e.description()));
  }
}

void apply_override(SceneNode& root, std::string_view assignment) {
  const std::string origin = std::string("--set ").append(assignment);
  const auto split = split_path(assignment);
  if (!split) throw InputError(origin + ": not understood; write --set path.to.key=value");
  const std::vector<std::string>& keys = split->first;
  const std::string value(assignment.substr(split->second + 1));
  SceneNode *node = &root, *parent = nullptr;
  std::string path;
  for (const std::string& key : keys) {
    SceneNode* next = nullptr;
    if (node->kind == SceneNode::Kind::list) {
      next = &list_entry(*node, key, path, origin);
      path.append(".").append(key);
    } else if (node->kind == SceneNode::Kind::table) {
      next = node->find(key);
      if (!next && value.empty()) return;
      if (!next) {
        node->names.push_back(key);
        next = &node->items.emplace_back();
        next->origin = origin;
      }
      path = join_path(path, key);
    } else {
      throw InputError(origin + ": " + path + " is " + std::string(kind_name(node->kind)) + ", not a table");
    }
    parent = node;
    node = next;
  }
  if (value.empty() && parent->kind == SceneNode::Kind::table) {
    const auto index = node - parent->items.data();
    parent->names.erase(parent->names.begin() + index);
    parent->items.erase(parent->items.begin() + index);
    return;
  }
  *node = parse_value(value);
  set_origin(*node, origin);
}

std::string join_path(std::string_view parent, std::string_view key) {
  const bool bare = !key.empty() && std::all_of(key.begin(), key.end(), [](unsigned char c) {
    return c < 0x80 && (std::isalnum(c) || c == '_' || c == '-');
  });
  std::string path(parent);
  if (!path.empty()) path.push_back('.');
  return bare ? path.append(key) : path.append(toml_text(key));
}

std::string toml_text(std::string_view text) {
  static constexpr std::string_view kHex = "0123456789ABCDEF";
  std::string quoted(1, '"');
  for (const char c : text) {
    const auto code = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\') {
      quoted.append({'\\', c});
    } else if (code < 0x20 || code == 0x7F) {
      quoted.append("\\u00").append({kHex[code / 16], kHex[code % 16]});
    } else {
      quoted.push_back(c);
    }
  }
  quoted.push_back('"');
  return quoted;
}

}  // namespace densify
