#include "base/check.h"

namespace densify::detail {

void broken_contract(const char* condition, const char* file, int line) {
  throw std::logic_error(std::string("broken contract: ") + condition + " at " + file + ":" + std::to_string(line) +
                         " (a bug in Densify, please report it)");
}

}  // namespace densify::detail
