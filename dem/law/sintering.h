#pragma once
// The contact of sintering particles through its whole life: loose, activating, sintering, at equilibrium, frozen by
// cooling, and hot again.  Thermo-viscoelastic (Maxwell, 4.37-4.46) or viscous (4.29-4.36), always with the elastic
// displacement as history so that a stiffness that changes with temperature creates no energy.

#include <algorithm>

#include "dem/law/contact_model.h"
#include "dem/law/kelvin_voigt.h"
#include "dem/law/neck.h"
#include "dem/law/transition.h"

namespace densify::dem {

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

  /// a_max (4.32) [m].
  template <class T>
  T largest_neck(const NormalInputOf<T>& in) const {
    return in.sintering_radius * sine;
  }
  template <class T>
  T smallest_neck(const NormalInputOf<T>& in) const {
    return settings.starting_neck * in.sintering_radius;
  }

  /// eta = pi a^4 / (8 D_eff) (4.40) [N s/m].
  template <class T>
  T viscosity(const T& a) const {
    return (a * a) * (a * a) / mobility_factor;
  }
  /// The same of a contact whose pores may resist.
  template <class T>
  T viscosity(const NormalInputOf<T>& in, const T& a) const {
    return (a * a) * (a * a) / (mobility_factor * in.flow_share);
  }

  /// F_sint = pi gamma (4 r (1 - cos(Psi/2)) + a sin(Psi/2)) (4.36) [N].
  template <class T>
  T sintering_force(const T& a, const T& r) const {
    return std::numbers::pi * surface_energy * (cap * r + a * sine);
  }

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

  /// True for a phase that this step neither begins nor ends, unless update_settled says otherwise.
  bool settled(NeckPhase p) const {
    switch (p) {
      case NeckPhase::loose:
      case NeckPhase::dormant:
        return !active;
      case NeckPhase::sintering:
        return active;
      default:
        return p == NeckPhase::bonded;
    }
  }

  /// Force of this step; advances the neck.  Called for overlapping pairs and for every pair that has a neck.
  NormalForce update(const NormalInput& in, NeckHistory& h) const {
    if (settled(h.phase)) {
      NeckOf<double> neck{h.radius, h.elastic};
      bool turning = false;
      const NormalForce f = update_settled(in, neck,
                                           PhasesOf<bool>{h.phase == NeckPhase::loose, h.phase == NeckPhase::sintering,
                                                          h.phase == NeckPhase::bonded, h.phase == NeckPhase::dormant},
                                           turning);
      if (!turning) {
        h.radius = neck.radius;
        h.elastic = neck.elastic;
        return f;
      }
    }
    return update_turning(in, h);
  }

  /// The same for contacts in settled phases.  `turning` becomes true for those that reach equilibrium or vanish in
  /// this step: they are to be given to `update` instead, as they were before.
  template <class T, class Condition>
  NormalForceOf<T> update_settled(const NormalInputOf<T>& in, NeckOf<T>& neck, const PhasesOf<Condition>& phase,
                                  Condition& turning) const {
    NormalForceOf<T> f;
    if (any(phase.loose)) f = loose.update(in);
    const auto necked = phase.sintering | phase.bonded | phase.dormant;
    if (!any(necked)) return f;
    NeckOf<T> after = neck;
    T middle = neck.radius, f_sint = 0.0;
    Flow<T> flow{0.0, 1.0};
    if (any(phase.sintering)) {
      const T grown = grown_neck(in, neck.radius);
      turning = phase.sintering & ((grown >= largest_neck(in)) | ((in.overlap >= 0) & (grown <= smallest_neck(in))));
      after.radius = select(phase.sintering, grown, neck.radius);
      middle = 0.5 * (neck.radius + after.radius);  // of the step (4.57)
      f_sint = select(phase.sintering, sintering_force(middle, in.sintering_radius), T(0.0));
      flow.mobility = select(phase.sintering, mobility_factor * in.flow_share, flow.mobility);
      flow.per = select(phase.sintering, (middle * middle) * (middle * middle), flow.per);
    }
    if (settings.at_equilibrium == AtEquilibrium::viscous && any(phase.bonded)) {
      flow.mobility = select(phase.bonded, in.flow_share, flow.mobility);
      flow.per = select(phase.bonded, larger(T(settings.viscosity_before), viscosity(middle)), flow.per);
    }
    NormalForceOf<T> g = relax(in, flow, f_sint, after.elastic);
    if (settings.model == SinteringModel::viscous && any(phase.sintering)) {
      g.total = select(phase.sintering, viscosity(in, middle) * in.rate + f_sint, g.total);
      after.elastic = select(phase.sintering, neck.elastic, after.elastic);
    }
    f.total = select(necked, g.total, f.total);
    f.sintering = select(necked, g.sintering, f.sintering);
    neck.radius = after.radius;
    neck.elastic = select(necked, after.elastic, neck.elastic);
    return f;
  }

