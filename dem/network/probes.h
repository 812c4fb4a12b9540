#pragma once
// What a network answers to six unit rates of its cell and to none: with springs in the contacts an elastic stiffness,
// with dashpots a viscosity, with the steps of a Maxwell network the affine law of one step (thesis 6.10).

#include <functional>

#include "dem/network/network.h"

namespace densify::dem {

/// What joins the two ends of an edge; dashpots when the motion is a rate.
struct EdgeLaw {
  double coefficient;  ///< along the normal [N/m]
  double lateral;      ///< across it [N/m]
  double force;        ///< along the normal at no rate, tension positive [N]
  double bending = 0;  ///< against rotation across the normal [N m]
  double torsion = 0;  ///< against rotation about it [N m]
};

/// Whether particles turn: then lateral springs act at the contact point, otherwise between the centres.
enum class Rotation : std::uint8_t { held, free };

struct ProbeSettings {
  double volume;     ///< of the cell, or of the region [m^3]
  double tolerance;  ///< of the balance of forces: error of the motions in the energy norm, relative
  Rotation rotation;
  std::size_t direct_nodes = 250;  ///< networks of at most so many particles, few neighbours eliminated, are factorised
  std::function<void(double)> watch = {};  ///< called on the way with the error, which falls to `tolerance`
};

/// Stress of a cell as an affine function of its rate: stress = active + matrix x rate; unit that of the coefficients
/// over m^2.
struct CellResponse {
  Mat6 affine = Mat6::Zero();          ///< every particle moves with the cell and none turns: an upper bound
  Mat6 relaxed = Mat6::Zero();         ///< forces in balance
  Vec6 affine_active = Vec6::Zero();   ///< stress at no rate, particles at rest [Pa]
  Vec6 relaxed_active = Vec6::Zero();  ///< the same with forces in balance [Pa]
  // Checks, over the largest entry of the affine matrix:
  double asymmetry = 0;            ///< largest |C - C^T| of the relaxed matrix
  double power_mismatch = 0;       ///< largest |sum of f.v / V - stress.rate| over all pairs of rates (Hill-Mandel)
  double smallest_eigenvalue = 0;  ///< of the relaxed matrix
  bool floppy = false;             ///< nothing is left of the affine matrix: too few contacts; relaxed is then zero
  double imbalance = 0;            ///< of forces, what is left of it in the energy norm; stresses err with its square
  int iterations = 0;
  std::size_t bytes = 0;  ///< memory of matrices
};

/// Probes a network.  `law(edge)` gives each edge's EdgeLaw.  At a wall, or where an edge leaves the region, the far
/// end moves with the cell.  Throws RunError when forces cannot be balanced.
CellResponse probe_cell(const Network&, const std::function<EdgeLaw(const NetworkEdge&)>& law, const ProbeSettings&);

/// Throws RunError with a sentence when the relaxed matrix is not symmetric, has a negative eigenvalue, or stress and
/// rate do another work than the contacts: more than `tolerance` each.
void require_sound(const CellResponse&, double tolerance);

/// Motions that the network does not resist: eigenvalues below `share` of the largest diagonal entry, the three
/// translations of a periodic network among them.  Factorises: for small networks.
std::size_t count_soft_modes(const Network&, const std::function<EdgeLaw(const NetworkEdge&)>& law, Rotation,
                             double share);

}  // namespace densify::dem
