#pragma once
// What every contact law takes and gives.  A law is a struct of parameters, a small named history and two pure
// functions: `update` (hot: the force of this step) and `linearise` (cold: what a network or a time step limit needs).

namespace densify::dem {

/// One contact at one step, or a lane each of several.  Signs: n points from i to j; displacement and rate negative
/// when the pair approaches.
template <class T>
struct NormalInputOf {
  T overlap;           ///< u = |x_j - x_i| - r_i - r_j (4.16), negative in contact [m]
  T rate;              ///< v_rn less thermal growth: of r_i + r_j, or of the distance itself through a neck [m/s]
  T elastic_radius;    ///< radius of the Hertz stiffness [m]
  T sintering_radius;  ///< radius of neck, sintering force and a_max (4.33) [m]
  T reduced_mass;      ///< m_i m_j / (m_i + m_j), scaled masses [kg]
  double step;         ///< time since the last update, 0 at the first [s]
  double time;         ///< process time [s]
  T flow_share = 1.0;  ///< of the neck's viscous flow, that closing pores leave to it
};
using NormalInput = NormalInputOf<double>;

/// Normal force of one contact, tension positive.
template <class T>
struct NormalForceOf {
  T total = 0;      ///< [N]
  T sintering = 0;  ///< the part that attracts actively, F_sint (4.36) [N]
};
using NormalForce = NormalForceOf<double>;

/// F = active + spring(k) || damper(c) in series with a dashpot(eta); eta = infinity for a contact without flow.
struct Linearisation {
  double stiffness = 0;  ///< tangent of the spring [N/m]
  double damper = 0;     ///< parallel to the spring [N s/m]
  double viscosity = 0;  ///< dashpot in series with the spring; infinity when absent [N s/m]
  double active = 0;     ///< F_sint [N]
  double stored = 0;     ///< force in spring and dashpot now [N]
};

}  // namespace densify::dem
