#include "app/fem_program.h"

#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <cstdio>
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

std::filesystem::path beside_this(const std::string& program) {
  std::error_code failure;
  return std::filesystem::read_symlink("/proc/self/exe", failure).parent_path() / program;
}

/// The whole call, with mpirun before it when there are several ranks, and what the ranks need in the environment.
std::vector<std::string> call_of(const std::string& program, std::vector<std::string> words) {
  const int ranks = take_ranks(words);
  words.insert(words.begin(), beside_this(program).string());
  if (ranks > 1) {
    setenv("OMPI_ALLOW_RUN_AS_ROOT", "1", 0);  // mpirun refuses root otherwise; containers have no other user
    setenv("OMPI_ALLOW_RUN_AS_ROOT_CONFIRM", "1", 0);
    words.insert(words.begin(), {"mpirun", "-np", std::to_string(ranks), "-q", "--bind-to", "none", "--oversubscribe"});
  }
  setenv("OPENBLAS_NUM_THREADS", "1", 0);          // a rank is one thread
  setenv("OMPI_MCA_mpi_yield_when_idle", "1", 0);  // ranks that wait leave a busy core to others
  return words;
}

std::vector<char*> pointers_to(std::vector<std::string>& words) {
  std::vector<char*> pointers;
  for (std::string& w : words) pointers.push_back(w.data());
  pointers.push_back(nullptr);
  return pointers;
}

[[noreturn]] void cannot_start(const std::string& program) {
  throw InputError("cannot start " + program +
                   (program == "mpirun" ? "; install openmpi-bin or leave --ranks out" : ""));
}

}  // namespace

void require_program(const std::string& program, const std::string& who, const std::string& otherwise) {
  if (!std::filesystem::exists(beside_this(program)))
    throw InputError(who +
                     " needs deal.II and PETSc, which this build was made without: take one that is not of preset "
                     "dem-only, with libdeal.ii-dev installed" +
                     otherwise);
}

void become_program(const std::string& program, const std::string& who, const std::vector<std::string>& arguments) {
  require_program(program, who, "");
  std::vector<std::string> words = call_of(program, arguments);
  execvp(words[0].c_str(), pointers_to(words).data());
  cannot_start(words[0]);
}

int run_program(const std::string& program, const std::vector<std::string>& arguments) {
  std::vector<std::string> words = call_of(program, arguments);
  std::fflush(stdout);
  pid_t child;
  if (posix_spawnp(&child, words[0].c_str(), nullptr, nullptr, pointers_to(words).data(), environ) != 0)
    cannot_start(words[0]);
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  constexpr int killed = 128;  // as a shell has it
  return WIFEXITED(status) ? WEXITSTATUS(status) : killed + WTERMSIG(status);
}

}  // namespace densify::app
