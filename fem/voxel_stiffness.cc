#include "fem/voxel_stiffness.h"

#include <petscksp.h>

#include <Eigen/LU>
#include <algorithm>
#include <chrono>
#include <memory>
#include <string>

#include "base/check.h"
#include "fem/voxel_element.h"

namespace densify::fem {

namespace {

void check(PetscErrorCode code) {
  if (code != 0) throw std::runtime_error("PETSc error " + std::to_string(code));
}

/// Releases a PETSc object at the end of its scope.
template <class T, PetscErrorCode (*destroy)(T*)>
struct Owned {
  T object = nullptr;
  Owned() = default;
  Owned(const Owned&) = delete;
  Owned& operator=(const Owned&) = delete;
  ~Owned() { destroy(&object); }
  operator T() const { return object; }
};
using OwnedMat = Owned<Mat, MatDestroy>;
using OwnedVec = Owned<Vec, VecDestroy>;
using OwnedSolver = Owned<KSP, KSPDestroy>;
using OwnedSpace = Owned<MatNullSpace, MatNullSpaceDestroy>;

constexpr PetscInt no_node = -1;

/// Nodes of the solid voxels, numbered along z, and the slab of voxel planes that a rank owns with their lower nodes.
struct Numbering {
  std::array<int, 3> n;
  std::vector<PetscInt> node;     ///< of every corner of the grid; no_node in the void
  int first_plane, end_plane;     ///< of this rank
  PetscInt first_node, end_node;  ///< of this rank
  PetscInt nodes = 0;             ///< of all

  std::size_t at(int x, int y, int z) const {
    auto in = [](int k, int size) { return k < 0 ? k + size : k >= size ? k - size : k; };
    return (std::size_t(in(z, n[2])) * n[1] + in(y, n[1])) * n[0] + in(x, n[0]);
  }

  Numbering(const VoxelImage& image, int rank, int ranks) : n(image.n), node(image.size(), no_node) {
    for (int z = 0; z < n[2]; ++z)
      for (int y = 0; y < n[1]; ++y)
        for (int x = 0; x < n[0]; ++x)
          if (image.phase[image.at(x, y, z)] != 0)
            for (int v = 0; v < 8; ++v) node[at(x + (v & 1), y + (v >> 1 & 1), z + (v >> 2))] = 0;
    first_plane = n[2] * rank / ranks;
    end_plane = n[2] * (rank + 1) / ranks;
    const std::size_t plane = std::size_t(n[0]) * n[1];
    for (std::size_t k = 0; k < node.size(); ++k) {
      if (k == first_plane * plane) first_node = nodes;
      if (node[k] != no_node) node[k] = nodes++;
      if (k + 1 == end_plane * plane) end_node = nodes;
    }
    if (first_plane == end_plane) first_node = end_node = 0;
  }

  /// Calls with every solid voxel of the rank's slab: its material and the nodes of its corners.
  template <class Call>
  void visit(const VoxelImage& image, Call call) const {
    std::array<PetscInt, 8> corners;
    for (int z = first_plane; z < end_plane; ++z)
      for (int y = 0; y < n[1]; ++y)
        for (int x = 0; x < n[0]; ++x) {
          const int phase = image.phase[image.at(x, y, z)];
          if (phase == 0) continue;
          for (int v = 0; v < 8; ++v) corners[v] = node[at(x + (v & 1), y + (v >> 1 & 1), z + (v >> 2))];
          call(std::size_t(phase - 1), corners);
        }
  }
};

/// Number of nodes that share a voxel with each node of the rank: in its own rows and in those of others.
void count_neighbours(const VoxelImage& image, const Numbering& g, std::vector<PetscInt>& own,
                      std::vector<PetscInt>& other) {
  for (int z = g.first_plane; z < g.end_plane; ++z)
    for (int y = 0; y < g.n[1]; ++y)
      for (int x = 0; x < g.n[0]; ++x) {
        if (g.node[g.at(x, y, z)] == no_node) continue;
        std::array<PetscInt, 64> found;
        std::size_t size = 0;
        for (int v = 0; v < 8; ++v) {
          const int a = x - (v & 1), b = y - (v >> 1 & 1), c = z - (v >> 2);
          if (image.phase[g.at(a, b, c)] == 0) continue;
          for (int w = 0; w < 8; ++w) found[size++] = g.node[g.at(a + (w & 1), b + (w >> 1 & 1), c + (w >> 2))];
        }
        std::sort(found.begin(), found.begin() + size);
        const auto end = std::unique(found.begin(), found.begin() + size);
        const auto mine =
            std::count_if(found.begin(), end, [&](PetscInt k) { return k >= g.first_node && k < g.end_node; });
        own.push_back(PetscInt(mine));
        other.push_back(PetscInt(end - found.begin() - mine));
      }
}

/// The system of all voxels.
class VoxelSystem {
 public:
  VoxelSystem(const VoxelImage& image, const std::vector<ElasticSolid>& solids, MPI_Comm comm)
      : image_(image), comm_(comm), numbering_(image, rank(comm), ranks(comm)) {
    Mat3 edges = image.cell;
    for (int c = 0; c < 3; ++c) edges.col(c) /= image.n[c];
    probes_ = element_probes(edges);
    for (const auto& solid : solids) {
      elements_.push_back(element_matrix(edges, solid));
      forces_.push_back(elements_.back() * probes_);
    }
    assemble();
    give_spaces(edges);
  }

