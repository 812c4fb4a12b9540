#include "dem/integrate/leapfrog.h"

namespace densify::dem {

void kick(Particles& particles, double step, double drag, int threads) {
  const auto n = std::ptrdiff_t(particles.size());
  const bool rotates = !particles.torque.empty();
  const double kept = 1 / (1 + drag * step);
#pragma omp parallel for num_threads(threads) if (threads > 1) schedule(static)
  for (std::ptrdiff_t q = 0; q < n; ++q) {
    const auto p = std::size_t(q);
    Body& b = particles.body[p];
    b.velocity += (b.inverse_mass * step) * particles.force[p];
    if (drag > 0) b.velocity *= kept;
    if (!rotates) continue;
    particles.angular_velocity[p] += (2.5 * b.inverse_mass / (b.radius * b.radius) * step) * particles.torque[p];
    if (drag > 0) particles.angular_velocity[p] *= kept;
  }
}

void drift(Particles& particles, Cell& cell, double step, int threads) {
  const auto n = std::ptrdiff_t(particles.size());
  const bool deforming = cell.periodic && !cell.velocity_gradient.isZero(0);
  const Mat3 flow = step * cell.velocity_gradient;
#pragma omp parallel for num_threads(threads) if (threads > 1) schedule(static)
  for (std::ptrdiff_t q = 0; q < n; ++q) {
    Body& b = particles.body[std::size_t(q)];
    if (deforming) b.position += flow * (b.position - cell.origin);
    b.position += step * b.velocity;
  }
  if (deforming) cell.h += flow * cell.h;
}

}  // namespace densify::dem
