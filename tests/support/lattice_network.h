#pragma once
// Periodic networks for tests: crystals whose contacts all have necks, shaken or not.

#include "dem/network/specimen_network.h"
#include "tests/support/setups.h"

namespace densify::test {

struct LatticeCase {
  Lattice lattice = Lattice::face_centred;
  int cells = 3;
  double spacing = 9.5e-6, radius = 5e-6;  ///< [m]
  dem::SinteringModel model = dem::SinteringModel::viscoelastic;
  dem::NeckPhase phase = dem::NeckPhase::bonded;
  double neck = 0.4;  ///< over the radius
  double shaken = 0;  ///< largest shift along each axis over the radius
};

/// Copper at 1300 K: E 100 GPa, nu 0.3, linear springs of 1e5 N/m.
inline dem::SpecimenNetwork lattice_network(const LatticeCase& c) {
  auto contact = elastic_model(dem::Elasticity::linear, 1e5);
  contact.sintering = dem::SinteringSettings{};
  contact.sintering->model = c.model;
  contact.sintering->damping_ratio = 0;
  Setup s = empty_setup(copper(), contact, hold(1, 1300, 0));
  fill_periodic(s, c.lattice, c.cells, c.spacing, c.radius);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> u(-c.shaken * c.radius, c.shaken * c.radius);
  if (c.shaken > 0)
    for (auto& b : s.particles.body) {
      const double x = u(random), y = u(random), z = u(random);
      b.position += Vec3(x, y, z);
    }
  Simulation sim(s);
  bond_all(sim, c.phase, c.neck);
  return dem::network_of(sim);
}

}  // namespace densify::test
