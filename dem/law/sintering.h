#pragma once
// The contact of sintering particles through its whole life: loose, activating, sintering, at equilibrium, frozen by
// cooling, and hot again.  Thermo-viscoelastic (Maxwell, 4.37-4.46) or viscous (4.29-4.36), always with the elastic
// displacement as history so that a stiffness that changes with temperature creates no energy.

#include <algorithm>
#include <cstdint>

#include "dem/law/contact_model.h"
#include "dem/law/kelvin_voigt.h"
#include "dem/law/transition.h"

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

template <class Spring>
struct SinteringContact {
  KelvinVoigt<Spring> loose;  ///< the law before activation
  SinteringSettings settings;
  double mobility_factor;  ///< 8 D_eff / pi, so that 1/eta = factor / a^4 (4.40) [m^5/(N s)]
  double surface_energy;   ///< gamma_s [J/m^2]
  double cap;              ///< 4 (1 - cos(Psi/2))
  double sine;             ///< sin(Psi/2)
  bool active;             ///< T >= activation temperature
  bool activation_step;    ///< the first update above it: contacts found now are pressed ones, later ones are born

  double largest_neck(const NormalInput& in) const { return in.sintering_radius * sine; }  ///< a_max (4.32) [m]
  double smallest_neck(const NormalInput& in) const { return settings.starting_neck * in.sintering_radius; }

  /// eta = pi a^4 / (8 D_eff) (4.40) [N s/m].
  double viscosity(double a) const { return a * a * a * a / mobility_factor; }

  /// F_sint = pi gamma (4 r (1 - cos(Psi/2)) + a sin(Psi/2)) (4.36) [N].
  double sintering_force(double a, double r) const { return std::numbers::pi * surface_energy * (cap * r + a * sine); }

  /// Share of flow and sintering force that is switched on: 1 while sintering, 0 for a bond.
  double activity(const NeckHistory& h, double time) const {
    switch (h.phase) {
      case NeckPhase::activating:
      case NeckPhase::reactivating:
        return cosine_step(progress(h, time));
      case NeckPhase::sintering:
        return 1;
      case NeckPhase::arriving:
      case NeckPhase::deactivating:
        return 1 - cosine_step(progress(h, time));
      default:
        return 0;
    }
  }

  /// Share of Coulomb friction that is left: fades with activation.
  double friction_share(const NeckHistory& h, double time) const {
    if (h.phase == NeckPhase::loose) return 1;
    return h.phase == NeckPhase::activating ? 1 - cosine_step(progress(h, time)) : 0;
  }

  /// Force of this step; advances the neck.  Called for overlapping pairs and for every pair that has a neck.
  NormalForce update(const NormalInput& in, NeckHistory& h) const {
    if (h.phase == NeckPhase::loose) {
      if (!active) return loose.update(in);
      begin(in, h);
      const double share = activity(h, in.time);
      const double f_sint = share > 0 ? share * sintering_force(h.radius, in.sintering_radius) : 0;
      const double f = settings.model == SinteringModel::viscous ? viscosity(h.radius) * in.rate
                                                                 : loose.spring.force(h.elastic, in.elastic_radius);
      return {f + f_sint, f_sint};
    }
    change_phase(in, h);
    double neck = h.radius;  // at the middle of the step (4.57)
    if (flows(h.phase)) {
      grow(in, h);
      if (in.overlap >= 0 && h.radius <= smallest_neck(in) && h.phase != NeckPhase::arriving) {
        h = NeckHistory{};  // a neck that vanished is a lost contact
        return {};
      }
      neck = 0.5 * (neck + h.radius);
      if (h.radius >= largest_neck(in)) reach_equilibrium(in, h);
    }
    const double share = activity(h, in.time);
    const double f_sint = share > 0 ? share * sintering_force(neck, in.sintering_radius) : 0;
    if (settings.model == SinteringModel::viscous && flows(h.phase) && h.phase != NeckPhase::arriving)
      return {viscosity(neck) * in.rate + f_sint, f_sint};

    const double before = h.elastic;
    const double k = loose.spring.tangent(before, in.elastic_radius);
    const double mobility = h.phase == NeckPhase::sintering ? mobility_factor / (neck * neck * neck * neck)
                                                            : 1 / series_viscosity(h.phase, neck, share);
    // Theta rule for du_e/dt = rate - F(u_e)/eta, one Newton step: theta 1 backward Euler (L-stable), 1/2 (4.67).
    const double theta = settings.update == MaxwellUpdate::trapezoidal ? 0.5 : 1.0;
    const double elastic_rate =
        (in.rate - mobility * loose.spring.force(before, in.elastic_radius)) / (1 + theta * in.step * mobility * k);
    h.elastic = before + in.step * elastic_rate;
    double f = loose.spring.force(h.elastic, in.elastic_radius);
    // The damper sees the elastic part of the rate only: it stills vibration and adds no viscosity to the flow.
    if (settings.damping_ratio > 0 && in.step > 0) f += damper(in, k) * elastic_rate;
    return {f + f_sint, f_sint};
  }

  Linearisation linearise(const NormalInput& in, const NeckHistory& h) const {
    if (h.phase == NeckPhase::loose) return loose.linearise(in);
    const double share = activity(h, in.time);
    const double k = loose.spring.tangent(h.elastic, in.elastic_radius);
    const double active_force = share > 0 ? share * sintering_force(h.radius, in.sintering_radius) : 0;
    if (settings.model == SinteringModel::viscous && flows(h.phase) && h.phase != NeckPhase::arriving)
      return {std::numeric_limits<double>::infinity(), 0, viscosity(h.radius), active_force,
              viscosity(h.radius) * in.rate};
    return {k, damper(in, k), series_viscosity(h.phase, h.radius, share), active_force,
            loose.spring.force(h.elastic, in.elastic_radius)};
  }

