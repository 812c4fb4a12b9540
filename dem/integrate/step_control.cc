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
  double spread[6] = {}, flow[9] = {};  // sums of x x^T (xx, yy, zz, xy, xz, yz) and v x^T (by rows)
  for (const Body& b : particles.body) {
    const double x = b.position[0] - f.centre[0], y = b.position[1] - f.centre[1], z = b.position[2] - f.centre[2];
    const double u = b.velocity[0] - f.velocity[0], v = b.velocity[1] - f.velocity[1],
                 w = b.velocity[2] - f.velocity[2];
    const double xx[6] = {x * x, y * y, z * z, x * y, x * z, y * z};
    const double vx[9] = {u * x, u * y, u * z, v * x, v * y, v * z, w * x, w * y, w * z};
    for (int k = 0; k < 6; ++k) spread[k] += xx[k];
    for (int k = 0; k < 9; ++k) flow[k] += vx[k];
  }
  Mat3 s;
  s << spread[0], spread[3], spread[4], spread[3], spread[1], spread[5], spread[4], spread[5], spread[2];
  // Few particles, or all in one plane or line, fix the rate in the directions that they span only.
  const double floor = 1e-6 * s.trace();
  if (floor > 0)
    f.gradient =
        Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(flow) * (s + floor * Mat3::Identity()).inverse();
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

void measure_inertia(ControlState& state, const Particles& particles, const Cell& cell, double pressure,
                     double growth) {
  constexpr double memory = 4;  // control intervals
  Mat3 rate = fitted_flow(particles).gradient;
  if (cell.periodic) rate += cell.velocity_gradient;
  rate -= growth * Mat3::Identity();
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

double schedule_limit(const StepControl& control, const Schedule& schedule, ProcessLoad load, double time, double step,
                      bool loose) {
  constexpr double transition_steps = 60, flow_share = 0.01, share_of_pressure = 0.05, least_pressure = 0.002;
  double limit = control.largest_step;
  const double rate = load.rate;
  if (rate > 0) {
    limit = std::min(limit, share_of_pressure * std::max(load.size, least_pressure * control.peak_pressure) / rate);
    if (loose) limit = std::min(limit, control.peak_pressure / (control.load_steps * rate));
  }
  const double before = schedule.temperature(std::max(0.0, time - control.transition)),
               soon = schedule.temperature(time + 2 * step),
               nearly = schedule.temperature(std::max(0.0, time + 2 * step - (1 - flow_share) * control.transition));
  for (const double activation : control.activation_temperatures) {
    if (control.transition > 0 && (before < activation) != (soon < activation))
      limit = std::min(limit, control.transition / transition_steps);
    if (control.flow_step > 0 && before < activation && nearly >= activation)
      limit = std::min(limit, control.flow_step);
  }
  return std::max(limit, control.smallest_step);
}

}  // namespace densify::dem
