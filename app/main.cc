// The command line: only what it can answer truthfully so far.

#include <cstdio>
#include <string>
#include <string_view>

#include "base/version.h"

namespace {

constexpr const char* kUsage =
    "usage: densify COMMAND\n"
    "  help        this text\n"
    "  --version   release number and git revision\n";

int main_with(std::string_view command) {
  if (command == "--version") {
    const std::string line =
        "densify " + std::string(densify::version()) + " (" + std::string(densify::git_revision()) + ")";
    std::puts(line.c_str());
    return 0;
  }
  if (command == "help" || command == "--help") {
    std::fputs(kUsage, stdout);
    return 0;
  }
  std::fprintf(stderr, "densify: %s: unknown command\n%s", std::string(command).c_str(), kUsage);
  return 2;
}

}  // namespace

int main(int argc, char** argv) {
  return main_with(argc > 1 ? argv[1] : "help");
}
