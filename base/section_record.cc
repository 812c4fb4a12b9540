#include "base/section_record.h"

#include <algorithm>
#include <array>

#include "base/check.h"
#include "base/nearest.h"

namespace densify {
namespace {

using Row = std::array<std::string, 5>;

void collect_rows(const SectionRecord& record, std::vector<Row>& rows) {
  for (const auto& entry : record.entries) {
    rows.push_back({join_path(record.path, entry->key), entry->type, entry->range, entry->fallback, entry->meaning});
    for (const auto& child : entry->children) collect_rows(*child, rows);
  }
}

void render_table(const SectionRecord& record, const std::string& header, std::string& out) {
  for (const auto& entry : record.entries) {
    if (entry->kind != SectionEntry::Kind::value || entry->value.empty()) continue;
    out.append(join_path("", entry->key)).append(" = ").append(entry->value).append("\n");
  }
  for (const auto& entry : record.entries) {
    for (std::size_t i = 0; i < entry->children.size(); ++i) {
      std::string path = join_path(header, entry->key);
      if (entry->kind == SectionEntry::Kind::named_list) path = join_path(path, entry->names[i]);
      const bool list = entry->kind == SectionEntry::Kind::list;
      out.append(out.empty() ? "" : "\n").append(list ? "[[" : "[").append(path).append(list ? "]]\n" : "]\n");
      render_table(*entry->children[i], path, out);
    }
  }
}

struct Unknown {
  const SceneNode* node = nullptr;
  const SectionRecord* record = nullptr;
  std::string key;
};

// The unknown key that stands first in the file; what overrides brought counts as before the file.
void find_unknown(const SectionRecord& record, Unknown& first) {
  for (std::size_t i = 0; record.table && i < record.table->names.size(); ++i) {
    const std::string& name = record.table->names[i];
    const auto is_declared = [&name](const auto& entry) { return entry->key == name; };
    if (std::any_of(record.entries.begin(), record.entries.end(), is_declared)) continue;
    const SceneNode& node = record.table->items[i];
    if (!first.node || node.line < first.node->line) first = {&node, &record, name};
  }
  for (const auto& entry : record.entries) {
    for (const auto& child : entry->children) find_unknown(*child, first);
  }
}

}  // namespace

std::string place_of(const SceneState& state, const SceneNode& node, std::string_view path) {
  std::string place;
  if (!node.origin.empty()) {
    if (node.origin.starts_with(std::string("--set ").append(path).append("="))) return node.origin;
    place = node.origin;
  } else {
    place = state.source_name;
    if (node.line > 0) place.append(":").append(std::to_string(node.line));
  }
  if (!path.empty()) place.append(": ").append(path);
  return place;
}

std::string render_help(const SectionRecord& root) {
  std::vector<Row> rows{{"key", "kind", "range", "default", "meaning"}};
  collect_rows(root, rows);
  for (Row& row : rows) {
    for (std::string& cell : row) {
      if (cell.empty()) cell.push_back('-');
    }
  }
  std::array<std::size_t, 4> widths{};
  for (const Row& row : rows) {
    for (std::size_t c = 0; c < widths.size(); ++c) widths[c] = std::max(widths[c], row[c].size());
  }
  std::string out;
  for (const Row& row : rows) {
    for (std::size_t c = 0; c < widths.size(); ++c) out.append(row[c]).append(widths[c] - row[c].size() + 2, ' ');
    out.append(row.back()).append("\n");
  }
  return out;
}

std::string render_effective(const SectionRecord& root) {
  std::string out;
  render_table(root, "", out);
  return out;
}

std::vector<std::string> declared_keys(const SectionRecord& root) {
  std::vector<std::string> keys;
  for (const auto& entry : root.entries) {
    keys.push_back(entry->key);
    for (const auto& child : entry->children) {
      const std::vector<std::string> below = declared_keys(*child);
      keys.insert(keys.end(), below.begin(), below.end());
    }
  }
  return keys;
}

void reject_unknown_keys(const SceneState& state) {
  Unknown unknown;
  find_unknown(state.record, unknown);
  if (!unknown.node) return;
  std::vector<std::string> known;
  std::string all;
  for (const auto& entry : unknown.record->entries) {
    if (std::find(known.begin(), known.end(), entry->key) != known.end()) continue;
    known.push_back(entry->key);
    all.append(all.empty() ? "" : ", ").append(entry->key);
  }
  std::string advice = did_you_mean(unknown.key, known);
  if (advice.empty()) advice.append("; known here: ").append(all.empty() ? "none" : all);
  throw InputError(place_of(state, *unknown.node, join_path(unknown.record->path, unknown.key)) + ": unknown key" +
                   advice);
}

}  // namespace densify
