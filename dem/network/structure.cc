#include "dem/network/structure.h"

#include <Eigen/LU>
#include <algorithm>

namespace densify::dem {

NetworkStructure structure_of(const SpecimenNetwork& s) {
  const auto& edges = s.network.edges;
  NetworkStructure out;
  out.particles = s.network.particles;
  out.contacts = edges.size();
  std::vector<std::vector<std::uint32_t>> touching(out.particles);
  std::size_t ends = 0;
  for (std::uint32_t e = 0; e < edges.size(); ++e) {
    out.necks += edges[e].neck_radius > 0;
    out.fabric += edges[e].normal * edges[e].normal.transpose() / double(edges.size());
    touching[edges[e].i].push_back(e);
    if (!edges[e].at_wall) touching[edges[e].j].push_back(e);
    ends += edges[e].at_wall ? 1 : 2;
  }
  auto count = [&](std::size_t least) {
    const auto out_of = find_rattlers(s.network, least);
    return std::size_t(std::count(out_of.begin(), out_of.end(), true));
  };
  out.rattlers = count(1);
  out.loose = count(4);
  if (out.particles > 0) out.coordination = double(ends) / double(out.particles);

  // Every particle of an island gets its place relative to the first; a contact that does not fit leads around the
  // cell, by the lattice vector that is missing.
  constexpr std::uint32_t none = 0xffffffff;
  std::vector<std::uint32_t> island(out.particles, none), members;
  std::vector<Vec3> place(out.particles);
  const Mat3 to_fraction = s.cell.periodic ? Mat3(s.cell.h.inverse()) : Mat3(Mat3::Zero());
  for (std::uint32_t start = 0; start < out.particles; ++start) {
    if (island[start] != none || touching[start].empty()) continue;
    island[start] = std::uint32_t(out.islands);
    place[start] = Vec3::Zero();
    members = {start};
    Mat3 around = Mat3::Zero();  // sum of w w^T over the ways around, of lattice vectors or of ways out of a region
    for (std::size_t m = 0; m < members.size(); ++m)
      for (const std::uint32_t e : touching[members[m]]) {
        const std::uint32_t p = members[m];
        const NetworkEdge& edge = edges[e];
        if (edge.at_wall) {
          around += edge.normal * edge.normal.transpose();
          continue;
        }
        const bool first = edge.i == p;
        const std::uint32_t q = first ? edge.j : edge.i;
        const Vec3 at = place[p] + (first ? edge.branch : Vec3(-edge.branch));
        if (island[q] == none) {
          island[q] = island[start];
          place[q] = at;
          members.push_back(q);
          continue;
        }
        const Vec3 w = (to_fraction * (at - place[q])).array().round();
        around += w * w.transpose();
        if (p == q) around += w * w.transpose();
      }
    ++out.islands;
    Eigen::FullPivLU<Mat3> rank(around);
    rank.setThreshold(1e-9);
    const int directions = s.cell.periodic || rank.rank() == 3 ? int(rank.rank()) : 0;
    if (directions == 3) out.spanning += members.size();
    out.directions = std::max(out.directions, directions);
  }
  return out;
}

}  // namespace densify::dem
