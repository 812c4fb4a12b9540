#include "base/section.h"

#include <algorithm>
#include <cctype>
#include <cmath>

#include "base/check.h"
#include "base/nearest.h"
#include "base/quantity.h"
#include "base/section_text.h"

namespace densify {

MissingKey::MissingKey(const std::string& message, std::vector<std::string> wanted, const SceneNode& table)
    : InputError(message), wanted_(std::move(wanted)) {
  for (std::size_t i = 0; i < table.names.size(); ++i) given_.emplace_back(table.names[i], table.items[i].line);
}

std::string MissingKey::misspelling(const std::vector<std::string>& known) const {
  for (const auto& [name, line] : given_) {
    if (std::find(known.begin(), known.end(), name) != known.end()) continue;
    const std::string advice = did_you_mean(name, wanted_);
    if (advice.empty()) continue;
    const std::string place = line > 0 ? " in line " + std::to_string(line) : "";
    return "; " + toml_text(name) + place + " is no key: " + advice.substr(2);
  }
  return "";
}

void Section::quantity(std::string_view key, double& value, Dimension dimension, const Range& range, Need need,
                       std::string_view meaning) {
  const std::string current = std::isnan(value) ? "" : format_quantity(value, dimension);
  SectionEntry& entry =
      declare(key, SectionEntry::Kind::value, type_text(dimension), range.text(dimension), need, current, meaning);
  if (const SceneNode* node = present(key, need, dimension_example(dimension), meaning)) {
    value = read_quantity(key, *node, dimension, range);
  }
  entry.value = toml_quantity(value, dimension);
}

void Section::whole_number(std::string_view key, std::int64_t& value, std::int64_t low, std::int64_t high, Need need,
                           std::string_view meaning) {
  using Limits = std::numeric_limits<std::int64_t>;
  std::string range;
  if (low != Limits::min()) range.append(">= ").append(std::to_string(low));
  if (high != Limits::max()) {
    range.append(range.empty() ? "<= " : " and <= ").append(std::to_string(high));
  }
  SectionEntry& entry =
      declare(key, SectionEntry::Kind::value, "whole number", range, need, std::to_string(value), meaning);
  if (const SceneNode* node = present(key, need, std::to_string(std::max<std::int64_t>(low, 1)), meaning)) {
    if (node->kind != SceneNode::Kind::integer) {
      fail(key, std::string("expected a whole number, found ").append(found_text(*node)));
    }
    if (node->integer < low || node->integer > high) {
      fail(key, "must be " + range + ", found " + std::to_string(node->integer));
    }
    value = node->integer;
  }
  entry.value = std::to_string(value);
}

void Section::flag(std::string_view key, bool& value, std::string_view meaning) {
  const auto spelled = [&value] { return std::string(value ? "true" : "false"); };
  SectionEntry& entry =
      declare(key, SectionEntry::Kind::value, "flag", "true, false", Need::optional, spelled(), meaning);
  if (const SceneNode* node = present(key, Need::optional, "true", meaning)) {
    if (node->kind != SceneNode::Kind::flag) {
      fail(key, std::string("expected true or false (without quotes), found ").append(found_text(*node)));
    }
    value = node->flag;
  }
  entry.value = spelled();
}

void Section::text(std::string_view key, std::string& value, Need need, std::string_view meaning) {
  const auto spelled = [&value] { return value.empty() ? std::string() : toml_text(value); };
  SectionEntry& entry = declare(key, SectionEntry::Kind::value, "text", "", need, spelled(), meaning);
  if (const SceneNode* node = present(key, need, "\"...\"", meaning)) {
    if (node->kind != SceneNode::Kind::text) {
      fail(key, std::string("expected a text in quotes, found ").append(found_text(*node)));
    }
    if (node->text.empty() && need == Need::required) fail(key, "must not be empty");
    value = node->text;
  }
  entry.value = spelled();
}

std::size_t Section::choose(std::string_view key, const std::vector<std::string>& names, std::size_t current, Need need,
                            std::string_view meaning) {
  std::string allowed;
  for (const std::string& name : names) allowed.append(allowed.empty() ? "" : ", ").append(toml_text(name));
  const auto spelled = [&] { return current < names.size() ? toml_text(names[current]) : std::string(); };
  SectionEntry& entry = declare(key, SectionEntry::Kind::value, "choice", allowed, need, spelled(), meaning);
  if (const SceneNode* node = present(key, need, names.empty() ? "" : toml_text(names.front()), meaning)) {
    if (node->kind != SceneNode::Kind::text) fail(key, "expected one of " + allowed + ", found " + found_text(*node));
    const auto at = std::find(names.begin(), names.end(), node->text);
    if (at == names.end()) {
      fail(key, toml_text(node->text) + " is not among " + allowed + did_you_mean(node->text, names));
    }
    current = static_cast<std::size_t>(at - names.begin());
  }
  entry.value = spelled();
  return current;
}

void Section::named_quantity(std::string_view key, double& value,
                             std::initializer_list<std::pair<std::string_view, double>> named, Dimension dimension,
                             const Range& range, Need need, std::string_view meaning) {
  std::string allowed = range.text(dimension);
  std::vector<std::string> names;
  for (const auto& [name, meant] : named) {
    allowed.append(", or ").append(toml_text(name)).append(" = ").append(toml_quantity(meant, dimension));
    names.emplace_back(name);
  }
  SectionEntry& entry = declare(key, SectionEntry::Kind::value, type_text(dimension), allowed, need,
                                toml_quantity(value, dimension), meaning);
  if (const SceneNode* node = present(key, need, dimension_example(dimension), meaning)) {
    const auto is_named = [&](const auto& n) { return node->kind == SceneNode::Kind::text && node->text == n.first; };
    const auto found = std::find_if(named.begin(), named.end(), is_named);
    const bool word = node->kind == SceneNode::Kind::text && !node->text.empty() &&
                      std::isalpha(static_cast<unsigned char>(node->text.front()));
    if (found != named.end())
      value = found->second;
    else if (word)
      fail(key, toml_text(node->text) + " is not among " + allowed + did_you_mean(node->text, names));
    else
      value = read_quantity(key, *node, dimension, range);
  }
  entry.value = toml_quantity(value, dimension);
}

bool Section::has(std::string_view key) const {
  return !documenting() && record_->table->find(key) != nullptr;
}

void Section::fail(std::string_view key, std::string_view message) const {
  throw InputError(where(key).append(": ").append(message));
}

void Section::fail_missing(std::initializer_list<std::string_view> keys, std::string_view message) const {
  throw MissingKey(where("").append(": ").append(message), {keys.begin(), keys.end()}, *record_->table);
}

void Section::fail_at(const SceneNode& node, std::string_view key, std::string_view message) const {
  throw InputError(place_of(*state_, node, join_path(record_->path, key)).append(": ").append(message));
}

std::string Section::where(std::string_view key) const {
  if (key.empty()) return place_of(*state_, *record_->table, record_->path);
  const SceneNode* node = record_->table->find(key);
  return place_of(*state_, node ? *node : *record_->table, join_path(record_->path, key));
}

std::filesystem::path Section::directory() const {
  return std::filesystem::path(state_->source_name).parent_path();
}

bool Section::documenting() const {
  return state_->mode == SceneState::Mode::documenting;
}

SectionEntry& Section::declare(std::string_view key, SectionEntry::Kind kind, std::string type, std::string range,
                               Need need, std::string fallback, std::string_view meaning) {
  if (need == Need::required) fallback = "required";
  // Two visitors may declare the same key: one entry, except in the help, where each meaning has its line.
  for (const auto& entry : record_->entries) {
    const bool same = entry->key == key && entry->kind == kind;
    if (same && (!documenting() || kind != SectionEntry::Kind::value || entry->meaning == meaning)) return *entry;
  }
  auto entry = std::make_unique<SectionEntry>();
  entry->key = key;
  entry->kind = kind;
  entry->type = std::move(type);
  entry->range = std::move(range);
  entry->fallback = std::move(fallback);
  entry->meaning = meaning;
  return *record_->entries.emplace_back(std::move(entry));
}

const SceneNode* Section::present(std::string_view key, Need need, std::string_view example,
                                  std::string_view meaning) const {
  if (documenting()) return nullptr;
  const SceneNode* node = record_->table->find(key);
  if (node || need != Need::required) return node;
  std::string message = "missing, and required (";
  message.append(meaning).append(")");
  if (!example.empty()) message.append("; write ").append(join_path("", key)).append(" = ").append(example);
  throw MissingKey(where(key).append(": ").append(message), {std::string(key)}, *record_->table);
}

double Section::read_quantity(std::string_view key, const SceneNode& node, Dimension dimension,
                              const Range& range) const {
  double value = 0.0;
  if (node.kind == SceneNode::Kind::text) {
    try {
      value = parse_quantity(node.text, dimension);
    } catch (const QuantityError& e) {
      fail_at(node, key, e.what());
    }
  } else if (node.kind == SceneNode::Kind::integer || node.kind == SceneNode::Kind::number) {
    if (!same_powers(dimension, dim::none)) {
      fail_at(node, key,
              "a bare number where " + dimension_with_article(dimension) + " is due; write " +
                  dimension_example(dimension));
    }
    value = node.kind == SceneNode::Kind::integer ? static_cast<double>(node.integer) : node.number;
    if (!std::isfinite(value)) fail_at(node, key, "must be a finite number");
  } else {
    fail_at(node, key,
            "expected " + dimension_with_article(dimension) + " such as " + dimension_example(dimension) + ", found " +
                found_text(node));
  }
  if (!range.contains(value)) fail_at(node, key, "must be " + range.text(dimension) + ", found " + found_text(node));
  return value;
}

}  // namespace densify
