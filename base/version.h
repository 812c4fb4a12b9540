#pragma once
// Which Densify this is: printed by `densify --version` and written into every result.

#include <string_view>

namespace densify {

/// Release number, "major.minor.patch".
std::string_view version();

/// Commit the binary was built from, as `git describe` names it ("-dirty" when the sources differed from that commit);
/// "unknown" when it was not built from a git checkout.
std::string_view git_revision();

}  // namespace densify