  VoxelAnswer solve(const VoxelSettings&);

 private:
  static int rank(MPI_Comm comm) {
    int r;
    MPI_Comm_rank(comm, &r);
    return r;
  }
  static int ranks(MPI_Comm comm) {
    int r;
    MPI_Comm_size(comm, &r);
    return r;
  }

  void assemble();
  void give_spaces(const Mat3& edges);
  void choose_solver(KSP);

  const VoxelImage& image_;
  MPI_Comm comm_;
  Numbering numbering_;
  ElementProbes probes_;
  std::vector<ElementMatrix> elements_;
  std::vector<ElementProbes> forces_;  // of an element under each unit strain
  OwnedMat matrix_;
};

void VoxelSystem::assemble() {
  const auto& g = numbering_;
  std::vector<PetscInt> own, other;
  count_neighbours(image_, g, own, other);
  const PetscInt rows = 3 * (g.end_node - g.first_node);
  check(MatCreate(comm_, &matrix_.object));
  check(MatSetSizes(matrix_, rows, rows, 3 * g.nodes, 3 * g.nodes));
  check(MatSetType(matrix_, MATAIJ));
  check(MatSetBlockSize(matrix_, 3));
  check(MatXAIJSetPreallocation(matrix_, 3, own.data(), other.data(), nullptr, nullptr));
  check(MatSetOption(matrix_, MAT_SPD, PETSC_TRUE));
  g.visit(image_, [&](std::size_t material, const std::array<PetscInt, 8>& corners) {
    // Eigen stores columns; the matrix is symmetric.
    check(MatSetValuesBlocked(matrix_, 8, corners.data(), 8, corners.data(), elements_[material].data(), ADD_VALUES));
  });
  check(MatAssemblyBegin(matrix_, MAT_FINAL_ASSEMBLY));
  check(MatAssemblyEnd(matrix_, MAT_FINAL_ASSEMBLY));
}

// A body that repeats itself may shift: nothing resists that.  It cannot turn, but its parts can, which the aggregates
// of the coarse levels have to represent.
void VoxelSystem::give_spaces(const Mat3& edges) {
  const auto& g = numbering_;
  OwnedVec places;
  check(MatCreateVecs(matrix_, &places.object, nullptr));
  check(VecSetBlockSize(places, 3));
  PetscScalar* value;
  check(VecGetArray(places, &value));
  for (int z = g.first_plane; z < g.end_plane; ++z)
    for (int y = 0; y < g.n[1]; ++y)
      for (int x = 0; x < g.n[0]; ++x) {
        const PetscInt k = g.node[g.at(x, y, z)];
        if (k == no_node) continue;
        const Vec3 at = edges * Vec3(x, y, z) / edges.col(0).norm();
        for (int c = 0; c < 3; ++c) value[3 * (k - g.first_node) + c] = at[c];
      }
  check(VecRestoreArray(places, &value));
  OwnedSpace rigid;
  check(MatNullSpaceCreateRigidBody(places, &rigid.object));
  check(MatSetNearNullSpace(matrix_, rigid));

  OwnedVec shift[3];
  Vec shifts[3];
  for (int c = 0; c < 3; ++c) {
    check(VecDuplicate(places, &shift[c].object));
    check(VecSet(shift[c], 0));
    check(VecStrideSet(shift[c], c, 1));
    check(VecNormalize(shift[c], nullptr));
    shifts[c] = shift[c];
  }
  OwnedSpace null;
  check(MatNullSpaceCreate(comm_, PETSC_FALSE, 3, shifts, &null.object));
  check(MatSetNullSpace(matrix_, null));
}

void VoxelSystem::choose_solver(KSP solver) {
  const char* const options[][2] = {
      {"-voxel_pc_gamg_threshold", "0.01"},
      {"-voxel_mg_levels_ksp_type", "chebyshev"},
      {"-voxel_mg_levels_ksp_max_it", "2"},
      {"-voxel_mg_levels_pc_type", "jacobi"},
      {"-voxel_mg_coarse_sub_pc_factor_shift_type", "inblocks"},
  };
  for (const auto& o : options) {
    PetscBool given;  // who knows PETSc may say otherwise in PETSC_OPTIONS
    check(PetscOptionsHasName(nullptr, nullptr, o[0], &given));
    if (!given) check(PetscOptionsSetValue(nullptr, o[0], o[1]));
  }
  check(KSPSetOperators(solver, matrix_, matrix_));
  check(KSPSetOptionsPrefix(solver, "voxel_"));
  check(KSPSetType(solver, KSPCG));
  check(KSPSetNormType(solver, KSP_NORM_UNPRECONDITIONED));
  PC pc;
  check(KSPGetPC(solver, &pc));
  check(PCSetType(pc, PCGAMG));
  check(KSPSetFromOptions(solver));
}

VoxelAnswer VoxelSystem::solve(const VoxelSettings& settings) {
  const auto& g = numbering_;
  const double volume = std::abs(image_.cell.determinant());
  OwnedSolver solver;
  check(KSPCreate(comm_, &solver.object));
  choose_solver(solver);

  VoxelAnswer answer;
  // Mean stress of a uniform strain, and the forces it leaves on the nodes.
  std::vector<double> of_material(elements_.size(), 0);
  g.visit(image_, [&](std::size_t material, const auto&) { of_material[material] += 1; });
  Mat6 uniform = Mat6::Zero();
  for (std::size_t m = 0; m < elements_.size(); ++m) uniform += of_material[m] * probes_.transpose() * forces_[m];

  OwnedVec load[6], motion[6];
  for (int k = 0; k < 6; ++k) {
    check(MatCreateVecs(matrix_, &motion[k].object, &load[k].object));
    check(VecSetBlockSize(load[k], 3));
    g.visit(image_, [&](std::size_t material, const std::array<PetscInt, 8>& corners) {
      const Eigen::Matrix<double, 24, 1> f = -forces_[material].col(k);
      check(VecSetValuesBlocked(load[k], 8, corners.data(), f.data(), ADD_VALUES));
    });
    check(VecAssemblyBegin(load[k]));
    check(VecAssemblyEnd(load[k]));
    // Against the forces of single voxels: of a homogeneous body those on the nodes cancel.
    double scale = 0;
    for (std::size_t m = 0; m < elements_.size(); ++m) scale += of_material[m] * forces_[m].col(k).squaredNorm();
    check(MPI_Allreduce(MPI_IN_PLACE, &scale, 1, MPI_DOUBLE, MPI_SUM, comm_));
    check(KSPSetTolerances(solver, 1e-14, settings.tolerance * std::sqrt(scale), PETSC_DEFAULT,
                           settings.most_iterations));
    check(KSPSolve(solver, load[k], motion[k]));
    KSPConvergedReason reason;
    check(KSPGetConvergedReason(solver, &reason));
    PetscInt iterations;
    check(KSPGetIterationNumber(solver, &iterations));
    answer.iterations += int(iterations);
    if (reason <= 0)
      throw RunError("the voxel system did not converge in " + std::to_string(iterations) +
                     " iterations (PETSc's reason " + std::to_string(int(reason)) + ")");
  }
  check(MPI_Allreduce(MPI_IN_PLACE, uniform.data(), 36, MPI_DOUBLE, MPI_SUM, comm_));
  OwnedVec force;
  check(VecDuplicate(load[0], &force.object));
  Mat6 stress = uniform, work = uniform;
  for (int l = 0; l < 6; ++l) {
    check(MatMult(matrix_, motion[l], force));
    for (int k = 0; k < 6; ++k) {
      double by_load, by_motion;
      check(VecDot(load[k], motion[l], &by_load));
      check(VecDot(motion[k], force, &by_motion));
      double other;
      check(VecDot(load[l], motion[k], &other));
      stress(k, l) -= by_load;                    // (E_k x)^T K u_l
      work(k, l) += by_motion - by_load - other;  // u_k^T K u_l
    }
  }
  answer.stiffness = 0.5 * (stress + stress.transpose()) / volume;
  const double largest = uniform.cwiseAbs().maxCoeff();
  answer.asymmetry = (stress - stress.transpose()).cwiseAbs().maxCoeff() / largest;
  answer.power_mismatch = (work - stress).cwiseAbs().maxCoeff() / largest;
  answer.nodes = std::size_t(g.nodes);
  return answer;
}

}  // namespace

VoxelAnswer voxel_stiffness(const VoxelImage& image, const std::vector<ElasticSolid>& solids,
                            const VoxelSettings& settings, MPI_Comm comm) {
  const auto begin = std::chrono::steady_clock::now();
  VoxelAnswer answer;
  const auto elements =
      std::size_t(std::count_if(image.phase.begin(), image.phase.end(), [](auto p) { return p != 0; }));
  if (elements > 0) answer = VoxelSystem(image, solids, comm).solve(settings);
  answer.elements = elements;
  answer.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  constexpr double allowed = 1e-4;
  const bool definite = elements == 0 || answer.stiffness.diagonal().minCoeff() > 0;
  if (!(answer.asymmetry < allowed && answer.power_mismatch < allowed && definite))
    throw RunError("the voxel solution breaks its own checks: asymmetry " + std::to_string(answer.asymmetry) +
                   ", power mismatch " + std::to_string(answer.power_mismatch) + (definite ? "" : ", not definite"));
  return answer;
}

}  // namespace densify::fem
