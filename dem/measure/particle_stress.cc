#include "dem/measure/particle_stress.h"

#include <numbers>

namespace densify::dem {

namespace {

double sphere_volume(double r) {
  return 4.0 / 3 * std::numbers::pi * r * r * r;
}

}  // namespace

std::vector<Stress> particle_stresses(const Snapshot& s, StressPart part) {
  const auto place = places_of_ids(s);
  std::vector<Stress> sum(s.id.size(), Stress{});
  for (std::size_t c = 0; c < s.first_id.size(); ++c) {
    const std::uint32_t i = place[s.first_id[c]], j = place[s.second_id[c]];
    const Vec3& branch = s.branch[c];
    const Vec3 force = contact_force(s, c, part);
    // The contact point lies in the middle of the overlap, at r_i + u/2.
    const double share = 0.5 + 0.5 * (s.radius[i] - s.radius[j]) / branch.norm();
    add_symmetric(sum[i], share * branch, force);
    add_symmetric(sum[j], (share - 1) * branch, -force);
  }
  if (part != StressPart::sintering)
    for (std::size_t c = 0; c < s.wall_contact_id.size(); ++c)
      add_symmetric(sum[place[s.wall_contact_id[c]]], s.wall_contact_arm[c], s.wall_contact_force[c]);
  for (std::size_t p = 0; p < sum.size(); ++p)
    for (double& component : sum[p]) component /= sphere_volume(s.radius[p]);
  return sum;
}

std::vector<Stress> stress_by_materials(const Snapshot& s, const std::vector<Stress>& of_particles) {
  std::vector<Stress> sum(s.materials.size(), Stress{});
  const double volume = specimen_volume(s);
  for (std::size_t p = 0; p < of_particles.size(); ++p)
    for (std::size_t c = 0; c < 6; ++c)
      sum[s.material[p]][c] += sphere_volume(s.radius[p]) / volume * of_particles[p][c];
  return sum;
}

std::vector<double> material_volumes(const Snapshot& s) {
  std::vector<double> volume(s.materials.size(), 0.0);
  for (std::size_t p = 0; p < s.radius.size(); ++p) volume[s.material[p]] += sphere_volume(s.radius[p]);
  return volume;
}

}  // namespace densify::dem
