#pragma once
// One table of a scene: each call declares one key, and that one declaration validates the input, prints the help and
// writes the effective input.

#include <algorithm>
#include <array>
#include <concepts>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <initializer_list>
#include <limits>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/check.h"
#include "base/dimension.h"
#include "base/piecewise_linear.h"
#include "base/range.h"
#include "base/section_record.h"

namespace densify {

/// What an absent key means.  `defaulted` is for sections: visited as if it stood there empty, so that its defaults
/// reach the effective input; for every other key it is `optional`.
enum class Need { optional, required, defaulted };

/// A table lacks a key that it needs.  What stands there instead may be its misspelling.
class MissingKey : public InputError {
 public:
  /// `wanted`: keys of which one would do.
  MissingKey(const std::string& message, std::vector<std::string> wanted, const SceneNode& table);

  /// "; \"coeficient\" in line 21 is no key: did you mean \"coefficient\"?" for the key of the table that is nearest
  /// to a wanted one and not among the known ones; nothing when none is near.
  std::string misspelling(const std::vector<std::string>& known) const;

 private:
  std::vector<std::string> wanted_;
  std::vector<std::pair<std::string, int>> given_;  // keys of the table with their lines
};

/// A handle on one table, valid as long as its SceneDocument.  Every reader keeps the value it is given when the key is
/// absent and optional (NaN, an empty text or list: not set), and throws InputError "file:line: path.to.key: problem"
/// for a value of the wrong kind, dimension or range.  Quantities are texts with units, plain numbers only where the
/// dimension is none.
class Section {
 public:
  void quantity(std::string_view key, double& value, Dimension dimension, const Range& range, Need need,
                std::string_view meaning);

  template <std::integral T>
  void integer(std::string_view key, T& value, std::int64_t low, std::int64_t high, Need need,
               std::string_view meaning) {
    if (std::cmp_less(low, std::numeric_limits<T>::min())) low = std::numeric_limits<T>::min();
    if (std::cmp_greater(high, std::numeric_limits<T>::max())) high = std::numeric_limits<T>::max();
    auto wide = static_cast<std::int64_t>(value);
    whole_number(key, wide, low, high, need, meaning);
    value = static_cast<T>(wide);
  }

  void flag(std::string_view key, bool& value, std::string_view meaning);

  void text(std::string_view key, std::string& value, Need need, std::string_view meaning);

  /// One of named options.
  template <class E>
  void choice(std::string_view key, E& value, std::initializer_list<std::pair<std::string_view, E>> options, Need need,
              std::string_view meaning) {
    std::vector<std::string> names;
    std::size_t picked = options.size();
    for (const auto& [name, option] : options) {
      if (option == value && picked == options.size()) picked = names.size();
      names.emplace_back(name);
    }
    picked = choose(key, names, picked, need, meaning);
    if (picked < options.size()) value = (options.begin() + picked)->second;
  }

  /// A quantity, or the name of one.
  void named_quantity(std::string_view key, double& value, std::initializer_list<std::pair<std::string_view, double>>,
                      Dimension dimension, const Range& range, Need need, std::string_view meaning);

  void vector3(std::string_view key, std::array<double, 3>& value, Dimension dimension, Need need,
               std::string_view meaning);

  void quantity_list(std::string_view key, std::vector<double>& value, Dimension dimension, const Range& range,
                     Need need, std::string_view meaning);

  void text_list(std::string_view key, std::vector<std::string>& value, Need need, std::string_view meaning);

  /// One quantity ("183 GPa") or pairs ([["298 K", "188 GPa"], ["1673 K", "150 GPa"]]); `range` bounds the second
  /// column.
  void table(std::string_view key, PiecewiseLinear& value, Dimension x_dimension, Dimension y_dimension,
             const Range& range, Need need, std::string_view meaning);

  /// [key]; returns whether it is present.  A document for help always visits.
  bool section(std::string_view key, Need need, std::string_view meaning, const std::function<void(Section&)>& visitor);

  /// [[key]]; the visitor's index counts from 0, paths count from 1; returns how many.  A document for help visits
  /// once.
  std::size_t list(std::string_view key, Need need, std::string_view meaning,
                   const std::function<void(Section&, std::size_t index)>& visitor);

  /// [key.NAME]; returns how many.  A document for help visits once, with the name "<name>".
  std::size_t named_list(std::string_view key, Need need, std::string_view meaning,
                         const std::function<void(Section&, std::string name)>& visitor);

  /// Whether the scene gives this key.
  bool has(std::string_view key) const;

  /// Throws InputError "file:line: path.to.key: message"; an empty key stands for the table itself.
  [[noreturn]] void fail(std::string_view key, std::string_view message) const;

  /// Throws MissingKey "file:line: path: message" at the table, which lacks one of `keys`.
  [[noreturn]] void fail_missing(std::initializer_list<std::string_view> keys, std::string_view message) const;

  /// "file:line: path.to.key", or "--set path.to.key=value" for an override; the line of the table for an absent key.
  std::string where(std::string_view key) const;

  /// The folder of the scene file, to which relative paths refer.
  std::filesystem::path directory() const;

  /// Whether this visit only records declarations: values are then defaults that need not fit together.
  bool documenting() const;

 private:
  friend class SceneDocument;
  Section(SceneState& state, SectionRecord& record) : state_(&state), record_(&record) {}

  void whole_number(std::string_view key, std::int64_t& value, std::int64_t low, std::int64_t high, Need need,
                    std::string_view meaning);
  std::size_t choose(std::string_view key, const std::vector<std::string>& names, std::size_t current, Need need,
                     std::string_view meaning);

  SectionEntry& declare(std::string_view key, SectionEntry::Kind kind, std::string type, std::string range, Need need,
                        std::string fallback, std::string_view meaning);
  const SceneNode* present(std::string_view key, Need need, std::string_view example, std::string_view meaning) const;
  const SceneNode* list_of(std::string_view key, Need need, const std::string& example, std::string_view meaning) const;
  double read_quantity(std::string_view key, const SceneNode& node, Dimension dimension, const Range& range) const;
  void visit(SectionEntry& entry, std::size_t index, std::string path, const SceneNode* table,
             const std::function<void(Section&)>& visitor);
  [[noreturn]] void fail_at(const SceneNode& node, std::string_view key, std::string_view message) const;

  SceneState* state_;
  SectionRecord* record_;
};

}  // namespace densify