  /// The constant stiffness that is as near to instability in a step of length dt as spring, damper and dashpot are:
  /// (k + 2 c/dt)/(1 + (theta - 1/2) k dt/eta), 2 eta/dt without a spring; neck and spring are those that the present
  /// rate leads to (see StepStiffness) [N/m].
  double step_stiffness(const NormalInput& in, const NeckHistory& h, double next_step) const {
    // A neck that is about to reach equilibrium or that freezes stiffens within one step.
    const bool soft =
        h.phase == NeckPhase::sintering || h.phase == NeckPhase::activating || h.phase == NeckPhase::reactivating;
    const auto flow = [&](double a2) {
      if (h.phase == NeckPhase::sintering) return Flow<double>{mobility_factor * in.flow_share, a2 * a2};
      return flow_of(series_viscosity(in, h.phase, std::sqrt(a2), activity(h, in.time)));
    };
    return step_stiffness(in, NeckOf<double>{h.radius, h.elastic}, h.phase == NeckPhase::loose, soft, flow, next_step);
  }

  /// The same for contacts in settled phases.
  template <class T, class Condition>
  T step_stiffness(const NormalInputOf<T>& in, const NeckOf<T>& neck, const PhasesOf<Condition>& phase,
                   double next_step) const {
    return step_stiffness(
        in, neck, phase.loose, phase.sintering,
        [&](const T& a2) {
          return Flow<T>{mobility_factor * in.flow_share, a2 * a2};
        },
        next_step);
  }

  Linearisation linearise(const NormalInput& in, const NeckHistory& h) const {
    if (h.phase == NeckPhase::loose) return loose.linearise(in);
    const double share = activity(h, in.time);
    const double k = loose.spring.tangent(h.elastic, in.elastic_radius);
    const double active_force = share > 0 ? share * sintering_force(h.radius, in.sintering_radius) : 0;
    if (settings.model == SinteringModel::viscous && flows(h.phase) && h.phase != NeckPhase::arriving)
      return {std::numeric_limits<double>::infinity(), 0, viscosity(in, h.radius), active_force,
              viscosity(in, h.radius) * in.rate};
    return {k, damper(in, k), series_viscosity(in, h.phase, h.radius, share), active_force,
            loose.spring.force(h.elastic, in.elastic_radius)};
  }

  /// True while the neck grows and flows.
  static bool flows(NeckPhase p) {
    return p == NeckPhase::activating || p == NeckPhase::sintering || p == NeckPhase::arriving ||
           p == NeckPhase::deactivating || p == NeckPhase::reactivating;
  }

 private:
  /// 1/eta as a fraction, mobility/per: one division less.
  template <class T>
  struct Flow {
    T mobility, per;
  };

  static Flow<double> flow_of(double eta) { return std::isinf(eta) ? Flow<double>{0, 1} : Flow<double>{1, eta}; }

  /// `soft` tells which flow, `flow` gives the flow in series for the square of a neck radius.
  template <class T, class Condition, class FlowOf>
  T step_stiffness(const NormalInputOf<T>& in, const NeckOf<T>& neck, const Condition& is_loose, const Condition& soft,
                   const FlowOf& flow, double next_step) const {
    const T approach = larger(T(0.0), -in.rate) * next_step;
    const T k = loose.spring.tangent(neck.elastic - approach, in.elastic_radius);
    T stiffness = k + (2 / next_step) * damper(in, k);
    if (any(soft)) {
      T a2;
      if (settings.neck == NeckGrowth::overlap) {
        NormalInputOf<T> later = in;
        later.overlap = in.overlap - approach;
        const T a = larger(neck_of_overlap(later), smallest_neck(in));
        a2 = a * a;
      } else {
        a2 = neck.radius * neck.radius + 2 * in.sintering_radius * approach;
      }
      if (settings.model == SinteringModel::viscous) {
        stiffness = select(soft, larger(stiffness, (2 / (next_step * (mobility_factor * in.flow_share))) * (a2 * a2)),
                           stiffness);
      } else if (settings.update != MaxwellUpdate::trapezoidal) {
        const T largest = largest_neck(in);
        const Flow<T> f = flow(a2);
        stiffness = select(soft & (a2 < largest * largest),
                           stiffness * f.per / (f.per + (0.5 * next_step) * k * f.mobility), stiffness);
      }
    }
    return any(is_loose) ? select(is_loose, loose.step_stiffness(in, next_step), stiffness) : stiffness;
  }

