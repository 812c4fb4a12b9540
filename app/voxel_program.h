#pragma once
// The finite element commands are a program of their own beside this one, so that no other command loads deal.II.

#include <string>
#include <vector>

namespace densify::app {

/// Throws InputError when that program was not built: "`who` needs deal.II ...", and `otherwise`.
void require_voxel_program(const std::string& who, const std::string& otherwise);

/// Becomes that program, with --ranks N under mpirun.  Throws InputError when it was not built or cannot be started.
[[noreturn]] void become_voxel_program(int argc, char** argv);

/// Runs it with these arguments, --ranks N among them, and returns its exit code; what it has to say it says itself.
int run_voxel_program(const std::vector<std::string>& arguments);

}  // namespace densify::app
