#pragma once
// How Densify says no: three kinds of failure, one grammar "problem (why): what to try".

#include <stdexcept>
#include <string>

namespace densify {

/// Input that the user can mend: a scene, a command line, an import, a result folder.  Exit code 2.
struct InputError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// A run that had to stop: non-finite state, escaped particle, overlap beyond the limit.  Exit code 3.
struct RunError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// A file that could not be read or written: full disk, missing permission.  Exit code 4.
struct FileError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// A run ended by SIGINT or SIGTERM after its checkpoint was written.  Exit code 5.
struct Interrupted : std::runtime_error {
  using std::runtime_error::runtime_error;
};

namespace detail {
[[noreturn]] void broken_contract(const char* condition, const char* file, int line);
}

}  // namespace densify

// A contract between functions of the project; a breach is a bug, never the user's fault.  Checked in the presets dev,
// audit and sanitize, free in release.
#if defined(DENSIFY_CHECKS)
#define DENSIFY_EXPECT(condition) \
  ((condition) ? void(0) : ::densify::detail::broken_contract(#condition, __FILE__, __LINE__))
#else
#define DENSIFY_EXPECT(condition) void(0)
#endif
