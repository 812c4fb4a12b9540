#pragma once
// How large a step may be: the stability limits of thesis 4.8, read as stability analysis gives them.

#include "dem/boundary/cell_drive.h"
#include "dem/boundary/walls.h"

namespace densify::dem {

enum class StepRule : std::uint8_t {
  particle_sum,  ///< every particle's (and the punch's) matrix sum of stiffness and damping: safe in any packing
  thesis  ///< the smallest of the pairs' limits (4.71)-(4.75) as printed, to be used with its small safety factor
};

/// Largest step for which dt^2 k/(2 m) + dt c/m <= 1: a node of mass m whose contacts have stiffness k and damping c in
/// their stiffest direction, each with another free mass.  k alone gives sqrt(2 m/k) (4.69, 4.70), c alone m/c (half of
/// (4.72) as printed, which holds for one fixed end), both for one pair (4.71).  Infinite when k = c = 0. [s]
///
/// Why a step that no particle's limit forbids is stable.  The springs store sum_c k (n.(x_j - x_i))^2 / 2, and
/// (n.x_j - n.x_i)^2 <= 2 (n.x_i)^2 + 2 (n.x_j)^2, so that x^T K x <= 2 sum_i x_i^T A_i x_i with A_i the sum of k n n^T
/// over the contacts of particle i; in the same way C <= 2 B_i with the dampers' sums.  For a mode x with x^T M x = 1
/// the leap-frog with its half-step lag has z^2 + (a + c - 2) z + 1 - c = 0, a = dt^2 x^T K x, c = dt x^T C x, whose
/// roots stay in the unit circle while a/4 + c/2 <= 1 (Jury's criterion).  That follows from dt^2 lambda(A_i)/2 + dt
/// lambda(B_i) <= m_i for every particle, lambda the largest eigenvalue or a bound of it.  The sum of all k instead is
/// the trace of A_i, up to three times the eigenvalue.
double node_limit(double mass, double stiffness, double damping);

/// Limits of one contact with reduced mass m as the thesis states them: 2/omega (sqrt(1+xi^2)-xi) (4.71), 4 m/eta
/// (4.72), min(2/omega, eta/k) (4.73-4.75) [s].
double thesis_limit(const Linearisation&, double reduced_mass);

/// What a step limit is made of.
struct StepLimit {
  double critical = 0;         ///< [s]
  std::uint32_t particle = 0;  ///< index of the particle that sets it
  double punch_stiffness = 0;  ///< sum over the contacts of each wall is in Walls; here of the punch [N/m]
  CellStiffness cell;          ///< of a periodic cell
};

/// The punch as a node of the limit; mass 0 = no moving punch.
struct PunchNode {
  double mass = 0;         ///< [kg]
  double own_damping = 0;  ///< [N s/m]
  std::size_t wall = 0;
};

/// The pairs of a contact list that may touch now, the chunks in which a pass sums them up, and their pores.
struct PassPairs {
  const NearList& near;
  const Chunks& chunks;
  PoreClosure pores;
};

/// The limit of all particles and of the punch; the same bits for every number of threads.
StepLimit critical_step(const Particles&, const ContactList&, const PassPairs&, const Cell&, const PairTable&,
                        const ContactModel&, Walls&, const PunchNode&, PassTime, StepRule, int threads);

}  // namespace densify::dem
