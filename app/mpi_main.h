#pragma once
// What the programs with deal.II share: the beginning and end of MPI, and one voice for all ranks.

#include <deal.II/base/mpi.h>

#include <cstdio>
#include <functional>

#include "app/command_line.h"

namespace densify::app {

/// Whether this rank speaks for all.
inline bool speaks() {
  return dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0;
}

/// Parses the command line on every rank, complains on one.  The exit code where that ends the program, else -1.
inline int parse_on_all(CLI::App& command, int argc, char** argv) {
  try {
    command.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (!speaks()) return error.get_exit_code() == 0 ? 0 : 2;
    return command.exit(error) == 0 ? 0 : 2;
  }
  return -1;
}

/// The exit code of `program` between the beginning and the end of MPI.
inline int mpi_main(char** argv, const std::function<int()>& program) {
  int own_argc = 1;  // PETSc must not read this program's options
  dealii::Utilities::MPI::MPI_InitFinalize mpi(own_argc, argv, 1);
  if (!speaks()) std::freopen("/dev/null", "w", stderr);  // one rank complains for all
  const int code = guarded(program);
  // Bad input, a run that a guard stops and one that is interrupted end alike on all ranks; what does not must not let
  // the others wait for ever.
  if (code != 0 && code != 2 && code != 3 && code != 5 && dealii::Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD) > 1)
    MPI_Abort(MPI_COMM_WORLD, code);
  return code;
}

}  // namespace densify::app
