#include "app/draw.h"

#include <fmt/core.h>

#include <cstdlib>

#include "base/data_path.h"

namespace densify::app {

bool draw(const std::string& script, const std::vector<std::filesystem::path>& arguments) {
  std::string call = fmt::format("'{}'", data_path("tools/" + script).string());
  for (const auto& a : arguments) call += fmt::format(" '{}'", a.string());
  for (const char* python : {"python3", "/usr/bin/python3"})  // the second is the one that Debian's packages serve
    if (std::system(fmt::format("{} {} 2>/dev/null", python, call).c_str()) == 0) return true;
  fmt::print("\nno plot (it needs python3-matplotlib); later: python3 {}\n", call);
  return false;
}

}  // namespace densify::app
