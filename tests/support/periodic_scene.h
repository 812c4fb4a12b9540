#pragma once
// The beginning of a scene in a periodic cell: whatever else it needs follows.

#include <string_view>

namespace densify::test {

inline constexpr std::string_view kPeriodicPowder = R"toml([materials.NiAl]
library = "NiAl"
[[powder]]
material = "NiAl"
number = 100
sizes = "list"
diameters = ["4 um"]
[specimen]
shape = "periodic"
)toml";

}  // namespace densify::test
