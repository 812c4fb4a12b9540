#include "dem/integrate/leapfrog.h"

#include <cmath>

#include "dem/parallel.h"

namespace densify::dem {

namespace {

void kick_spins(Particles& particles, double step, double kept, std::size_t begin, std::size_t end) {
  for (std::size_t p = begin; p < end; ++p) {
    const Body& b = particles.body[p];
    particles.angular_velocity[p] += (2.5 * b.inverse_mass / (b.radius * b.radius) * step) * particles.torque[p];
    particles.angular_velocity[p] *= kept;
  }
}

}  // namespace

double leapfrog(Particles& particles, Cell& cell, LeapfrogSteps steps, double drag, int threads) {
  const bool rotates = !particles.torque.empty();
  const double kept = 1 / (1 + drag * steps.kick);
  const bool deforming = cell.periodic && !cell.velocity_gradient.isZero(0);
  const Mat3 flow = steps.drift * cell.velocity_gradient;
  const Vec3 origin = cell.origin;
  const double fastest = largest_of_parts(particles.size(), threads, [&](std::size_t begin, std::size_t end) {
    if (rotates) kick_spins(particles, steps.kick, kept, begin, end);
    Body* const body = particles.body.data();
    const Vec3* const force = particles.force.data();
    double largest = 0, sum = 0;  // the sum is not finite when any velocity is not
    for (std::size_t p = begin; p < end; ++p) {
      Body& b = body[p];
      b.velocity = kept * (b.velocity + (b.inverse_mass * steps.kick) * force[p]);
      if (deforming) b.position += flow * (b.position - origin);
      b.position += steps.drift * b.velocity;
      const double v2 = b.velocity.squaredNorm();
      largest = std::max(largest, v2);
      sum += v2;
    }
    return std::isfinite(sum) ? largest : std::numeric_limits<double>::infinity();
  });
  if (deforming) cell.h += flow * cell.h;
  return std::sqrt(fastest);
}

}  // namespace densify::dem