  /// True while the neck grows and flows.
  static bool flows(NeckPhase p) {
    return p == NeckPhase::activating || p == NeckPhase::sintering || p == NeckPhase::arriving ||
           p == NeckPhase::deactivating || p == NeckPhase::reactivating;
  }

 private:
  double progress(const NeckHistory& h, double time) const {
    return settings.relaxation_time > 0 ? std::clamp((time - h.since) / settings.relaxation_time, 0.0, 1.0) : 1.0;
  }

  /// Enters a phase with a part of its transition already behind it, so that a turn in mid-transition makes no jump.
  void enter(NeckHistory& h, NeckPhase phase, double time, double done) const {
    h.phase = phase;
    h.since = time - done * settings.relaxation_time;
  }

  double damper(const NormalInput& in, double k) const {
    return settings.damping_ratio > 0 ? 2 * settings.damping_ratio * std::sqrt(in.reduced_mass * k) : 0.0;
  }

  /// Dashpot in series with the spring (4.47, 4.51); eta_inf is never below the theory's viscosity.
  double series_viscosity(NeckPhase phase, double a, double share) const {
    const double theory = viscosity(a);
    const double before = std::max(settings.viscosity_before, theory);
    if (!flows(phase))
      return settings.at_equilibrium == AtEquilibrium::viscous && phase == NeckPhase::bonded
                 ? before
                 : std::numeric_limits<double>::infinity();
    if (theory >= settings.viscosity_before) return theory;  // where nothing diffuses it is infinite
    return (1 - share) * before + share * theory;
  }

  double neck_of_overlap(const NormalInput& in) const {
    const double r = in.sintering_radius, rest = r + 0.5 * in.overlap;
    return in.overlap < 0 ? 1.43 * std::sqrt(std::max(0.0, r * r - rest * rest)) : 0.0;
  }

  void begin(const NormalInput& in, NeckHistory& h) const {
    const bool pressed = activation_step && settings.model == SinteringModel::viscoelastic;
    h.phase = pressed ? NeckPhase::activating : NeckPhase::sintering;
    h.since = in.time;
    h.elastic = in.overlap;
    const double a0 = settings.neck == NeckGrowth::overlap
                          ? neck_of_overlap(in)
                          : std::sqrt(0.5 * in.sintering_radius * std::max(0.0, -in.overlap));  // (4.30)
    h.radius = std::clamp(a0, smallest_neck(in), largest_neck(in));
  }

  /// a' = -r v / a (4.31) as a^2 - 2 r v dt (4.58), or the overlap's own neck; between a small neck and a_max.
  void grow(const NormalInput& in, NeckHistory& h) const {
    const double a = settings.neck == NeckGrowth::overlap
                         ? neck_of_overlap(in)
                         : std::sqrt(std::max(0.0, h.radius * h.radius - 2 * in.sintering_radius * in.rate * in.step));
    h.radius = std::clamp(a, smallest_neck(in), largest_neck(in));
  }

  void change_phase(const NormalInput& in, NeckHistory& h) const {
    const double time = in.time;
    const auto done = [&] { return progress(h, time); };  // a division that most contacts do not need
    if (settings.model == SinteringModel::viscous && (active ? h.phase == NeckPhase::dormant : flows(h.phase))) {
      // A dashpot has no elastic state to fade from: the bond carries its force and the sintering force that ends here.
      if (!active) bond_takes_over(in, h, sintering_force(h.radius, in.sintering_radius));
      h.phase = active ? NeckPhase::sintering : NeckPhase::dormant;
      return;
    }
    switch (h.phase) {
      case NeckPhase::activating:
      case NeckPhase::reactivating:
        if (!active)
          enter(h, NeckPhase::deactivating, time, 1 - done());
        else if (done() >= 1)
          h.phase = NeckPhase::sintering;
        break;
      case NeckPhase::sintering:
        if (!active) enter(h, NeckPhase::deactivating, time, 0);
        break;
      case NeckPhase::deactivating:
        if (active)
          enter(h, NeckPhase::reactivating, time, 1 - done());
        else if (done() >= 1)
          h.phase = NeckPhase::dormant;
        break;
      case NeckPhase::dormant:
        if (active) enter(h, NeckPhase::reactivating, time, 0);
        break;
      case NeckPhase::arriving:
        if (done() >= 1) h.phase = NeckPhase::bonded;
        break;
      default:
        break;
    }
  }

  void bond_takes_over(const NormalInput& in, NeckHistory& h, double sintering) const {
    h.elastic = loose.spring.displacement(viscosity(h.radius) * in.rate + sintering, in.elastic_radius);
  }

  void reach_equilibrium(const NormalInput& in, NeckHistory& h) const {
    if (h.phase == NeckPhase::arriving) return;
    if (settings.model == SinteringModel::viscous) bond_takes_over(in, h, 0);  // F_sint fades on its own
    const bool rising = h.phase == NeckPhase::activating || h.phase == NeckPhase::reactivating;
    const double done = rising                               ? 1 - progress(h, in.time)
                        : h.phase == NeckPhase::deactivating ? progress(h, in.time)
                                                             : 0.0;
    enter(h, NeckPhase::arriving, in.time, done);
  }
};

}  // namespace densify::dem
