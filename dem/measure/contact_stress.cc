#include "dem/measure/contact_stress.h"

#include <algorithm>
#include <numbers>

namespace densify::dem {

Vec3 contact_force(const Snapshot& s, std::size_t c, StressPart part) {
  const double sintering = s.has_necks ? s.sintering_force[c] : 0.0;
  double normal = s.normal_force[c];
  if (part == StressPart::sintering) normal = sintering;
  if (part == StressPart::viscoelastic) normal -= sintering;
  const Vec3 force = normal / s.branch[c].norm() * s.branch[c];
  return s.has_friction && part != StressPart::sintering ? Vec3(force + s.tangential_force[c]) : force;
}

ContactKinds::ContactKinds(const std::vector<std::string>& materials) : materials_(materials.size()) {
  for (std::size_t a = 0; a < materials_; ++a)
    for (std::size_t b = a; b < materials_; ++b) name_.push_back(materials[a] + " - " + materials[b]);
  name_.push_back("walls");
}

std::size_t ContactKinds::of(std::uint8_t material_a, std::uint8_t material_b) const {
  const std::size_t a = std::min(material_a, material_b), b = std::max(material_a, material_b);
  return a * materials_ - a * (a + 1) / 2 + b;
}

std::vector<std::size_t> kinds_of_contacts(const Snapshot& s, const ContactKinds& kinds) {
  const auto place = places_of_ids(s);
  std::vector<std::size_t> kind(s.first_id.size());
  for (std::size_t c = 0; c < kind.size(); ++c)
    kind[c] = kinds.of(s.material[place[s.first_id[c]]], s.material[place[s.second_id[c]]]);
  return kind;
}

double specimen_volume(const Snapshot& s) {
  if (s.cell.periodic) return s.cell.volume();
  double solid = 0;
  for (const double r : s.radius) solid += 4.0 / 3 * std::numbers::pi * r * r * r;
  return solid / s.moment.relative_density;
}

std::vector<Stress> stress_by_contacts(const Snapshot& s, const ContactKinds& kinds, StressPart part) {
  std::vector<Stress> sum(kinds.size(), Stress{});
  const auto kind = kinds_of_contacts(s, kinds);
  for (std::size_t c = 0; c < kind.size(); ++c) add_symmetric(sum[kind[c]], s.branch[c], contact_force(s, c, part));
  if (part != StressPart::sintering)
    for (std::size_t c = 0; c < s.wall_contact_id.size(); ++c)
      add_symmetric(sum[kinds.walls()], s.wall_contact_arm[c], s.wall_contact_force[c]);
  const double volume = specimen_volume(s);
  for (Stress& of_kind : sum)
    for (double& component : of_kind) component /= volume;
  return sum;
}

std::vector<NeckStress> neck_stresses(const Snapshot& s) {
  std::vector<NeckStress> necks;
  for (std::size_t c = 0; s.has_necks && c < s.neck_radius.size(); ++c) {
    const auto phase = NeckPhase(s.phase[c]);
    if (phase == NeckPhase::loose) continue;
    const double area = std::numbers::pi * s.neck_radius[c] * s.neck_radius[c], sintering = s.sintering_force[c];
    necks.push_back({c, phase == NeckPhase::arriving || phase == NeckPhase::bonded, sintering / area,
                     (s.normal_force[c] - sintering) / area});
  }
  return necks;
}

}  // namespace densify::dem
