// The forces of one step by the shortest way to write them down: every particle with every other.

#include <Eigen/Geometry>
#include <map>

#include "app/bench_job.h"
#include "dem/law/friction.h"

namespace densify::app {

namespace {

using namespace dem;

struct Forces {
  std::vector<Vec3> force, torque;
  double largest_force = 0, largest_torque = 0;  // of one contact: resultants at rest are rounding of them

  void add(std::uint32_t i, std::uint32_t j, const Vec3& f) {
    force[i] += f;
    force[j] -= f;
    largest_force = std::max(largest_force, f.norm());
  }
  void turn(std::uint32_t i, const Vec3& t) {
    torque[i] += t;
    largest_torque = std::max(largest_torque, t.norm());
  }
};

/// Histories before the step, by pair; the packings are wide enough for one image of each.
using Places = std::map<std::pair<std::uint32_t, std::uint32_t>, std::size_t>;

NormalInput input_of(const Body& a, const Body& b, const Vec3& branch, PassTime clock) {
  const double d = branch.norm(), equivalent = 2 * a.radius * b.radius / (a.radius + b.radius);
  return {d - a.radius - b.radius,
          (b.velocity - a.velocity).dot(branch) / d,
          equivalent,
          equivalent,
          1 / (a.inverse_mass + b.inverse_mass),
          clock.step,
          clock.time};
}

Forces plain_forces(const Setup& setup, const PairTable& table, State& state) {
  const std::size_t n = state.particles.size();
  Forces sum{std::vector<Vec3>(n, Vec3::Zero()), std::vector<Vec3>(n, Vec3::Zero()), 0, 0};
  const auto& spin = state.particles.angular_velocity;
  const PassTime clock{state.time, state.last_step};
  const KelvinVoigt<LinearSpring> loose{{setup.contact.normal_stiffness}, setup.contact.damping_ratio};
  Places place;
  for (std::size_t k = 0; k < state.contacts.size(); ++k) place[{state.contacts.i(k), state.contacts.j(k)}] = k;

  const Mat3 to_fraction = state.cell.h.inverse();
  for (std::uint32_t i = 0; i < n; ++i)
    for (std::uint32_t j = i + 1; j < n; ++j) {
      const Body &a = state.particles.body[i], &b = state.particles.body[j];
      Vec3 s = to_fraction * (b.position - a.position);
      for (double& x : s) x -= std::round(x);
      const Vec3 branch = state.cell.h * s;
      const double reach = a.radius + b.radius;
      const bool touching = branch.squaredNorm() < reach * reach;
      const auto found = touching || !state.contacts.neck.empty() ? place.find({i, j}) : place.end();
      NeckHistory no_neck;
      NeckHistory& neck =
          found == place.end() || state.contacts.neck.empty() ? no_neck : state.contacts.neck[found->second];
      if (!touching && neck.phase == NeckPhase::loose) continue;

      const NormalInput in = input_of(a, b, branch, clock);
      const Vec3 normal = branch.normalized();
      const double f = setup.contact.sintering
                           ? make_sintering<LinearSpring>(setup.contact, table.row(0, 0)).update(in, neck).total
                           : loose.update(in).total;
      sum.add(i, j, f * normal);
      if (!setup.contact.friction) continue;
      Vec3 no_slip = Vec3::Zero();
      Vec3& slip = found == place.end() ? no_slip : state.contacts.tangential[found->second];
      const double arm_i = a.radius + 0.5 * in.overlap, arm_j = b.radius + 0.5 * in.overlap;
      const Vec3 v = b.velocity - arm_j * spin[j].cross(normal) - a.velocity - arm_i * spin[i].cross(normal);
      const Vec3 ft = coulomb(
          *setup.contact.friction, setup.contact.friction->coefficient,
          {normal, v - v.dot(normal) * normal, std::max(0.0, -f), loose.spring.stiffness, in.reduced_mass, clock.step},
          slip);
      sum.add(i, j, ft);
      sum.turn(i, (arm_i * normal).cross(ft));
      sum.turn(j, (arm_j * normal).cross(ft));
    }
  return sum;
}

/// Largest difference over `size`.
double deviation(const std::vector<Vec3>& expected, const std::vector<Vec3>& found, double size) {
  double difference = 0;
  for (std::size_t p = 0; p < found.size(); ++p) difference = std::max(difference, (found[p] - expected[p]).norm());
  return size > 0 ? difference / size : difference;
}

}  // namespace

double force_deviation(dem::Simulation& simulation) {
  State before = simulation.state();
  simulation.evaluate(nullptr);
  const Forces plain = plain_forces(simulation.setup(), simulation.table(), before);
  const Particles& now = simulation.state().particles;
  return std::max(deviation(plain.force, now.force, plain.largest_force),
                  deviation(plain.torque, now.torque, plain.largest_torque));
}

}  // namespace densify::app
