#pragma once
// What a number measures: powers of the base units, and the words and spellings that go with them.

#include <cstdint>
#include <string>

namespace densify {

/// Powers of the SI base units.  `sense` tells quantities of equal powers apart (stiffness and surface energy); it
/// guides words and spelling only, except that a temperature difference refuses a unit with an offset.
struct Dimension {
  std::int8_t length = 0;
  std::int8_t mass = 0;
  std::int8_t time = 0;
  std::int8_t temperature = 0;
  std::int8_t amount = 0;
  std::int8_t angle = 0;
  std::int8_t sense = 0;

  friend constexpr bool operator==(const Dimension&, const Dimension&) = default;
};

/// Whether two dimensions have the same powers, whatever their sense.
constexpr bool same_powers(Dimension a, Dimension b) {
  a.sense = b.sense;
  return a == b;
}

/// a * b^power.
constexpr Dimension times_power(const Dimension& a, const Dimension& b, int power) {
  const auto sum = [power](int x, int y) { return static_cast<std::int8_t>(x + power * y); };
  return {sum(a.length, b.length),           sum(a.mass, b.mass),     sum(a.time, b.time),
          sum(a.temperature, b.temperature), sum(a.amount, b.amount), sum(a.angle, b.angle)};
}

namespace dim {
//                                                length, mass, time, temperature, amount, angle, sense
inline constexpr Dimension none{};
inline constexpr Dimension length{1};
inline constexpr Dimension area{2};
inline constexpr Dimension volume{3};
inline constexpr Dimension mass{0, 1};
inline constexpr Dimension time{0, 0, 1};
inline constexpr Dimension temperature{0, 0, 0, 1};
inline constexpr Dimension temperature_difference{0, 0, 0, 1, 0, 0, 1};
inline constexpr Dimension temperature_rate{0, 0, -1, 1};
inline constexpr Dimension angle{0, 0, 0, 0, 0, 1};
inline constexpr Dimension angular_velocity{0, 0, -1, 0, 0, 1};
inline constexpr Dimension velocity{1, 0, -1};
inline constexpr Dimension acceleration{1, 0, -2};
inline constexpr Dimension force{1, 1, -2};
inline constexpr Dimension pressure{-1, 1, -2};
inline constexpr Dimension energy{2, 1, -2};
inline constexpr Dimension density{-3, 1};
inline constexpr Dimension stiffness{0, 1, -2};
inline constexpr Dimension surface_energy{0, 1, -2, 0, 0, 0, 1};
inline constexpr Dimension viscosity_contact{0, 1, -1};
inline constexpr Dimension viscosity{-1, 1, -1};
inline constexpr Dimension diffusivity{2, 0, -1};
inline constexpr Dimension volume_rate{3, 0, -1};
inline constexpr Dimension molar_energy{2, 1, -2, 0, -1};
inline constexpr Dimension rate{0, 0, -1};
inline constexpr Dimension frequency{0, 0, -1, 0, 0, 0, 1};
inline constexpr Dimension thermal_expansion{0, 0, 0, -1};
}  // namespace dim

/// The quantity in words ("pressure"), or its unit where it has no name.
std::string dimension_name(const Dimension& dimension);

/// The same with its article ("a pressure", "an angle").
std::string dimension_with_article(const Dimension& dimension);

/// Every name the powers may have ("stiffness or surface energy").
std::string dimension_names(const Dimension& dimension);

/// The coherent SI unit ("Pa", "kg/m^3", "" for a plain number).
std::string si_unit(const Dimension& dimension);

/// A value as a user would write it, in quotes where TOML wants a string ("\"30 MPa\"", "0.3").
std::string dimension_example(const Dimension& dimension);

}  // namespace densify
