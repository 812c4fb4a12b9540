#include "coupling/packing_voxels.h"

#include <algorithm>
#include <cmath>

#include "base/check.h"

namespace densify::coupling {

fem::LevelSet packing_level_set(const dem::SpecimenNetwork& s, int n) {
  DENSIFY_EXPECT(s.cell.periodic);
  const Vec3 edges = s.cell.h.colwise().norm();
  std::array<int, 3> voxels;
  for (int c = 0; c < 3; ++c) voxels[c] = std::max(1, int(std::lround(n * edges[c] / edges.maxCoeff())));
  double mean = 0;
  for (const double r : s.radius) mean += r / double(s.radius.size());
  constexpr double farthest = 0.5;  // of the mean radius: growth that fills any packing of this kind
  fem::LevelSet level(s.cell.h, voxels, farthest * mean);
  for (std::size_t p = 0; p < s.position.size(); ++p) level.add(fem::Ball{s.position[p], s.radius[p], s.material[p]});
  for (const dem::NetworkEdge& e : s.network.edges)
    if (e.neck_radius > 0) {
      const Vec3 far = s.position[e.i] + e.branch, plane = s.position[e.i] + e.lever * e.normal;
      level.add(fem::Rod{s.position[e.i], plane - s.position[e.i], e.neck_radius, s.material[e.i]});
      level.add(fem::Rod{far, plane - far, e.neck_radius, s.far_material[std::size_t(&e - s.network.edges.data())]});
    }
  return level;
}

std::vector<fem::ElasticSolid> elastic_solids(const std::vector<dem::Material>& materials, double temperature) {
  std::vector<fem::ElasticSolid> solids;
  for (const dem::Material& m : materials)
    solids.push_back({m.youngs_modulus(temperature), m.poissons_ratio(temperature)});
  return solids;
}

double voxels_across_neck(const dem::SpecimenNetwork& s, int n) {
  double sum = 0;
  std::size_t necks = 0;
  for (const dem::NetworkEdge& e : s.network.edges)
    if (e.neck_radius > 0) sum += 2 * e.neck_radius, ++necks;
  if (necks == 0) return std::nan("");
  return sum / double(necks) / (s.cell.h.colwise().norm().maxCoeff() / n);
}

}  // namespace densify::coupling
