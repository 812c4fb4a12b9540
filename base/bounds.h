#pragma once
// Between which moduli a mixture of phases lies, whatever the arrangement of the phases.  A void is a phase of no
// moduli.

#include <span>
#include <vector>

#include "base/isotropic.h"

namespace densify {

struct Phase {
  double fraction;  ///< of the volume; all sum up to 1
  IsotropicModuli moduli;
};

/// Bounds of Young's modulus [Pa].
struct YoungsBounds {
  double lower, upper;
};

/// Reuss and Voigt: harmonic and arithmetic mean of the phases' Young's moduli, as the thesis takes them (3.3.3).  The
/// means of K and G, which are the strict bounds, lie a little outside.
YoungsBounds reuss_voigt(std::span<const Phase>);

struct ModuliBounds {
  IsotropicModuli lower, upper;
  YoungsBounds youngs() const { return {lower.youngs(), upper.youngs()}; }
};

/// Hashin and Shtrikman (J. Mech. Phys. Solids 11, 1963, 127) of an isotropic mixture of any number of phases:
/// K = (sum f/(K_i + 4/3 G*))^-1 - 4/3 G*, G = (sum f/(G_i + z*))^-1 - z* with z = G (9 K + 8 G)/(6 (K + 2 G)), where *
/// are the least moduli of all phases for the lower bound and the largest for the upper one (Walpole, 1966).
ModuliBounds hashin_shtrikman(std::span<const Phase>);

/// The dense mixture: halfway between the bounds of Hashin and Shtrikman; of one phase that phase.
IsotropicModuli dense_solid(std::span<const Phase>);

/// The phases of a body of this relative density, up to 1, with its pores as one more.
std::vector<Phase> with_pores(std::span<const Phase>, double relative_density);

}  // namespace densify
