#pragma once
// The contact pass: every contact's law, then the sum over each particle's contacts in one fixed order.

#include <type_traits>

#include "dem/contact/near_list.h"
#include "dem/contact/step_stiffness.h"
#include "dem/material/pair_table.h"

namespace densify::dem {

/// The clock of one pass.
struct PassTime {
  double time;  ///< process time [s]
  double step;  ///< time since the last pass, 0 at the first [s]
};

/// What one contact did in a recorded pass; zero for pairs that do not touch.
struct ContactRecord {
  Vec3 force = Vec3::Zero();        ///< on particle i [N]
  Vec3 couple = Vec3::Zero();       ///< n x F_t; times the lever of i or j it is the torque on i or j [N]
  double lever_i = 0, lever_j = 0;  ///< centre to contact point [m]
  double normal = 0;                ///< normal force, tension positive [N]
  double sintering = 0;             ///< F_sint in it [N]
  double damping = 0;               ///< damper force in it [N]
  double elastic_energy = 0;        ///< stored in the normal spring [J]
  bool touching = false;
};

/// Computes forces (and torques) of all pairs into Particles::force (::torque), overwriting them.
///
/// `expansion_step[m]` is the relative growth of the radius of material m since the last pass, (r_new - r_old)/r_new.
/// With `record` given the pass also fills it, one entry a pair, and with `stiffness` given its sums for its next_step;
/// forces are bit for bit the same with and without them, and all is for every number of threads.
class ForcePass {
 public:
  ForcePass(const ContactModel& model, int threads) : model_(model), threads_(threads) {}

  void compute(Particles&, ContactList&, const Cell&, const PairTable&, const std::vector<double>& expansion_step,
               PassTime, std::vector<ContactRecord>* record, StepStiffness* stiffness);

  /// To be called after every rebuild of the list; the next passes visit all its pairs until near() is pruned.
  void list_changed(const ContactList&, std::size_t particles);

  /// The pairs that the passes visit; who prunes it must prune again before its travel() reaches its skin().
  NearList& near() { return near_; }
  /// To be called after pruning.
  void near_changed(const ContactList&, std::size_t particles);

  const ContactModel& model() const { return model_; }
  int threads() const { return threads_; }
  std::size_t bytes() const;

 private:
  /// What a particle's sum needs of one pair.
  struct Share {
    Vec3 force, couple;
    double lever_i, lever_j;
  };
  struct ShareSink;

  template <class Law>
  void run_bucket(const Law&, std::size_t bucket, Particles&, ContactList&, const Cell&,
                  const std::vector<double>& expansion_step, PassTime, std::vector<ContactRecord>* record,
                  StepStiffness* stiffness);
  void add_recorded(Particles&, const ContactList&, const std::vector<ContactRecord>&);
  void gather(Particles&, StepStiffness* stiffness) const;

  ContactModel model_;
  int threads_;
  NearList near_;
  std::optional<ImageShifts> shifts_;  // of the cell below
  Mat3 shifts_h_ = Mat3::Zero();       // [m]
  // Several threads only:
  std::vector<Share> shares_;                     // of each near pair
  std::vector<StiffnessShare> stiffness_shares_;  // only when asked for
  std::vector<std::uint32_t> incidence_;          // near pair << 1 | side, ascending for each particle
  std::vector<std::size_t> incidence_begin_;
};

/// The normal law of a bucket at the present temperature, for callers outside the hot loop.
template <class Spring>
Spring make_spring(const ContactModel&, const PairProperties&);
template <>
inline LinearSpring make_spring(const ContactModel& m, const PairProperties&) {
  return {m.normal_stiffness};
}
template <>
inline HertzSpring make_spring(const ContactModel& m, const PairProperties& p) {
  return {p.four_thirds_modulus, m.sintering ? m.sintering->tension_floor : 0.0};
}

template <class Spring>
SinteringContact<Spring> make_sintering(const ContactModel& m, const PairProperties& p) {
  const KelvinVoigt<Spring> loose{make_spring<Spring>(m, p), m.damping_ratio};
  return {loose, *m.sintering, p.mobility_factor, p.surface_energy, p.cap, p.sine, p.active, p.activation_step};
}

/// True for the laws whose contacts carry a neck.
template <class Law>
inline constexpr bool has_necks =
    !std::is_same_v<Law, KelvinVoigt<LinearSpring>> && !std::is_same_v<Law, KelvinVoigt<HertzSpring>>;

/// Calls visit(spring) with a value of the spring type that the model asks for.
template <class Visit>
decltype(auto) with_spring(const ContactModel& m, const PairProperties& p, Visit&& visit) {
  return m.elasticity == Elasticity::linear ? visit(make_spring<LinearSpring>(m, p))
                                            : visit(make_spring<HertzSpring>(m, p));
}

/// Radius of the Hertz stiffness of two spheres [m].
inline double elastic_radius(const ContactModel& m, double ri, double rj) {
  return (m.hertz_radius == HertzRadius::equivalent ? 2 : 1) * ri * rj / (ri + rj);
}

/// Radius of neck and sintering force of two spheres (4.33) [m].
inline double sintering_radius(SinteringRadius kind, double ri, double rj) {
  return kind == SinteringRadius::smaller ? std::min(ri, rj) : 2 * ri * rj / (ri + rj);
}

/// The input of the normal law of pair k, for callers outside the hot loop (time step limits, network, checks).
NormalInput normal_input(const ContactModel&, const Particles&, const ContactList&, const Cell&,
                         const std::vector<double>& expansion_step, PassTime, std::size_t k);

}  // namespace densify::dem
