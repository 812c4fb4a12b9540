#pragma once
// What a contact kernel is given, in plain pointers, and the kernels that this processor has.

#include <string>
#include <vector>

#include "dem/contact/pair_force.h"
#include "dem/law/pore_closure.h"

namespace densify::dem {

/// Places in a ContactRecord, in doubles: force and normal are one row of four, couple and sintering the next, and the
/// last the levers of i and j, damping and energy.
struct RecordLayout {
  static constexpr int size = 13, force = 0, couple = 4, levers = 8, touching = 12;
};

struct KernelJob;
using GeneralLaw = void (*)(const KernelJob&, std::size_t near, double* of_i, double* of_j, double* stiffness);

/// The near pairs of one bucket in one chunk of the particles, and everything they read and write.
struct KernelJob {
  // Near pairs:
  const std::uint32_t* place;     ///< in the contact list
  const std::uint16_t* offset_i;  ///< 8 x the place of i among the particles of the chunk
  const std::uint32_t* offset_j;  ///< 8 x the place of j among the sums of the chunk
  // Contact list:
  const std::uint32_t* second;
  double* tangential;  ///< 3 a pair
  NeckHistory* neck;
  // Particles:
  const double* body;  ///< 8 a particle: x y z r v_x v_y v_z 1/m
  const double* spin;  ///< 3 a particle
  const std::uint8_t* material;
  bool far;  ///< too many to stay in the second cache: asked for some pairs ahead
  // Uniform:
  const double* shift;     ///< 4 an image code (x y z 0)
  const double* gradient;  ///< velocity gradient by columns; null in a cell that does not deform
  bool growing;
  double growth_a, growth_b;  ///< relative growth rate of the radii of both materials since the last pass [1/s]
  std::uint8_t material_a;
  const void* law;
  PairUniform uniform;
  PoreClosure pores;
  // Sums of the chunk, `stride` doubles a particle: force and 0; with friction torque and 0; with next_step > 0 what
  // StiffnessSum holds and 0.  Its own particles first, then others.
  double* sums;
  std::size_t stride;
  std::uint32_t first_particle;
  double next_step;  ///< of StepStiffness [s]; 0: none asked for
  double* record;    ///< of each pair of the contact list, as RecordLayout; null: none asked for

  /// The pair at a place of the near list by the general law; fills its record, and 8 doubles each: what i receives,
  /// what j receives (force and 0, torque and 0), and the stiffness that both receive.
  GeneralLaw general;
};

/// Near pairs begin to end of a job.
using Kernel = void (*)(const KernelJob&, std::size_t begin, std::size_t end);

/// The kernels of one instruction set.
struct KernelTable {
  const char* name;
  int width;               ///< contacts at once
  Kernel kernel[2][2][2];  ///< [necks][Hertz][friction]
};

/// Those that this build holds and this processor can run, the plainest first.
const std::vector<KernelTable>& available_kernels();

/// The last of available_kernels(), or the one that the environment variable DENSIFY_INSTRUCTIONS names ("baseline",
/// "avx2", "avx512"); all give the same results bit for bit.  Throws InputError when there is none of that name.
const KernelTable& chosen_kernels();

}  // namespace densify::dem
