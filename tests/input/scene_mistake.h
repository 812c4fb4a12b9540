#pragma once
// A scene without mistakes, and the message of the same scene with one.

#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "base/check.h"
#include "dem/io/scene.h"

namespace densify::test {

/// What read_scene_text has against a scene; "accepted" if nothing.
inline std::string message_of(std::string_view scene, const std::vector<std::string>& overrides = {}) {
  try {
    dem::read_scene_text(scene, overrides);
  } catch (const InputError& e) {
    return e.what();
  }
  return "accepted";
}

// The leading digits of the lines that tests expect in messages are those of this text.
inline constexpr std::string_view kGood = R"toml([materials.NiAl]
library = "NiAl"
[[powder]]
material = "NiAl"
number = 100
sizes = "lognormal"
mean = "3.97 um"
standard_deviation = "2.50 um"
minimum = "1.50 um"
maximum = "18.61 um"
[specimen]
shape = "cylinder"
diameter = "58 um"
[specimen.packing]
green_density = 0.6
[walls]
thermal_expansion = "11.5e-6 1/K"
[walls.punch]
damping_ratio = 0.3
[contact]
elasticity = "hertz"
[contact.friction]
coefficient = 0.2
[contact.sintering]
model = "viscoelastic"
[process]
start_temperature = "20 degC"
[[process.stage]]
name = "loading"
duration = "33 min"
pressure = "30 MPa"
[[process.stage]]
name = "heating"
rate = "15 K/min"
temperature = "1400 degC"
[integration]
mass_scaling = 1e17
)toml";

/// kGood with its only `from` replaced, so that lines keep their numbers as long as `to` has as many as `from`.
inline std::string changed(std::string_view from, std::string_view to) {
  std::string text(kGood);
  const std::size_t at = text.find(from);
  if (at == text.npos || text.find(from, at + 1) != text.npos) throw std::logic_error("not once in the scene");
  return text.replace(at, from.size(), to);
}

inline std::string mistake(std::string_view from, std::string_view to) {
  return message_of(changed(from, to));
}

/// kGood with more at its end, from line 38 on.
inline std::string mistake_added(std::string_view more) {
  return message_of(std::string(kGood).append(more));
}

}  // namespace densify::test
