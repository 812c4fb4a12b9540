#pragma once
// All stresses of one moment, in the groups that tables and histograms show.

#include "dem/measure/particle_stress.h"

namespace densify::dem {

inline constexpr StressPart stress_parts[] = {StressPart::sintering, StressPart::viscoelastic, StressPart::total};
/// "sintering", "viscoelastic", "total".
const char* name_of(StressPart);

/// One tensor, or one list of them, for each of stress_parts.
template <class T>
using OfParts = std::array<T, 3>;

struct MomentStresses {
  ContactKinds kinds;
  double volume;                              ///< that macroscopic stresses refer to [m^3]
  OfParts<Stress> macroscopic;                ///< (6.10), contacts and walls [Pa]
  OfParts<std::vector<Stress>> by_kind;       ///< its shares by kinds of contact [Pa]
  OfParts<std::vector<Stress>> by_material;   ///< the shares of materials, from particles (6.9) [Pa]
  OfParts<std::vector<Stress>> of_particles;  ///< (6.5, 6.6) [Pa]
  std::vector<NeckStress> necks;              ///< (6.1)-(6.4)
  /// Difference of (6.9), from the particle stresses in the snapshot, and (6.10), over the sum of |L| |F|/V.
  double mismatch;
};

/// Throws RunError when (6.9) and (6.10) differ by more than rounding.
MomentStresses moment_stresses(const Snapshot&);

/// A number of each member of a group.
struct Group {
  std::string name;
  std::vector<double> values;
};

/// Numbers of all particles, by material, and last those of "all" where there are several materials.
std::vector<Group> by_materials(const Snapshot&, const std::vector<double>& of_particles);

/// Which necks: the thesis looks at those short of a_max.
enum class NeckSet : std::uint8_t { all, short_of_equilibrium };

/// Normal stress in the necks of a set, by kinds of contact, and last those of "all" where there are several kinds.
std::vector<Group> necks_by_kinds(const Snapshot&, const MomentStresses&, StressPart, NeckSet);

/// Mean stress of each tensor (6.8).
std::vector<double> mean_stresses(const std::vector<Stress>&);

}  // namespace densify::dem
