#include "dem/io/snapshot.h"

#include <algorithm>
#include <numeric>

#include "dem/measure/particle_stress.h"

namespace densify::dem {

namespace {

/// From particle i of pair k to particle j or its image [m].
Vec3 branch_of(const State& s, std::size_t k) {
  const Vec3 between = s.particles.body[s.contacts.j(k)].position - s.particles.body[s.contacts.i(k)].position;
  return s.cell.periodic ? Vec3(between + s.cell.shift(s.contacts.image(k))) : between;
}

void take_particles(Snapshot& shot, const State& s, const PoreClosure& pores, const Recording& recording) {
  const Particles& p = s.particles;
  std::vector<std::uint32_t> order(p.size());
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(), [&](auto a, auto b) { return p.id[a] < p.id[b]; });
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
    shot.coordination.push_back(coordination[q]);
    if (pores.density) shot.local_density.push_back(pores.scale * pores.density[q]);
  }
}

void take_contacts(Snapshot& shot, const State& s, const PoreClosure& pores, const Recording& recording) {
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
    if (pores.density) shot.flow_share.push_back(pores.share(list.i(k), list.j(k)));
  }
}

void take_walls(Snapshot& shot, const State& s, const Recording& recording) {
  shot.wall = s.walls.wall;
  shot.wall_force = s.walls.force();
  for (const WallRecord& record : recording.wall) {
    shot.wall_contact_id.push_back(s.particles.id[record.particle]);
    shot.wall_contact_wall.push_back(record.wall);
    shot.wall_contact_force.push_back(record.force);
    shot.wall_contact_arm.push_back(record.branch);
  }
}

}  // namespace

Snapshot take_snapshot(const Simulation& simulation, const Recording& recording, Moment moment) {
  const State& s = simulation.state();
  Snapshot shot;
  shot.moment = std::move(moment);
  for (const auto& m : simulation.setup().materials) shot.materials.push_back(m.name);
  shot.has_friction = !s.particles.angular_velocity.empty();
  shot.has_necks = !s.contacts.neck.empty();
  take_particles(shot, s, simulation.pores(), recording);
  take_contacts(shot, s, simulation.pores(), recording);
  take_walls(shot, s, recording);
  shot.cell = s.cell;
  shot.stress = particle_stresses(shot, StressPart::total);
  return shot;
}

std::vector<std::uint32_t> places_of_ids(const Snapshot& s) {
  const auto n = std::uint32_t(s.id.size());
  std::vector<std::uint32_t> place(n, n);
  for (std::uint32_t p = 0; p < n; ++p) {
    if (s.id[p] >= place.size()) place.resize(s.id[p] + 1, n);
    place[s.id[p]] = p;
  }
  return place;
}

std::string six_digits(std::uint64_t number) {
  const std::string digits = std::to_string(number);
  return std::string(digits.size() < 6 ? 6 - digits.size() : 0, '0') + digits;
}

}  // namespace densify::dem
