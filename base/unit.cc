#include "base/unit.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <utility>
#include <vector>

#include "base/nearest.h"
#include "base/quantity.h"

namespace densify {
namespace {

enum class Prefixes { allowed, none };

struct Symbol {
  std::string_view name;
  Unit unit;
  Prefixes prefixes;
};

constexpr std::array<Symbol, 18> kSymbols{{
    {"m", {dim::length}, Prefixes::allowed},
    {"g", {dim::mass, -3}, Prefixes::allowed},
    {"s", {dim::time}, Prefixes::allowed},
    {"K", {dim::temperature}, Prefixes::allowed},
    {"mol", {{0, 0, 0, 0, 1}}, Prefixes::allowed},
    {"rad", {dim::angle}, Prefixes::allowed},
    {"N", {dim::force}, Prefixes::allowed},
    {"Pa", {dim::pressure}, Prefixes::allowed},
    {"J", {dim::energy}, Prefixes::allowed},
    {"W", {{2, 1, -3}}, Prefixes::allowed},
    {"Hz", {dim::rate}, Prefixes::allowed},
    {"bar", {dim::pressure, 5}, Prefixes::allowed},
    {"min", {dim::time, 0, 60.0}, Prefixes::none},
    {"h", {dim::time, 0, 3600.0}, Prefixes::none},
    {"d", {dim::time, 0, 86400.0}, Prefixes::none},
    {"deg", {dim::angle, 0, std::numbers::pi, 180.0}, Prefixes::none},
    {"degC", {dim::temperature}, Prefixes::none},
    {"%", {dim::none, -2}, Prefixes::none},
}};

constexpr std::array<std::pair<char, int>, 11> kPrefixes{{{'f', -15},
                                                          {'p', -12},
                                                          {'n', -9},
                                                          {'u', -6},
                                                          {'m', -3},
                                                          {'c', -2},
                                                          {'d', -1},
                                                          {'k', 3},
                                                          {'M', 6},
                                                          {'G', 9},
                                                          {'T', 12}}};

std::vector<std::string> known_symbols() {
  std::vector<std::string> names;
  for (const Symbol& symbol : kSymbols) {
    names.emplace_back(symbol.name);
    if (symbol.prefixes == Prefixes::none) continue;
    for (const auto& prefix : kPrefixes) names.push_back(prefix.first + std::string(symbol.name));
  }
  return names;
}

Unit find_symbol(std::string_view name) {
  for (const Symbol& symbol : kSymbols) {
    if (symbol.name == name) return symbol.unit;
  }
  for (const Symbol& symbol : kSymbols) {
    if (symbol.prefixes == Prefixes::none || name.size() != symbol.name.size() + 1 || !name.ends_with(symbol.name)) {
      continue;
    }
    for (const auto& [letter, exponent] : kPrefixes) {
      if (name.front() != letter) continue;
      Unit unit = symbol.unit;
      unit.decimal_exponent += exponent;
      return unit;
    }
  }
  const std::size_t digit = name.find_first_of("0123456789-");
  std::string advice = did_you_mean(name, known_symbols());
  if (digit != std::string_view::npos && digit > 0) {
    advice = "; powers are written with ^, as in \"" + std::string(name.substr(0, digit)) + "^" +
             std::string(name.substr(digit)) + "\"";
  }
  throw QuantityError("unknown unit \"" + std::string(name) + "\"" + advice);
}

// Recursive descent over  product := power ((' ' | '*' | '/') power)*,  power := (symbol | '1' | '(' product ')') ['^'
// n].
class UnitParser {
 public:
  explicit UnitParser(std::string_view text) : text_(text) {}

  Unit parse() {
    const Unit unit = product();
    if (position_ != text_.size()) unexpected();
    return unit;
  }

 private:
  [[noreturn]] void unexpected() const {
    throw QuantityError("the unit \"" + std::string(text_) +
                        "\" is not understood; write it as in \"N s/m\" or \"m^2/s\"");
  }

  char next() {
    while (position_ < text_.size() && text_[position_] == ' ') ++position_;
    return position_ < text_.size() ? text_[position_] : '\0';
  }

  Unit product() {
    Unit unit = power();
    while (next() != '\0' && next() != ')') {
      int sign = 1;
      if (next() == '*' || next() == '/') sign = text_[position_++] == '/' ? -1 : 1;
      multiply(unit, power(), sign);
    }
    return unit;
  }

  Unit power() {
    Unit unit;
    if (next() == '(') {
      ++position_;
      unit = product();
      if (next() != ')') unexpected();
      ++position_;
    } else {
      const std::size_t begin = position_;
      position_ = std::min(text_.find_first_of(" */^()", begin), text_.size());
      const std::string_view name = text_.substr(begin, position_ - begin);
      if (name.empty()) unexpected();
      if (name != "1") unit = find_symbol(name);
    }
    if (next() != '^') return unit;
    ++position_;
    int exponent = 0;
    const auto [end, error] = std::from_chars(text_.data() + position_, text_.data() + text_.size(), exponent);
    if (error != std::errc() || std::abs(exponent) > 9) unexpected();
    position_ = static_cast<std::size_t>(end - text_.data());
    if (position_ < text_.size() && std::string_view(" */)").find(text_[position_]) == std::string_view::npos) {
      unexpected();  // a broken power such as m^0.5
    }
    Unit raised;
    multiply(raised, unit, exponent);
    return raised;
  }

  void multiply(Unit& unit, const Unit& other, int exponent) {
    const auto too_far = [exponent](int a, int b) { return std::abs(a + exponent * b) > 100; };
    const Dimension& a = unit.dimension;
    const Dimension& b = other.dimension;
    if (too_far(a.length, b.length) || too_far(a.mass, b.mass) || too_far(a.time, b.time) ||
        too_far(a.temperature, b.temperature) || too_far(a.amount, b.amount) || too_far(a.angle, b.angle)) {
      unexpected();
    }
    unit.dimension = times_power(a, b, exponent);
    unit.decimal_exponent += exponent * other.decimal_exponent;
    unit.multiplier *= std::pow(exponent > 0 ? other.multiplier : other.divisor, std::abs(exponent));
    unit.divisor *= std::pow(exponent > 0 ? other.divisor : other.multiplier, std::abs(exponent));
  }

  std::string_view text_;
  std::size_t position_ = 0;
};

}  // namespace

std::string plain_spelling(std::string_view text) {
  static constexpr std::array<std::pair<std::string_view, std::string_view>, 6> kSpellings{{
      {"\xC2\xB5", "u"},  // micro sign
      {"\xCE\xBC", "u"},  // Greek mu
      {"\xC2\xB0"
       "C",
       "degC"},
      {"\xC2\xB2", "^2"},
      {"\xC2\xB3", "^3"},
      {"\xC2\xB7", "*"},
  }};
  std::string plain(text);
  for (const auto& [sign, spelling] : kSpellings) {
    for (std::size_t at = plain.find(sign); at != std::string::npos; at = plain.find(sign)) {
      plain.replace(at, sign.size(), spelling);
    }
  }
  return plain;
}

Unit parse_unit(std::string_view text) {
  return UnitParser(text).parse();
}

}  // namespace densify
