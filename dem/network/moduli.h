#pragma once
// The material that a packing is at one moment: elastic moduli by several contact models, viscosities, sintering
// stress and free densification rate.

#include "base/bounds.h"
#include "base/elastic_tensor.h"
#include "dem/network/neck_models.h"
#include "dem/network/structure.h"

namespace densify::dem {

struct ModuliSettings {
  std::vector<NeckModel> models;
  double tangential = unset;  ///< lateral over normal stiffness of contacts; unset: the model's own
  /// Lateral over normal viscosity, which the law does not have: holds particles in line or in plane with the
  /// neighbours that pull at them, where they are held in truth and the network at one moment cannot see it
  /// (doc/moduli.md).
  double tangential_viscosity = 1e-4;
  double rigid = 1e4;         ///< contacts that do not flow, over the median viscosity of those that do
  double balance = 1e-6;      ///< of the balance of forces, see ProbeSettings
  double soft_share = unset;  ///< count motions that resist less than this share of the stiffest; unset: do not
  double tolerance = 1e-6;    ///< of symmetry, definiteness and Hill-Mandel
  std::function<void(double)> watch = {};  ///< see ProbeSettings
};

/// A tensor with its isotropic part, relaxed and affine.
struct TensorAnswer {
  CellResponse response;
  IsotropicPart relaxed, affine;
  double soft_modes =
      unset;           ///< motions of particles that nothing resists, three of them the body's; unset: not counted
  double seconds = 0;  ///< wall time of the solution
};

/// Elastic stiffness [Pa].  Throws RunError when forces cannot be balanced or the tensor fails its checks, as of a
/// network that its springs hardly hold.
TensorAnswer elastic_answer(const SpecimenNetwork&, const std::vector<Material>&, NeckModel, const ModuliSettings&);

struct ViscousAnswer {
  TensorAnswer viscosity;        ///< [Pa s]
  Vec6 sintering_stress;         ///< relaxed: at no rate, forces in balance; tension positive [Pa]
  Vec6 affine_sintering_stress;  ///< of F_sint alone (6.10) [Pa]
  Vec6 free_strain_rate;         ///< of the cell without stress, shear rates as engineering shears [1/s]
  double densification_rate;     ///< -trace of it: relative rate of the relative density [1/s]
  std::size_t flowing;           ///< contacts that flow
  std::size_t rigid;             ///< contacts cut to the stiffest viscosity allowed
};

/// Number of contacts that flow: sintering by their law.
std::size_t count_flowing(const SpecimenNetwork&);

/// Dashpots for springs, the necks as they are.  Needs contacts that flow.  Throws RunError as elastic_answer.
ViscousAnswer viscous_answer(const SpecimenNetwork&, const ModuliSettings&);

/// What is known when no solution is good enough: NaN for tensors and what comes from them, contacts counted.
TensorAnswer unknown_elastic_answer();
ViscousAnswer unknown_viscous_answer(const SpecimenNetwork&, const ModuliSettings&);

/// The particles' materials by volume with their moduli at the network's temperature: the dense body that the packing
/// would become.  Throws InputError when a material that is there has no moduli.
std::vector<Phase> solid_phases(const SpecimenNetwork&, const std::vector<Material>&);

/// Throws InputError when no island of contacts spans the cell or the region.
void require_percolation(const SpecimenNetwork&, const NetworkStructure&);

}  // namespace densify::dem
