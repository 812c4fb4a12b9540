#include "app/voxel_program.h"

#include <unistd.h>

#include <charconv>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "base/check.h"

namespace densify::app {

namespace {

/// Takes "--ranks N" or "--ranks=N" out of the arguments; 1 without it.
int take_ranks(std::vector<std::string>& arguments) {
  for (std::size_t k = 0; k < arguments.size(); ++k) {
    const bool joined = arguments[k].starts_with("--ranks=");
    if (!joined && arguments[k] != "--ranks") continue;
    const std::string text = joined ? arguments[k].substr(8) : k + 1 < arguments.size() ? arguments[k + 1] : "";
    int ranks = 0;
    const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), ranks);
    if (failure != std::errc() || end != text.data() + text.size() || ranks < 1 || ranks > 4096)
      throw InputError("--ranks " + text + ": a number of processes from 1 to 4096 is due");
    arguments.erase(arguments.begin() + std::ptrdiff_t(k), arguments.begin() + std::ptrdiff_t(k + (joined ? 1 : 2)));
    return ranks;
  }
  return 1;
}

}  // namespace

void become_voxel_program(int argc, char** argv) {
  std::error_code failure;
  const std::filesystem::path here = std::filesystem::read_symlink("/proc/self/exe", failure).parent_path();
  const std::filesystem::path program = here / "densify-voxel-moduli";
  if (!std::filesystem::exists(program))
    throw InputError(
        "voxel-moduli needs deal.II and PETSc, which this build was made without: take one that is not of "
        "preset dem-only, with libdeal.ii-dev installed");
  std::vector<std::string> words(argv + 2, argv + argc);
  const int ranks = take_ranks(words);
  words.insert(words.begin(), program.string());
  if (ranks > 1) {
    setenv("OMPI_ALLOW_RUN_AS_ROOT", "1", 0);  // mpirun refuses root otherwise; containers have no other user
    setenv("OMPI_ALLOW_RUN_AS_ROOT_CONFIRM", "1", 0);
    words.insert(words.begin(), {"mpirun", "-np", std::to_string(ranks), "-q", "--bind-to", "none", "--oversubscribe"});
  }
  setenv("OPENBLAS_NUM_THREADS", "1", 0);          // a rank is one thread
  setenv("OMPI_MCA_mpi_yield_when_idle", "1", 0);  // ranks that wait leave a busy core to others
  std::vector<char*> pointers;
  for (std::string& w : words) pointers.push_back(w.data());
  pointers.push_back(nullptr);
  execvp(pointers[0], pointers.data());
  throw InputError("cannot start " + words[0] + (ranks > 1 ? "; install openmpi-bin or leave --ranks out" : ""));
}

}  // namespace densify::app
