#include "base/dimension.h"

#include <array>
#include <string_view>
#include <utility>

namespace densify {
namespace {

struct Named {
  Dimension dimension;
  std::string_view name;
  std::string_view unit;
  std::string_view example;
};

constexpr std::array<Named, 27> kNamed{{
    {dim::none, "plain number", "", "0.3"},
    {dim::length, "length", "m", "4.86 um"},
    {dim::area, "area", "m^2", "12 um^2"},
    {dim::volume, "volume", "m^3", "1.3e-29 m^3"},
    {dim::mass, "mass", "kg", "2.5 g"},
    {dim::time, "time", "s", "33 min"},
    {dim::temperature, "temperature", "K", "1400 degC"},
    {dim::temperature_difference, "temperature difference", "K", "50 K"},
    {dim::temperature_rate, "temperature rate", "K/s", "15 K/min"},
    {dim::angle, "angle", "rad", "147 deg"},
    {dim::angular_velocity, "angular velocity", "rad/s", "2 rad/s"},
    {dim::velocity, "velocity", "m/s", "0.1 mm/s"},
    {dim::acceleration, "acceleration", "m/s^2", "9.81 m/s^2"},
    {dim::force, "force", "N", "10 mN"},
    {dim::pressure, "pressure", "Pa", "30 MPa"},
    {dim::energy, "energy", "J", "2 mJ"},
    {dim::density, "density", "kg/m^3", "5910 kg/m^3"},
    {dim::stiffness, "stiffness", "N/m", "7e5 N/m"},
    {dim::surface_energy, "surface energy", "J/m^2", "1.72 J/m^2"},
    {dim::viscosity_contact, "contact viscosity", "N s/m", "1e12 N s/m"},
    {dim::viscosity, "viscosity", "Pa s", "1e9 Pa s"},
    {dim::diffusivity, "diffusivity", "m^2/s", "2.55e-5 m^2/s"},
    {dim::volume_rate, "volume per time", "m^3/s", "3.832e-19 m^3/s"},
    {dim::molar_energy, "molar energy", "J/mol", "185 kJ/mol"},
    {dim::rate, "rate", "1/s", "-0.005 1/s"},
    {dim::frequency, "frequency", "Hz", "50 Hz"},
    {dim::thermal_expansion, "thermal expansion", "1/K", "11.5e-6 1/K"},
}};

const Named* find_named(const Dimension& dimension) {
  for (const Named& named : kNamed) {
    if (named.dimension == dimension) return &named;
  }
  return nullptr;
}

std::string unit_from_powers(const Dimension& d) {
  const std::pair<int, const char*> powers[] = {{d.mass, "kg"},       {d.length, "m"},   {d.time, "s"},
                                                {d.temperature, "K"}, {d.amount, "mol"}, {d.angle, "rad"}};
  const auto append = [](std::string& text, std::string_view joint, std::string_view symbol, int power) {
    text.append(joint).append(symbol);
    if (power != 1) text.append("^").append(std::to_string(power));
  };
  std::string above;
  std::string below;
  for (const auto& [power, symbol] : powers) {
    if (power > 0) append(above, above.empty() ? "" : " ", symbol, power);
    if (power < 0) append(below, "/", symbol, -power);
  }
  if (above.empty() && !below.empty()) above.push_back('1');
  return above + below;
}

}  // namespace

std::string dimension_name(const Dimension& dimension) {
  const Named* named = find_named(dimension);
  return named ? std::string(named->name) : "quantity in " + unit_from_powers(dimension);
}

std::string dimension_with_article(const Dimension& dimension) {
  const std::string name = dimension_name(dimension);
  const bool vowel = std::string_view("aeio").find(name.front()) != std::string_view::npos;
  return (vowel ? "an " : "a ") + name;
}

std::string dimension_names(const Dimension& dimension) {
  std::string names;
  for (const Named& named : kNamed) {
    if (same_powers(named.dimension, dimension)) names += (names.empty() ? "" : " or ") + std::string(named.name);
  }
  return names.empty() ? dimension_name(dimension) : names;
}

std::string si_unit(const Dimension& dimension) {
  const Named* named = find_named(dimension);
  return named ? std::string(named->unit) : unit_from_powers(dimension);
}

std::string dimension_example(const Dimension& dimension) {
  const Named* named = find_named(dimension);
  if (named && dimension == dim::none) return std::string(named->example);
  std::string example(1, '"');
  if (named) {
    example.append(named->example);
  } else {
    example.append("1 ").append(unit_from_powers(dimension));
  }
  example.push_back('"');
  return example;
}

}  // namespace densify
