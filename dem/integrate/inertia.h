#pragma once
// Equalised inertia: every particle gets the mass that a wanted step needs, instead of a step that the lightest and
// stiffest particle dictates.

#include "dem/contact/step_stiffness.h"
#include "dem/material/pair_table.h"

namespace densify::dem {

enum class Inertia : std::uint8_t {
  uniform,   ///< the scaled real mass of every particle (4.80); the step follows
  equalised  ///< the step is chosen; every particle's mass follows
};

/// The mass that a node needs for a step dt against the stiffness k of StepStiffness, k dt^2/(2 s^2) with the step
/// safety s; s = 1 is the limit of node_limit [kg].
inline double mass_for_step(double stiffness, double step, double safety) {
  return 0.5 * stiffness * step * step / (safety * safety);
}

/// What a particle of radius r that is about to touch must be ready for: its own contact with a like one at an overlap
/// of 0.1 r, dampers and friction included [N/m].
double first_contact_stiffness(const ContactModel&, const PairProperties& like, double radius, double step,
                               double safety);

/// Gives every particle the mass (1 + e) max(largest eigenvalue of its sum, first contact) dt^2/(2 s^2), dt =
/// sums.next_step, e the carriage_share that a column moved by a punch needs and 0 without.  Velocities stay: what
/// moves as one body goes on as it did, and the impulses of a step still cancel over every contact, while momentum
/// changes by the sum of dm v.
void equalise(Particles&, const StepStiffness& sums, const ContactModel&, const PairTable&, double safety, double share,
              int threads);

/// The uniform compaction of a column between a fixed bottom and a punch as a degree of freedom of its own.
///
/// Masses that suit a long step are heavy, and a column of them hardly follows a punch: its own weight against every
/// change of the densification rate, rho' h^2 d(rate)/dt, is a pressure that grows with (h/d)^2.  So the powder's
/// inertia counts relative to the uniform compaction only: x_i = x'_i + zeta_i q e_z with zeta_i the height over that
/// of the column, and the punch at z' + q with a light mass of its own, so that it stays in balance with what it
/// touches. The force on q is that on the punch plus the sum of F_iz zeta_i, which vanishes at rest: nothing static
/// changes.
struct Column {
  double bottom, height;  ///< [m]
  double inverse_height = 1 / height;
  double zeta(const Body& b) const { return std::clamp((b.position[2] - bottom) * inverse_height, 0.0, 1.0); }
};

/// e in the masses of a column: a contact's stretch is n.(x'_j - x'_i) + s q with s = n_z (zeta_j - zeta_i), and its
/// square at most (1 + e) n.(x'_j - x'_i)^2 + (1 + 1/e) s^2 q^2, so that particles of (1 + e) times the mass and a
/// column with (1 + 1/e) times half the mass_for_step of sum k s^2 are stable together.
inline constexpr double carriage_share = 0.1;

/// What the column needs when the particles have their masses (1 + e) k_i dt^2/(2 s^2): sum k s^2 is at most 2 sum_i
/// k_i r_i^2/h^2, which makes sum_i m_i r_i^2/(e h^2).  With their readiness for a first contact: a column that has
/// lost its contacts must not be thrown [kg].
double column_mass(const Particles&, const Column&);
/// sum F_iz zeta_i [N].
double column_force(const Particles&, const Column&);
/// Adds zeta_i times a change of the punch's velocity to the particles.
void carry(Particles&, const Column&, double velocity_change, int threads);

}  // namespace densify::dem
