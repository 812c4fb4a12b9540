#pragma once
// The linear systems of Newton's method: GMRES with a factorisation that serves as long as it does its work.

#include <deal.II/lac/petsc_sparse_matrix.h>
#include <deal.II/lac/petsc_vector.h>
#include <petscksp.h>

namespace densify::fem {

/// Every rank factorises the whole system, in one order, so that a number of ranks has its one result bit for bit.
class LinearSolver {
 public:
  explicit LinearSolver(MPI_Comm);
  ~LinearSolver();
  LinearSolver(const LinearSolver&) = delete;
  LinearSolver& operator=(const LinearSolver&) = delete;

  /// Solves to `tolerance` of the right-hand side; iterations.  Factorises anew when the old one serves too badly.
  /// Throws StepRefused when the system is singular.
  int solve(const dealii::PETScWrappers::MPI::SparseMatrix&, dealii::PETScWrappers::MPI::Vector& x,
            const dealii::PETScWrappers::MPI::Vector& b, double tolerance);

  /// The next system is another one: factorise it.
  void forget() { factorised_ = false; }

 private:
  KSP solver_ = nullptr;
  bool factorised_ = false;
};

}  // namespace densify::fem
