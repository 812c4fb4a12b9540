#pragma once
// The finite element commands are programs of their own beside this one, so that no other command loads deal.II.

#include <string>
#include <vector>

namespace densify::app {

inline constexpr const char* voxel_program = "densify-voxel-moduli";
inline constexpr const char* press_program = "densify-press";
inline constexpr const char* tabulate_program = "densify-tabulate";

/// Throws InputError when a program was not built: "`who` needs deal.II ...", and `otherwise`.
void require_program(const std::string& program, const std::string& who, const std::string& otherwise);

/// Becomes a program, with --ranks N under mpirun.  Throws InputError when it was not built or cannot be started.
[[noreturn]] void become_program(const std::string& program, const std::string& who,
                                 const std::vector<std::string>& arguments);

/// Runs one with these arguments, --ranks N among them, and returns its exit code; what it has to say it says itself.
int run_program(const std::string& program, const std::vector<std::string>& arguments);

}  // namespace densify::app
