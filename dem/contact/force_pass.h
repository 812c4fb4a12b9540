#pragma once
// The contact pass: every contact's law, then the sum over each particle's contacts in one fixed order.

#include <array>
#include <variant>

#include "dem/contact/chunks.h"
#include "dem/contact/kernel.h"
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
  double normal = 0;                ///< normal force, tension positive [N]
  Vec3 couple = Vec3::Zero();       ///< n x F_t; times the lever of i or j it is the torque on i or j [N]
  double sintering = 0;             ///< F_sint in the normal force [N]
  double lever_i = 0, lever_j = 0;  ///< centre to contact point, with friction [m]
  double damping = 0;               ///< damper force in the normal force [N]
  double elastic_energy = 0;        ///< stored in the normal spring [J]
  bool touching = false;
};

/// Computes forces (and torques) of all pairs into Particles::force (::torque), overwriting them.
///
/// `expansion_step[m]` is the relative growth of the radius of material m since the last pass, (r_new - r_old)/r_new.
/// With `record` given the pass also fills it, one entry a pair, and with `stiffness` given its sums for its next_step;
/// forces are bit for bit the same with and without them, and all is for every number of threads and with all kernels.
class ForcePass {
 public:
  ForcePass(const ContactModel& model, int threads, const KernelTable& kernels = chosen_kernels())
      : model_(model), threads_(threads), kernels_(&kernels) {}

  void compute(Particles&, ContactList&, const Cell&, const PairTable&, const std::vector<double>& expansion_step,
               PassTime, std::vector<ContactRecord>* record, StepStiffness* stiffness);

  /// From the next rebuild on virial() is there.
  void keep_virial() { images_apart_ = true; }
  /// sum F (x) b over the contacts, F on i, b from i to j: by the resultants and by the forces through the faces of the
  /// cell.  Right after compute(), before other forces are added. [N m]
  Mat3 virial(const Particles&, const Cell&) const;

  /// What the contacts of the next passes meet.
  void set_pores(const PoreClosure& pores) { pores_ = pores; }

  /// To be called after every rebuild of the list; the next passes visit all its pairs until near() is pruned.
  void list_changed();

  /// The pairs that the passes visit; who prunes it must prune again before particles have travelled its skin.
  NearList& near() { return near_; }
  const NearList& near() const { return near_; }
  const Chunks& chunks() const { return chunks_; }
  /// To be called after pruning.
  void near_changed(const ContactList&, std::size_t particles);

  const ContactModel& model() const { return model_; }
  int threads() const { return threads_; }
  std::size_t bytes() const;

 private:
  using Law = std::variant<KelvinVoigt<LinearSpring>, KelvinVoigt<HertzSpring>, SinteringContact<LinearSpring>,
                           SinteringContact<HertzSpring>>;
  /// A bucket of this pass.
  struct Bucket {
    KernelJob job;
    Law law;
  };

  void prepare(Particles&, ContactList&, const Cell&, const PairTable&, const std::vector<double>& expansion_step,
               PassTime, std::vector<ContactRecord>*, const StepStiffness*);
  void run_chunk(std::size_t chunk, Particles&, std::vector<double>& sums, StepStiffness*);
  void add_incoming(std::size_t chunk, Particles&, StepStiffness*) const;

  ContactModel model_;
  int threads_;
  bool images_apart_ = false;
  PoreClosure pores_;
  const KernelTable* kernels_;
  NearList near_;
  Chunks chunks_;
  std::array<double, 4 * 27> shifts_{};  // of the image codes in the cell below [m]
  Mat3 shifts_h_ = Mat3::Zero();         // [m]
  std::vector<Bucket> buckets_;
  std::vector<std::vector<double>> sums_;  // of the chunk at work, for each thread
  std::vector<double> for_others_;         // forces (and torques) of chunks on particles of other chunks
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

/// Calls visit(spring) with a value of the spring type that the model asks for.
template <class Visit>
decltype(auto) with_spring(const ContactModel& m, const PairProperties& p, Visit&& visit) {
  return m.elasticity == Elasticity::linear ? visit(make_spring<LinearSpring>(m, p))
                                            : visit(make_spring<HertzSpring>(m, p));
}

/// Calls visit(law) with the law of a pair: of loose particles, or one with necks where the list holds any.
template <class Visit>
decltype(auto) with_law(const ContactModel& m, const PairProperties& p, bool necks, Visit&& visit) {
  return with_spring(m, p, [&](const auto& spring) -> decltype(auto) {
    using Spring = std::decay_t<decltype(spring)>;
    return necks ? visit(make_sintering<Spring>(m, p)) : visit(KelvinVoigt<Spring>{spring, m.damping_ratio});
  });
}

/// Radius of the Hertz stiffness of two spheres [m].
inline double elastic_radius(const ContactModel& m, double ri, double rj) {
  return (m.hertz_radius == HertzRadius::equivalent ? 2 : 1) * ri * rj / (ri + rj);
}

/// Radius of neck and sintering force of two spheres (4.33) [m].
inline double sintering_radius(SinteringRadius kind, double ri, double rj) {
  return kind == SinteringRadius::smaller ? std::min(ri, rj) : 2 * ri * rj / (ri + rj);
}

}  // namespace densify::dem
