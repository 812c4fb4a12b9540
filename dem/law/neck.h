#pragma once
// The life of a neck between two sintering particles, and what is remembered of it.

#include <cstdint>

namespace densify::dem {

enum class NeckPhase : std::uint8_t {
  loose,         ///< no neck: Kelvin-Voigt contact
  activating,    ///< eta from eta_inf to theory, F_sint from 0 (4.47, 4.50)
  sintering,     ///< theory
  arriving,      ///< a = a_max reached: eta to eta_inf, F_sint to 0 (4.51, 4.52)
  bonded,        ///< at equilibrium for good: elastic bond
  deactivating,  ///< cooled below activation: the same fading
  dormant,       ///< cold neck short of equilibrium: elastic bond that can be activated again
  reactivating   ///< as activating, but of a neck: no friction is left to fade
};

/// History of one neck.
struct NeckHistory {
  double radius = 0;   ///< a [m]
  double elastic = 0;  ///< elastic displacement u_e, negative in compression [m]
  double since = 0;    ///< process time at which the present transition began [s]
  NeckPhase phase = NeckPhase::loose;
};

/// What changes of a neck while it stays in its phase; a lane each of several.
template <class T>
struct NeckOf {
  T radius;   ///< a [m]
  T elastic;  ///< u_e [m]
};

/// Which contacts are in which phase.
template <class Condition>
struct PhasesOf {
  Condition loose, sintering, bonded, dormant;
};

}  // namespace densify::dem
