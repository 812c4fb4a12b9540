#include "dem/io/snapshot.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

namespace densify::dem {

namespace {

/// From particle i of pair k to particle j or its image [m].
Vec3 branch_of(const State& s, std::size_t k) {
  const Vec3 between = s.particles.body[s.contacts.j(k)].position - s.particles.body[s.contacts.i(k)].position;
  return s.cell.periodic ? Vec3(between + s.cell.shift(s.contacts.image(k))) : between;
}

void add_symmetric(Stress& sum, const Vec3& arm, const Vec3& force) {
  constexpr int row[6] = {0, 1, 2, 1, 0, 0}, column[6] = {0, 1, 2, 2, 2, 1};
  for (int c = 0; c < 6; ++c) sum[c] += 0.5 * (arm[row[c]] * force[column[c]] + arm[column[c]] * force[row[c]]);
}

void take_particles(Snapshot& shot, const State& s, const Recording& recording) {
  const Particles& p = s.particles;
  std::vector<std::uint32_t> order(p.size());
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(), [&](auto a, auto b) { return p.id[a] < p.id[b]; });
  const auto stress = particle_stresses(s, recording);
  std::vector<std::uint32_t> coordination(p.size(), 0);
  for (std::size_t k = 0; k < s.contacts.size(); ++k)
    if (recording.contact[k].touching) ++coordination[s.contacts.i(k)], ++coordination[s.contacts.j(k)];
  for (const auto q : order) {
    shot.id.push_back(p.id[q]);
    shot.material.push_back(p.material[q]);
    shot.position.push_back(p.body[q].position);
    shot.radius.push_back(p.body[q].radius);
    shot.velocity.push_back(p.body[q].velocity);
    if (shot.has_friction) shot.angular_velocity.push_back(p.angular_velocity[q]);
    shot.stress.push_back(stress[q]);
    shot.coordination.push_back(coordination[q]);
  }
}

void take_contacts(Snapshot& shot, const State& s, const Recording& recording) {
  const ContactList& list = s.contacts;
  for (std::size_t k = 0; k < list.size(); ++k) {
    const ContactRecord& record = recording.contact[k];
    if (!record.touching) continue;
    const Body &a = s.particles.body[list.i(k)], &b = s.particles.body[list.j(k)];
    const Vec3 branch = branch_of(s, k);
    const double distance = branch.norm();
    shot.first_id.push_back(s.particles.id[list.i(k)]);
    shot.second_id.push_back(s.particles.id[list.j(k)]);
    if (s.cell.periodic) shot.image.push_back(list.image(k));
    shot.start.push_back(a.position);
    shot.branch.push_back(branch);
    shot.overlap.push_back(distance - a.radius - b.radius);
    shot.normal_force.push_back(record.normal);
    if (shot.has_friction) shot.tangential_force.push_back(record.force - record.normal / distance * branch);
    if (!shot.has_necks) continue;
    shot.sintering_force.push_back(record.sintering);
    shot.neck_radius.push_back(list.neck[k].radius);
    shot.elastic_displacement.push_back(list.neck[k].elastic);
    shot.since.push_back(list.neck[k].since);
    shot.phase.push_back(std::uint8_t(list.neck[k].phase));
  }
}

}  // namespace

std::vector<Stress> particle_stresses(const State& s, const Recording& recording) {
  std::vector<Stress> sum(s.particles.size(), Stress{});
  for (std::size_t k = 0; k < s.contacts.size(); ++k) {
    const ContactRecord& record = recording.contact[k];
    if (!record.touching) continue;
    const std::uint32_t i = s.contacts.i(k), j = s.contacts.j(k);
    const Vec3 branch = branch_of(s, k);
    // The contact point lies in the middle of the overlap, at r_i + u/2.
    const double share = 0.5 + 0.5 * (s.particles.body[i].radius - s.particles.body[j].radius) / branch.norm();
    add_symmetric(sum[i], share * branch, record.force);
    add_symmetric(sum[j], (share - 1) * branch, -record.force);
  }
  for (const auto& record : recording.wall) add_symmetric(sum[record.particle], record.branch, record.force);
  for (std::size_t p = 0; p < sum.size(); ++p) {
    const double r = s.particles.body[p].radius, volume = 4.0 / 3 * std::numbers::pi * r * r * r;
    for (double& component : sum[p]) component /= volume;
  }
  return sum;
}

Snapshot take_snapshot(const Simulation& simulation, const Recording& recording, Moment moment) {
  const State& s = simulation.state();
  Snapshot shot;
  shot.moment = std::move(moment);
  for (const auto& m : simulation.setup().materials) shot.materials.push_back(m.name);
  shot.has_friction = !s.particles.angular_velocity.empty();
  shot.has_necks = !s.contacts.neck.empty();
  take_particles(shot, s, recording);
  take_contacts(shot, s, recording);
  shot.wall = s.walls.wall;
  shot.wall_force = s.walls.force();
  shot.cell = s.cell;
  return shot;
}

std::string six_digits(std::uint64_t number) {
  const std::string digits = std::to_string(number);
  return std::string(digits.size() < 6 ? 6 - digits.size() : 0, '0') + digits;
}

double mean_stress(const Stress& s) {
  return (s[0] + s[1] + s[2]) / 3;
}

double von_mises_stress(const Stress& s) {
  const double xy = s[0] - s[1], yz = s[1] - s[2], zx = s[2] - s[0];
  return std::sqrt(0.5 * (xy * xy + yz * yz + zx * zx) + 3 * (s[3] * s[3] + s[4] * s[4] + s[5] * s[5]));
}

}  // namespace densify::dem