  /// Advances the elastic displacement by the theta rule for du_e/dt = rate - F(u_e)/eta, one Newton step: theta 1 is
  /// backward Euler (L-stable), 1/2 is (4.67).
  template <class T>
  NormalForceOf<T> relax(const NormalInputOf<T>& in, const Flow<T>& flow, const T& f_sint, T& elastic) const {
    const T k = loose.spring.tangent(elastic, in.elastic_radius);
    const double theta = settings.update == MaxwellUpdate::trapezoidal ? 0.5 : 1.0;
    const T elastic_rate = (flow.per * in.rate - flow.mobility * loose.spring.force(elastic, in.elastic_radius)) /
                           (flow.per + theta * in.step * flow.mobility * k);
    elastic = elastic + in.step * elastic_rate;
    T f = loose.spring.force(elastic, in.elastic_radius);
    // The damper sees the elastic part of the rate only: it stills vibration and adds no viscosity to the flow.
    if (settings.damping_ratio > 0 && in.step > 0) f = f + damper(in, k) * elastic_rate;
    return {f + f_sint, f_sint};
  }

  /// The general update: birth, transitions, equilibrium, loss.
  NormalForce update_turning(const NormalInput& in, NeckHistory& h) const {
    if (h.phase == NeckPhase::loose) {
      if (!active) return loose.update(in);
      if (!activation_step && in.step > 0) return born(in, h);
      begin(in, h);
      const double share = activity(h, in.time);
      const double f_sint = share > 0 ? share * sintering_force(h.radius, in.sintering_radius) : 0;
      const double f = settings.model == SinteringModel::viscous ? viscosity(in, h.radius) * in.rate
                                                                 : loose.spring.force(h.elastic, in.elastic_radius);
      return {f + f_sint, f_sint};
    }
    change_phase(in, h);
    double neck = h.radius;  // at the middle of the step (4.57)
    if (flows(h.phase)) {
      h.radius = grown_neck(in, h.radius);
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
      return {viscosity(in, neck) * in.rate + f_sint, f_sint};
    Flow<double> flow{mobility_factor * in.flow_share, (neck * neck) * (neck * neck)};
    if (h.phase != NeckPhase::sintering) flow = flow_of(series_viscosity(in, h.phase, neck, share));
    return relax(in, flow, f_sint, h.elastic);
  }

  double progress(const NeckHistory& h, double time) const {
    return settings.relaxation_time > 0 ? std::clamp((time - h.since) / settings.relaxation_time, 0.0, 1.0) : 1.0;
  }

  /// Enters a phase with a part of its transition already behind it, so that a turn in mid-transition makes no jump.
  void enter(NeckHistory& h, NeckPhase phase, double time, double done) const {
    h.phase = phase;
    h.since = time - done * settings.relaxation_time;
  }

  template <class T>
  T damper(const NormalInputOf<T>& in, const T& k) const {
    if (!(settings.damping_ratio > 0)) return 0.0;
    return 2 * settings.damping_ratio * root(in.reduced_mass * k);
  }

  /// Dashpot in series with the spring (4.47, 4.51), behind closing pores.
  double series_viscosity(const NormalInput& in, NeckPhase phase, double a, double share) const {
    return series_viscosity(phase, a, share) / in.flow_share;
  }

  /// Without pores; eta_inf is never below the theory's viscosity.
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

  template <class T>
  T neck_of_overlap(const NormalInputOf<T>& in) const {
    const T r = in.sintering_radius, rest = r + 0.5 * in.overlap;
    return select(in.overlap < 0, 1.43 * root(larger(T(0.0), r * r - rest * rest)), T(0.0));
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

  /// A contact that met within the step starts where the surfaces touched, with a small neck and no force, and lives
  /// through the rest of the step: what it is at the end does not depend on where steps begin.
  NormalForce born(const NormalInput& in, NeckHistory& h) const {
    NormalInput rest = in;
    if (in.rate < 0) rest.step = std::min(in.step, in.overlap / in.rate);
    h = {smallest_neck(in), 0, in.time - rest.step, NeckPhase::sintering};
    return update(rest, h);
  }

  /// a' = -r v / a (4.31) as a^2 - 2 r v dt (4.58), or the overlap's own neck; between a small neck and a_max.
  template <class T>
  T grown_neck(const NormalInputOf<T>& in, const T& before) const {
    const T a = settings.neck == NeckGrowth::overlap
                    ? neck_of_overlap(in)
                    : root(larger(T(0.0), before * before - 2 * in.sintering_radius * in.rate * in.step));
    return smaller(larger(a, smallest_neck(in)), largest_neck(in));
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
    h.elastic = loose.spring.displacement(viscosity(in, h.radius) * in.rate + sintering, in.elastic_radius);
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
