#pragma once
// A periodic cell that is driven: each of the six components of its motion by a rate or by a stress, along the process.
//
// The velocity gradient L of the cell is kept upper triangular: L_xx, L_yy, L_zz are the strain rates D_xx, D_yy, D_zz,
// and L_xy = dv_x/dy = 2 D_xy, L_xz, L_yz likewise.  So simple shear is one component, the direction of x and the plane
// of x and y stay where they are, and stresses refer to these fixed axes at any strain.

#include <array>
#include <limits>
#include <vector>

#include "base/schedule.h"
#include "dem/contact/step_stiffness.h"
#include "dem/state/cell.h"

namespace densify::dem {

/// The components of a tensor in the order of the history's columns.
inline constexpr std::array<std::array<int, 2>, 6> tensor_places{{{0, 0}, {1, 1}, {2, 2}, {0, 1}, {0, 2}, {1, 2}}};
inline constexpr std::array<const char*, 6> tensor_names{"xx", "yy", "zz", "xy", "xz", "yz"};

enum class CellControl : std::uint8_t { rate, stress };

/// What drives one component at the end of a stage.
struct CellGoal {
  CellControl control = CellControl::rate;
  double value = 0;  ///< L_ij [1/s], or stress, tension positive [Pa]; NaN at the start: the stress found there
};
using CellGoals = std::array<CellGoal, 6>;

/// The goals over a process, linear through stages.
struct CellPath {
  CellGoals start;
  std::vector<CellGoals> stages;

  /// True when any component of any stage is driven by a stress.
  bool by_stress() const;
  bool by_stress(std::size_t stage) const;
  /// Largest stress that is ever asked for [Pa].
  double peak_stress() const;
};

/// What a driven cell remembers.
struct CellDrive {
  static constexpr std::uint64_t no_stage = std::numeric_limits<std::uint64_t>::max();

  double mass = 0;                      ///< W, kinetic energy W |D|^2/2 [kg m^2]
  double damping = 0;                   ///< on what a rate differs from its running mean [kg m^2/s]
  double memory = 0;                    ///< of that mean [s]
  std::array<double, 6> mean{};         ///< of L_ij [1/s]
  std::array<double, 6> slope{};        ///< of the mean [1/s^2]
  std::array<double, 6> found{};        ///< stress when its component came under control [Pa]
  std::uint64_t stage = no_stage;       ///< for which `found` stands
  Mat3 deformation = Mat3::Identity();  ///< F of the whole run, dF/dt = L F
};

/// The goal of a component at a time: rates and stresses run linearly from the end of the stage before.  What changes
/// from rate to stress starts from the stress found, what changes from stress to rate has its rate at once.
double goal(const CellPath&, const Schedule&, const CellDrive&, std::size_t component, double time);

/// Notes the stress of what comes under control in the stage of this time.
void enter_stage(CellDrive&, const CellPath&, const Schedule&, double time, const Mat3& stress);

/// What resists the motion of a cell, 2 sum_i r_i^2 A_i with A_i the matrix sum over the contacts of a particle, and a
/// bound of what contacts that are about to form would add if every particle had one.
struct CellStiffness {
  SymmetricSum stiffness;      ///< [N m]
  SymmetricSum damping;        ///< [N s m]
  double ready_stiffness = 0;  ///< [N m]
  double ready_damping = 0;    ///< [N s m]
};

/// Mass and damper of the cell for a step dt = `step`, beside particles with (1 + e) times the masses that this step
/// and its `safety` s ask for, e = `share`.
///
/// A contact's stretch rate is n.(v_j - v_i) + n.D b with the branch b, and its square at most (1 + e) (n.(v_j -
/// v_i))^2
/// + (1 + 1/e) (n.D b)^2.  With b = d n, d <= r_i + r_j: sum_c k (n.D b)^2 <= D^2 : sum_c k d^2 n n^T <= |D|^2 lambda,
/// lambda the largest eigenvalue of 2 sum_i r_i^2 A_i; likewise for dampers.  So W = (1 + 1/e) (lambda_k dt^2/(4 s^2) +
/// lambda_c dt/(2 s)) keeps cell and particles stable together: as light as can be, so that the stress follows its goal
/// within some ten steps.
void weigh(CellDrive&, const CellStiffness&, double share, double step, double safety);

/// Leap-frog kick: W dD/dt = V (goal - stress) where a stress is asked for, L = goal in the middle of the step where a
/// rate is [s].
void kick(CellDrive&, Cell&, const CellPath&, const Schedule&, double time, const Mat3& stress, double kick_step,
          double step);

}  // namespace densify::dem
