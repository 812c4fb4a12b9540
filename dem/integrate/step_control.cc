#include "dem/integrate/step_control.h"

#include <Eigen/LU>
#include <numbers>

namespace densify::dem {

UniformFlow fitted_flow(const Particles& particles) {
  const double n = double(particles.size());
  UniformFlow f;
  for (const Body& b : particles.body) {
    f.centre += b.position;
    f.velocity += b.velocity;
  }
  f.centre /= n;
  f.velocity /= n;
  Mat3 spread = Mat3::Zero(), flow = Mat3::Zero();
  for (const Body& b : particles.body) {
    const Vec3 x = b.position - f.centre;
    spread += x * x.transpose();
    flow += (b.velocity - f.velocity) * x.transpose();
  }
  // Few particles, or all in one plane or line, fix the rate in the directions that they span only.
  const double floor = 1e-6 * spread.trace();
  if (floor > 0) f.gradient = flow * (spread + floor * Mat3::Identity()).inverse();
  return f;
}

void calm(Particles& particles, double share) {
  const UniformFlow f = fitted_flow(particles);
  for (Body& b : particles.body) {
    const Vec3 flow = f.velocity + f.gradient * (b.position - f.centre);
    b.velocity = flow + share * (b.velocity - flow);
  }
  for (Vec3& w : particles.angular_velocity) w *= share;
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
  Mat3 rate = fitted_flow(particles).gradient;
  if (cell.periodic) rate += cell.velocity_gradient;
  state.strain_rate += (0.5 * (rate + rate.transpose()) - state.strain_rate) / memory;
  double mass = 0, volume = 0, diameter = 0;
  for (const Body& b : particles.body) {
    mass += 1 / b.inverse_mass;
    volume += 4.0 / 3 * std::numbers::pi * b.radius * b.radius * b.radius;
    diameter += 2 * b.radius;
  }
  diameter /= double(particles.size());
  const double size = state.strain_rate.norm();
  state.inertial_number = size > 0 ? size * diameter * std::sqrt(mass / volume / pressure) : 0;
}

double controlled_step(const StepControl& control, const ControlState& state, double step) {
  constexpr double least = 0.8, most = 1.1;  // a control interval: 4 % down and 2 % up a step
  const double wanted = state.inertial_number > 0 ? control.measure / state.inertial_number : most;
  return std::clamp(step * std::clamp(wanted, least, most), control.smallest_step, control.largest_step);
}

}  // namespace densify::dem
