#include "base/quantity.h"

#include <cctype>
#include <charconv>
#include <cmath>

#include "base/unit.h"

namespace densify {
namespace {

std::string_view trim(std::string_view text) {
  while (!text.empty() && std::isspace(static_cast<unsigned char>(text.front()))) text.remove_prefix(1);
  while (!text.empty() && std::isspace(static_cast<unsigned char>(text.back()))) text.remove_suffix(1);
  return text;
}

struct Number {
  std::string_view mantissa;
  int exponent = 0;
  std::string_view rest;
};

// Splits a decimal number off the front; an empty mantissa when there is none.
Number split_number(std::string_view text) {
  const auto is_digit = [&text](std::size_t i) {
    return i < text.size() && std::isdigit(static_cast<unsigned char>(text[i]));
  };
  std::size_t i = 0;
  std::size_t digits = 0;
  if (i < text.size() && (text[i] == '-' || text[i] == '+')) ++i;
  for (; is_digit(i); ++i) ++digits;
  if (i < text.size() && text[i] == '.') {
    for (++i; is_digit(i); ++i) ++digits;
  }
  if (digits == 0) return {{}, 0, text};
  Number number{text.substr(0, i), 0, text.substr(i)};
  if (i < text.size() && (text[i] == 'e' || text[i] == 'E')) {
    const std::size_t sign = i + 1;
    const std::size_t first = sign < text.size() && (text[sign] == '+' || text[sign] == '-') ? sign + 1 : sign;
    if (is_digit(first)) {
      std::size_t last = first;
      while (is_digit(last)) ++last;
      const std::size_t from = text[sign] == '+' ? first : sign;
      const auto [end, error] = std::from_chars(text.data() + from, text.data() + last, number.exponent);
      if (error != std::errc() || std::abs(number.exponent) > 100000) return {{}, 0, text};
      number.rest = text.substr(last);
    }
  }
  if (number.mantissa.front() == '+') number.mantissa.remove_prefix(1);
  return number;
}

double parse_decimal(std::string_view mantissa, int exponent) {
  const std::string text = std::string(mantissa) + "e" + std::to_string(exponent);
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) {
    throw QuantityError("the number does not fit in double precision; write one between 1e-300 and 1e300");
  }
  return value;
}

double parse_plain(std::string_view text, Dimension expected) {
  const Number number = split_number(text);
  if (number.mantissa.empty()) {
    throw QuantityError("no number found; write " + dimension_with_article(expected) + " such as " +
                        dimension_example(expected));
  }
  const std::string_view unit_text = trim(number.rest);
  if (unit_text.empty()) {
    if (!same_powers(expected, dim::none)) {
      throw QuantityError("unit missing; " + dimension_with_article(expected) + " is due, such as " +
                          dimension_example(expected));
    }
    return parse_decimal(number.mantissa, number.exponent);
  }
  const Unit unit = parse_unit(unit_text);
  if (!same_powers(unit.dimension, expected)) {
    throw QuantityError("expected " + dimension_name(expected) + " such as " + dimension_example(expected) + ", got " +
                        dimension_names(unit.dimension));
  }
  const double scaled = parse_decimal(number.mantissa, number.exponent + unit.decimal_exponent);
  if (unit_text == "degC") {
    if (expected == dim::temperature_difference) {
      throw QuantityError("a temperature difference is due, and degC counts from 0 degC; write it in K");
    }
    return scaled + 273.15;
  }
  const double value = scaled * unit.multiplier / unit.divisor;
  if (!std::isfinite(value)) throw QuantityError("the number does not fit in double precision");
  return value;
}

}  // namespace

double parse_quantity(std::string_view text, Dimension expected) {
  try {
    return parse_plain(trim(plain_spelling(text)), expected);
  } catch (const QuantityError& e) {
    throw QuantityError("\"" + std::string(text) + "\": " + e.what());
  }
}

std::string format_quantity(double si, Dimension dimension) {
  DENSIFY_EXPECT(std::isfinite(si));
  char buffer[32];
  const double size = std::abs(si);
  const bool plain = size == 0.0 || (size >= 1e-4 && size < 1e7);
  const auto format = plain ? std::chars_format::fixed : std::chars_format::scientific;
  const auto [end, error] = std::to_chars(buffer, buffer + sizeof buffer, si, format);
  DENSIFY_EXPECT(error == std::errc());
  std::string text(buffer, end);
  const std::string unit = si_unit(dimension);
  if (!unit.empty()) text.append(" ").append(unit);
  return text;
}

}  // namespace densify
