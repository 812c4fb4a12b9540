// Looking does not touch: a recorded pass fills its record and changes no bit of the run; the record adds up.

#include <gtest/gtest.h>

#include "tests/invariance/worlds.h"

namespace densify::test {
namespace {

// A run taken in halves and recorded at every third step ends at the same bits as one that never was, with one thread
// and with two.
TEST(Recording, ChangesNothing) {
  for (World w : all_worlds)
    for (int threads : {1, 2}) {
      auto s = make_world(w);
      s.integration.threads = threads;
      const auto plain = run_world(w, s, 300);
      Simulation watched(s);
      begin_world(w, watched);
      dem::Recording record;
      for (int n = 0; n < 300; ++n) {
        watched.evaluate(n % 3 == 0 ? &record : nullptr);
        watched.move();
      }
      for (std::size_t p = 0; p < plain.state().particles.size(); ++p) {
        EXPECT_EQ(plain.state().particles.body[p].position, watched.state().particles.body[p].position);
        EXPECT_EQ(plain.state().particles.body[p].velocity, watched.state().particles.body[p].velocity);
      }
      EXPECT_EQ(plain.state().time, watched.state().time);
    }
}

// The record is the force: its sum over each particle's contacts and walls is the resultant, torque included.
TEST(Recording, AddsUpToTheResultant) {
  auto s = make_world(World::frictional);
  s.container.shape = dem::ContainerShape::box;
  s.container.punch = false;
  s.container.size = Vec3::Constant(4e-5);
  for (auto& b : s.particles.body) b.position += Vec3::Constant(4.8e-6);
  Simulation sim(s);
  dem::Recording record;
  for (int n = 0; n < 50 || (record.wall.empty() && n < 500); ++n) sim.advance(&record);
  const auto& state = sim.state();
  std::vector<Vec3> force(state.particles.size(), Vec3::Zero()), torque(force);
  for (std::size_t k = 0; k < record.contact.size(); ++k) {
    const auto& c = record.contact[k];
    force[state.contacts.i(k)] += c.force;
    force[state.contacts.j(k)] -= c.force;
    torque[state.contacts.i(k)] += c.lever_i * c.couple;
    torque[state.contacts.j(k)] += c.lever_j * c.couple;
  }
  ASSERT_FALSE(record.wall.empty());
  for (const auto& c : record.wall) {
    force[c.particle] += c.force;
    torque[c.particle] += c.branch.cross(c.force);
  }
  double scale = 0;
  for (const Vec3& f : state.particles.force) scale = std::max(scale, f.norm());
  for (std::size_t p = 0; p < force.size(); ++p) {
    EXPECT_LT((force[p] - state.particles.force[p]).norm(), 1e-12 * scale);
    EXPECT_LT((torque[p] - state.particles.torque[p]).norm(), 1e-12 * scale * 5e-6);
  }
}

// Without friction every force lies along its branch, so that the stress sum (6.10) is symmetric; and its trace is the
// virial, three times the mean pressure.
TEST(Recording, StressOfCentralForcesIsSymmetric) {
  Simulation sim(make_world(World::bonded));
  bond_all(sim, dem::NeckPhase::dormant, 0.3);
  dem::Recording record;
  for (int n = 0; n < 50; ++n) sim.advance(&record);
  sim.evaluate(&record);
  const Mat3 s = contact_stress(sim, record, 1e-12);
  EXPECT_GT(s.norm(), 0);
  EXPECT_LT((s - s.transpose()).norm(), 1e-12 * s.norm());
  double virial = 0;
  for (std::size_t k = 0; k < record.contact.size(); ++k) {
    const auto &a = sim.state().particles.body[sim.state().contacts.i(k)],
               &b = sim.state().particles.body[sim.state().contacts.j(k)];
    virial += record.contact[k].normal * (b.position - a.position).norm();
  }
  EXPECT_NEAR(s.trace() / (virial / 1e-12), 1, 1e-9);
}

}  // namespace
}  // namespace densify::test
