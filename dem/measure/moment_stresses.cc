#include "dem/measure/moment_stresses.h"

#include <algorithm>
#include <cmath>

#include "base/check.h"

namespace densify::dem {

namespace {

Stress sum(const std::vector<Stress>& all) {
  Stress total{};
  for (const Stress& s : all)
    for (std::size_t c = 0; c < 6; ++c) total[c] += s[c];
  return total;
}

/// Sum of |L| |F| over all contacts, the size that (6.9) and (6.10) are rounded against [N m].
double work_of_all(const Snapshot& s) {
  double work = 0;
  for (std::size_t c = 0; c < s.branch.size(); ++c)
    work += s.branch[c].norm() * contact_force(s, c, StressPart::total).norm();
  for (std::size_t c = 0; c < s.wall_contact_id.size(); ++c)
    work += s.wall_contact_arm[c].norm() * s.wall_contact_force[c].norm();
  return work;
}

std::vector<Group> with_all(std::vector<Group> groups) {
  if (groups.size() == 1) return groups;
  Group all{"all", {}};
  for (const Group& g : groups) all.values.insert(all.values.end(), g.values.begin(), g.values.end());
  groups.push_back(std::move(all));
  return groups;
}

}  // namespace

const char* name_of(StressPart part) {
  constexpr const char* names[] = {"sintering", "viscoelastic", "total"};
  return names[std::size_t(part)];
}

MomentStresses moment_stresses(const Snapshot& s) {
  MomentStresses m{ContactKinds(s.materials), specimen_volume(s), {}, {}, {}, {}, neck_stresses(s), 0};
  for (const StressPart part : stress_parts) {
    const auto p = std::size_t(part);
    m.by_kind[p] = stress_by_contacts(s, m.kinds, part);
    m.macroscopic[p] = sum(m.by_kind[p]);
    m.of_particles[p] = particle_stresses(s, part);
    m.by_material[p] = stress_by_materials(s, m.of_particles[p]);
  }
  constexpr auto total = std::size_t(StressPart::total);
  const Stress stored = sum(stress_by_materials(s, s.stress));
  double difference = 0;
  for (std::size_t c = 0; c < 6; ++c) difference = std::max(difference, std::abs(stored[c] - m.macroscopic[total][c]));
  const double scale = work_of_all(s) / m.volume;
  m.mismatch = difference > 0 ? difference / scale : 0;
  constexpr double rounding = 1e-10;
  if (!(m.mismatch < rounding))
    throw RunError("the stresses of the particles (6.9) and of the contacts (6.10) differ by " +
                   std::to_string(m.mismatch) + " of the contacts' size at " + std::to_string(s.moment.time) +
                   " s: the snapshot does not fit together");
  return m;
}

std::vector<Group> by_materials(const Snapshot& s, const std::vector<double>& of_particles) {
  std::vector<Group> groups;
  for (const auto& name : s.materials) groups.push_back({name, {}});
  for (std::size_t p = 0; p < of_particles.size(); ++p) groups[s.material[p]].values.push_back(of_particles[p]);
  return with_all(std::move(groups));
}

std::vector<Group> necks_by_kinds(const Snapshot& s, const MomentStresses& m, StressPart part, NeckSet set) {
  std::vector<Group> groups;
  for (std::size_t k = 0; k < m.kinds.walls(); ++k) groups.push_back({m.kinds.name(k), {}});
  const auto kind = kinds_of_contacts(s, m.kinds);
  for (const NeckStress& n : m.necks) {
    if (set == NeckSet::short_of_equilibrium && n.at_equilibrium) continue;
    groups[kind[n.contact]].values.push_back(part == StressPart::sintering      ? n.sintering
                                             : part == StressPart::viscoelastic ? n.viscoelastic
                                                                                : n.total());
  }
  return with_all(std::move(groups));
}

std::vector<double> mean_stresses(const std::vector<Stress>& all) {
  std::vector<double> mean;
  for (const Stress& s : all) mean.push_back(mean_stress(s));
  return mean;
}

}  // namespace densify::dem
