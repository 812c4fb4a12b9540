// The keys of a section that hold more than one value: lists, tables of pairs, and tables below.

#include <cmath>

#include "base/check.h"
#include "base/quantity.h"
#include "base/section.h"
#include "base/section_text.h"

namespace densify {
namespace {

const SceneNode kNoTable;

// "[a, b]" from the entries, nothing from none.
template <class Values, class Spell>
std::string toml_list(const Values& values, Spell spell) {
  std::string list;
  for (const auto& value : values) {
    list.append(list.empty() ? "[" : ", ").append(spell(value));
  }
  if (!list.empty()) list.push_back(']');
  return list;
}

std::string toml_table(const PiecewiseLinear& table, Dimension x_dimension, Dimension y_dimension) {
  if (table.is_constant()) return toml_quantity(table.knots().front().y, y_dimension);
  return toml_list(table.knots(), [&](const PiecewiseLinear::Knot& knot) {
    return std::string("[")
        .append(toml_quantity(knot.x, x_dimension))
        .append(", ")
        .append(toml_quantity(knot.y, y_dimension))
        .append("]");
  });
}

}  // namespace

const SceneNode* Section::list_of(std::string_view key, Need need, const std::string& example,
                                  std::string_view meaning) const {
  const std::string spelled = std::string("[").append(example).append(", ...]");
  const SceneNode* node = present(key, need, spelled, meaning);
  if (!node) return nullptr;
  if (node->kind != SceneNode::Kind::list)
    fail(key, "expected a list such as " + spelled + ", found " + found_text(*node));
  if (node->items.empty() && need == Need::required) fail(key, "the list is empty; give at least one entry");
  return node;
}

void Section::vector3(std::string_view key, std::array<double, 3>& value, Dimension dimension, Need need,
                      std::string_view meaning) {
  const auto spelled = [&] {
    const bool set = std::none_of(value.begin(), value.end(), [](double x) { return std::isnan(x); });
    return set ? toml_list(value, [&](double x) { return toml_quantity(x, dimension); }) : std::string();
  };
  SectionEntry& entry =
      declare(key, SectionEntry::Kind::value, "three of " + type_text(dimension), "", need, spelled(), meaning);
  if (const SceneNode* node = list_of(key, need, dimension_example(dimension), meaning)) {
    if (node->items.size() != 3) fail(key, "expected three components, found " + std::to_string(node->items.size()));
    for (std::size_t i = 0; i < 3; ++i) value[i] = read_quantity(key, node->items[i], dimension, Range::any());
  }
  entry.value = spelled();
}

void Section::quantity_list(std::string_view key, std::vector<double>& value, Dimension dimension, const Range& range,
                            Need need, std::string_view meaning) {
  const auto spelled = [&] { return toml_list(value, [&](double x) { return toml_quantity(x, dimension); }); };
  SectionEntry& entry = declare(key, SectionEntry::Kind::value, "list of " + type_text(dimension),
                                range.text(dimension), need, spelled(), meaning);
  if (const SceneNode* node = list_of(key, need, dimension_example(dimension), meaning)) {
    value.clear();
    for (const SceneNode& item : node->items) value.push_back(read_quantity(key, item, dimension, range));
  }
  entry.value = spelled();
}

void Section::text_list(std::string_view key, std::vector<std::string>& value, Need need, std::string_view meaning) {
  const auto spelled = [&] { return toml_list(value, [](const std::string& text) { return toml_text(text); }); };
  SectionEntry& entry = declare(key, SectionEntry::Kind::value, "list of texts", "", need, spelled(), meaning);
  if (const SceneNode* node = list_of(key, need, "\"...\"", meaning)) {
    value.clear();
    for (const SceneNode& item : node->items) {
      if (item.kind != SceneNode::Kind::text)
        fail_at(item, key, "expected a text in quotes, found " + found_text(item));
      value.push_back(item.text);
    }
  }
  entry.value = spelled();
}

void Section::table(std::string_view key, PiecewiseLinear& value, Dimension x_dimension, Dimension y_dimension,
                    const Range& range, Need need, std::string_view meaning) {
  SectionEntry& entry =
      declare(key, SectionEntry::Kind::value, type_text(y_dimension) + " or table over " + dimension_name(x_dimension),
              range.text(y_dimension), need, toml_table(value, x_dimension, y_dimension), meaning);
  const SceneNode* node = present(key, need, dimension_example(y_dimension), meaning);
  if (node && node->kind == SceneNode::Kind::list) {
    std::string pair(1, '[');
    pair.append(dimension_example(x_dimension)).append(", ").append(dimension_example(y_dimension)).append("]");
    std::vector<PiecewiseLinear::Knot> knots;
    for (const SceneNode& item : node->items) {
      if (item.kind != SceneNode::Kind::list || item.items.size() != 2)
        fail_at(item, key, "expected pairs such as " + pair);
      knots.push_back({read_quantity(key, item.items[0], x_dimension, Range::any()),
                       read_quantity(key, item.items[1], y_dimension, range)});
    }
    try {
      value = PiecewiseLinear(std::move(knots));
    } catch (const InputError& e) {
      fail(key, e.what());
    }
  } else if (node) {
    value = PiecewiseLinear(read_quantity(key, *node, y_dimension, range));
  }
  entry.value = toml_table(value, x_dimension, y_dimension);
}

void Section::visit(SectionEntry& entry, std::size_t index, std::string path, const SceneNode* table,
                    const std::function<void(Section&)>& visitor) {
  if (index == entry.children.size()) entry.children.push_back(std::make_unique<SectionRecord>());
  SectionRecord& child = *entry.children[index];
  child.path = std::move(path);
  child.table = table;
  Section below(*state_, child);
  visitor(below);
}

bool Section::section(std::string_view key, Need need, std::string_view meaning,
                      const std::function<void(Section&)>& visitor) {
  SectionEntry& entry = declare(key, SectionEntry::Kind::section, "section", "", need, "", meaning);
  const std::string path = join_path(record_->path, key);
  const SceneNode* node = present(key, need, "", meaning);
  if (node && node->kind != SceneNode::Kind::table)
    fail(key, "expected a section [" + path + "], found " + found_text(*node));
  if (node || documenting() || need == Need::defaulted) visit(entry, 0, path, node ? node : &kNoTable, visitor);
  return node != nullptr;
}

std::size_t Section::list(std::string_view key, Need need, std::string_view meaning,
                          const std::function<void(Section&, std::size_t index)>& visitor) {
  SectionEntry& entry = declare(key, SectionEntry::Kind::list, "list of sections", "", need, "", meaning);
  const std::string path = join_path(record_->path, key);
  if (documenting()) visit(entry, 0, path + ".#", &kNoTable, [&](Section& below) { visitor(below, 0); });
  const SceneNode* node = present(key, need, "", meaning);
  if (!node) return 0;
  const auto is_table = [](const SceneNode& item) { return item.kind == SceneNode::Kind::table; };
  if (node->kind != SceneNode::Kind::list || !std::all_of(node->items.begin(), node->items.end(), is_table)) {
    fail(key, "expected a list of sections, each headed [[" + path + "]]");
  }
  if (node->items.empty() && need == Need::required) fail(key, "the list is empty; give at least one [[" + path + "]]");
  for (std::size_t i = 0; i < node->items.size(); ++i) {
    visit(entry, i, path + "." + std::to_string(i + 1), &node->items[i], [&](Section& below) { visitor(below, i); });
  }
  return node->items.size();
}

std::size_t Section::named_list(std::string_view key, Need need, std::string_view meaning,
                                const std::function<void(Section&, std::string name)>& visitor) {
  SectionEntry& entry = declare(key, SectionEntry::Kind::named_list, "named sections", "", need, "", meaning);
  const std::string path = join_path(record_->path, key);
  if (documenting()) {
    entry.names = {"<name>"};
    visit(entry, 0, path + ".<name>", &kNoTable, [&](Section& below) { visitor(below, "<name>"); });
  }
  const SceneNode* node = present(key, need, "", meaning);
  if (!node) return 0;
  const std::string heading = "sections headed [" + path + ".NAME]";
  if (node->kind != SceneNode::Kind::table) fail(key, "expected " + heading + ", found " + found_text(*node));
  if (node->items.empty() && need == Need::required) fail(key, "is empty; give " + heading);
  entry.names = node->names;
  for (std::size_t i = 0; i < node->items.size(); ++i) {
    const std::string& name = node->names[i];
    const std::string below_path = join_path(path, name);
    if (node->items[i].kind != SceneNode::Kind::table) {
      throw InputError(place_of(*state_, node->items[i], below_path) + ": expected " + heading + ", found " +
                       found_text(node->items[i]));
    }
    visit(entry, i, below_path, &node->items[i], [&](Section& below) { visitor(below, name); });
  }
  return node->items.size();
}

}  // namespace densify
