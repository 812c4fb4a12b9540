#include <algorithm>
#include <cstdlib>

#include "base/check.h"
#include "base/nearest.h"
#include "dem/contact/kernel.h"

namespace densify::dem {

namespace baseline {
KernelTable table();
}
#ifdef DENSIFY_X86_KERNELS
namespace avx2 {
KernelTable table();
}
namespace avx512 {
KernelTable table();
}
#endif

const std::vector<KernelTable>& available_kernels() {
  static const std::vector<KernelTable> tables = [] {
    std::vector<KernelTable> t{baseline::table()};
#ifdef DENSIFY_X86_KERNELS
    if (__builtin_cpu_supports("avx2")) t.push_back(avx2::table());
    if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl"))
      t.push_back(avx512::table());
#endif
    return t;
  }();
  return tables;
}

const KernelTable& chosen_kernels() {
  const auto& tables = available_kernels();
  const char* const wanted = std::getenv("DENSIFY_INSTRUCTIONS");
  if (!wanted || !*wanted) return tables.back();
  const auto found =
      std::find_if(tables.begin(), tables.end(), [&](const auto& t) { return t.name == std::string(wanted); });
  if (found != tables.end()) return *found;
  std::string names;
  for (const auto& t : tables) names += (names.empty() ? "" : ", ") + std::string(t.name);
  throw InputError("DENSIFY_INSTRUCTIONS=" + std::string(wanted) +
                   ": this program and processor have no such instruction set; they have " + names +
                   " (without the variable the last is used)");
}

}  // namespace densify::dem
