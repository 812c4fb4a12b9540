#include "dem/measure/measures.h"

#include <algorithm>
#include <cmath>

namespace densify::dem {

namespace {

Mat3 symmetric(const Mat3& a) {
  return 0.5 * (a + a.transpose());
}

void measure_necks(const State& s, Measures& m) {
  std::size_t necks = 0, at_equilibrium = 0;
  double sum = 0;
  for (const auto& h : s.contacts.neck) {
    if (h.phase == NeckPhase::loose) continue;
    ++necks;
    sum += h.radius;
    at_equilibrium += h.phase == NeckPhase::arriving || h.phase == NeckPhase::bonded;
  }
  if (necks == 0) return;
  m.mean_neck_radius = sum / double(necks);
  m.equilibrium_fraction = double(at_equilibrium) / double(necks);
}

void measure_pores(const State& s, const PoreClosure& pores, Measures& m) {
  if (!pores.density) return;
  double sum = 0, largest = 0;
  for (const double density : s.local_density.of) {
    sum += density;
    largest = std::max(largest, density);
  }
  m.mean_local_density = pores.scale * sum / double(s.particles.size());
  m.largest_local_density = pores.scale * largest;
  std::size_t necks = 0, closing = 0;
  for (std::size_t k = 0; k < s.contacts.neck.size(); ++k) {
    if (s.contacts.neck[k].phase == NeckPhase::loose) continue;
    ++necks;
    closing += pores.share(s.contacts.i(k), s.contacts.j(k)) < 1;
  }
  if (necks > 0) m.closing_fraction = double(closing) / double(necks);
}

void measure_walls(const Simulation& sim, Measures& m) {
  const State& s = sim.state();
  const auto& normal = s.walls.normal_force();
  if (normal.empty()) return;
  const Vec3& size = m.envelope.size;
  double lateral_force = 0, lateral_area = 0;
  for (std::size_t w = 0; w < s.walls.wall.size(); ++w) {
    const Wall& wall = s.walls.wall[w];
    if (wall.shape == WallShape::cylinder) {
      lateral_force += normal[w];
      lateral_area += 2 * M_PI * wall.radius * size[2];
    } else if (std::abs(wall.normal[2]) < 0.5) {
      lateral_force += normal[w];
      lateral_area += (std::abs(wall.normal[0]) > 0.5 ? size[1] : size[0]) * size[2];
    }
  }
  m.punch_pressure = normal[*sim.wall("punch")] / sim.punch_area();
  m.bottom_pressure = normal[*sim.wall("bottom")] / sim.punch_area();
  if (lateral_area > 0) m.lateral_pressure = lateral_force / lateral_area;
}

}  // namespace

Measures measure(const Simulation& sim, const Recording& recording) {
  const State& s = sim.state();
  Measures m;
  m.envelope = measure_envelope(sim);
  m.relative_density = relative_density(sim, m.envelope);
  m.relative_density_inner = inner_relative_density(sim, 2 * mean_diameter(sim));
  measure_necks(s, m);
  measure_pores(s, sim.pores(), m);
  measure_walls(sim, m);

  double contact_force = 0, damping = 0, power = 0;
  std::size_t touching = 0, forces = 0;
  Mat3 sintering = Mat3::Zero(), total = Mat3::Zero();
  const ImageShifts shifts(s.cell);
  for (std::size_t k = 0; k < recording.contact.size(); ++k) {
    const ContactRecord& c = recording.contact[k];
    if (!c.touching) continue;
    ++touching;
    const Body &a = s.particles.body[s.contacts.i(k)], &b = s.particles.body[s.contacts.j(k)];
    const Vec3 branch = b.position - a.position + shifts[s.contacts.image(k)];
    const double distance = branch.norm();
    total += c.force * branch.transpose();
    if (c.sintering != 0) sintering += Vec3(c.sintering / distance * branch) * branch.transpose();
    const double size = c.force.norm();
    contact_force += size;
    power += size * distance;
    damping += std::abs(c.damping);
    m.elastic_energy += c.elastic_energy;
    // A division only where it may be the largest.
    const double overlap = a.radius + b.radius - distance, smaller = std::min(a.radius, b.radius);
    if (overlap > m.largest_overlap * smaller) m.largest_overlap = overlap / smaller;
    ++forces;
  }
  m.contact_pressure = power / (3 * m.envelope.volume);
  for (const auto& w : recording.wall) {
    total += w.force * w.branch.transpose();
    contact_force += w.force.norm();
    m.elastic_energy += w.elastic_energy;
    ++forces;
  }
  m.stress = symmetric(total / m.envelope.volume);
  m.sintering_stress = sintering / m.envelope.volume;
  m.coordination_number = 2 * double(touching) / double(s.particles.size());
  double resultant = 0;
  for (std::size_t p = 0; p < s.particles.size(); ++p) {
    resultant += s.particles.force[p].norm();
    m.kinetic_energy += 0.5 / s.particles.body[p].inverse_mass * s.particles.body[p].velocity.squaredNorm();
  }
  if (contact_force > 0) {
    m.unbalanced_force_ratio = (resultant / double(s.particles.size())) / (contact_force / double(forces));
    m.damping_share = damping / contact_force;
  }
  return m;
}

}  // namespace densify::dem
