#include "dem/integrate/step_control.h"

#include <Eigen/LU>
#include <numbers>

namespace densify::dem {

Mat3 fitted_strain_rate(const Particles& particles, const Cell& cell) {
  const double n = double(particles.size());
  Vec3 centre = Vec3::Zero(), drift = Vec3::Zero();
  for (const Body& b : particles.body) {
    centre += b.position;
    drift += b.velocity;
  }
  centre /= n;
  drift /= n;
  Mat3 spread = Mat3::Zero(), flow = Mat3::Zero();
  for (const Body& b : particles.body) {
    const Vec3 x = b.position - centre;
    spread += x * x.transpose();
    flow += (b.velocity - drift) * x.transpose();
  }
  // Few particles, or all in one plane or line, fix the rate in the directions that they span only.
  const double floor = 1e-6 * spread.trace();
  Mat3 rate = floor > 0 ? Mat3(flow * (spread + floor * Mat3::Identity()).inverse()) : Mat3(Mat3::Zero());
  if (cell.periodic) rate += cell.velocity_gradient;
  return 0.5 * (rate + rate.transpose());
}

double contact_pressure(const Particles& particles, const StepStiffness& sums) {
  double work = 0, volume = 0;
  for (std::size_t p = 0; p < particles.size(); ++p) {
    const double r = particles.body[p].radius;
    work += sums.of[p].force * r;
    volume += 4.0 / 3 * std::numbers::pi * r * r * r;
  }
  return work / (3 * volume);
}

void measure_inertia(ControlState& state, const Particles& particles, const Cell& cell, double pressure) {
  constexpr double memory = 4;  // control intervals
  state.strain_rate += (fitted_strain_rate(particles, cell) - state.strain_rate) / memory;
  double mass = 0, volume = 0, diameter = 0;
  for (const Body& b : particles.body) {
    mass += 1 / b.inverse_mass;
    volume += 4.0 / 3 * std::numbers::pi * b.radius * b.radius * b.radius;
    diameter += 2 * b.radius;
  }
  diameter /= double(particles.size());
  const double rate = state.strain_rate.norm();
  state.inertial_number = rate > 0 ? rate * diameter * std::sqrt(mass / volume / pressure) : 0;
}

double controlled_step(const StepControl& control, const ControlState& state, double step) {
  constexpr double least = 0.8, most = 1.1;  // a control interval: 4 % down and 2 % up a step
  const double wanted = state.inertial_number > 0 ? control.measure / state.inertial_number : most;
  return std::clamp(step * std::clamp(wanted, least, most), control.smallest_step, control.largest_step);
}

}  // namespace densify::dem
