#include "dem/integrate/inertia.h"

#include "dem/contact/force_pass.h"
#include "dem/law/friction.h"
#include "dem/parallel.h"

namespace densify::dem {

double first_contact_stiffness(const ContactModel& model, const PairProperties& like, double radius, double step,
                               double safety) {
  constexpr double overlap = 0.1;  // over the radius
  const double k = with_spring(model, like, [&](const auto& s) { return s.tangent(-overlap * radius, radius); });
  // Two such masses, m = k dt^2/(2 s^2), have the reduced mass m/2, and c = 2 xi sqrt(m k/2) is xi k dt/s.
  const double ratio =
      model.sintering ? std::max(model.damping_ratio, model.sintering->damping_ratio) : model.damping_ratio;
  double stiffness = k * (1 + 2 * ratio / safety);
  if (model.friction)
    stiffness =
        std::max(stiffness, tangential_step_stiffness(*model.friction, k, 0.5 * mass_for_step(k, step, safety), step));
  return stiffness;
}

void equalise(Particles& particles, const StepStiffness& sums, const ContactModel& model, const PairTable& table,
              double safety, double share, int threads) {
  // Every spring's stiffness goes with the radius, or does not depend on it.
  std::vector<double> first(table.materials()), per_radius(table.materials());
  for (std::uint8_t m = 0; m < first.size(); ++m) {
    const double one = first_contact_stiffness(model, table.row(m, m), 1, sums.next_step, safety);
    (model.elasticity == Elasticity::hertz ? per_radius : first)[m] = one;
  }
  const double softness = 1 / mass_for_step(1 + share, sums.next_step, safety);
  in_parts(particles.size(), threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p) {
      Body& b = particles.body[p];
      const std::uint8_t m = particles.material[p];
      const double k = std::max(sums.of[p].largest_eigenvalue(), first[m] + per_radius[m] * b.radius);
      b.inverse_mass = softness / k;
    }
  });
}

double column_mass(const Particles& particles, const Column& column) {
  double sum = 0;
  for (const Body& b : particles.body) sum += b.radius * b.radius / b.inverse_mass;
  return sum / (carriage_share * column.height * column.height);
}

double column_force(const Particles& particles, const Column& column) {
  double sum = 0;  // in one order for every number of threads
  for (std::size_t p = 0; p < particles.size(); ++p) sum += particles.force[p][2] * column.zeta(particles.body[p]);
  return sum;
}

void carry(Particles& particles, const Column& column, double velocity_change, int threads) {
  in_parts(particles.size(), threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p)
      particles.body[p].velocity[2] += column.zeta(particles.body[p]) * velocity_change;
  });
}

}  // namespace densify::dem
