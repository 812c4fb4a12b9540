#include "base/version.h"

#include "base/build_info.h"

namespace densify {

std::string_view version() {
  return DENSIFY_VERSION;
}

std::string_view git_revision() {
  return DENSIFY_REVISION;
}

}  // namespace densify
