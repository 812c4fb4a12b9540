#pragma once
// The finite element commands are a program of their own beside this one, so that no other command loads deal.II.

namespace densify::app {

/// Becomes that program, with --ranks N under mpirun.  Throws InputError when it was not built or cannot be started.
[[noreturn]] void become_voxel_program(int argc, char** argv);

}  // namespace densify::app
