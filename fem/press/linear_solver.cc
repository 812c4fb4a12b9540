#include "fem/press/linear_solver.h"

#include <stdexcept>
#include <string>

#include "fem/press/step_refused.h"

namespace densify::fem {

namespace {

constexpr int most_iterations_of_an_old_one = 12;

void check(PetscErrorCode code) {
  if (code != 0) throw std::runtime_error("PETSc error " + std::to_string(code));
}

}  // namespace

LinearSolver::LinearSolver(MPI_Comm comm) {
  check(KSPCreate(comm, &solver_));
  check(KSPSetType(solver_, KSPGMRES));
  check(KSPSetOptionsPrefix(solver_, "press_"));
  PC preconditioner;
  check(KSPGetPC(solver_, &preconditioner));
  check(PCSetType(preconditioner, PCREDUNDANT));
  check(PetscOptionsSetValue(nullptr, "-press_redundant_pc_factor_mat_solver_type", MATSOLVERMUMPS));
  check(KSPSetFromOptions(solver_));
}

LinearSolver::~LinearSolver() {
  KSPDestroy(&solver_);
}

int LinearSolver::solve(const dealii::PETScWrappers::MPI::SparseMatrix& a, dealii::PETScWrappers::MPI::Vector& x,
                        const dealii::PETScWrappers::MPI::Vector& b, double tolerance) {
  const Mat matrix = a;
  for (const bool old : {true, false}) {
    if (old && !factorised_) continue;
    check(KSPSetOperators(solver_, matrix, matrix));
    check(KSPSetReusePreconditioner(solver_, old ? PETSC_TRUE : PETSC_FALSE));
    check(KSPSetTolerances(solver_, tolerance, 0, PETSC_DEFAULT, old ? most_iterations_of_an_old_one : 50));
    x = 0;
    check(KSPSolve(solver_, b, x));
    KSPConvergedReason reason;
    PetscInt iterations;
    check(KSPGetConvergedReason(solver_, &reason));
    check(KSPGetIterationNumber(solver_, &iterations));
    factorised_ = reason > 0;
    if (reason > 0) return int(iterations);
  }
  throw StepRefused("the linear system of the body is singular");
}

}  // namespace densify::fem
