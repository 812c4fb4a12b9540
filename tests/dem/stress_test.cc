// Stress in necks, particles and specimen (thesis 6.1-6.10) against hand calculations, closed forms of crystals and the
// measures of the history, which sum on their own.

#include <gtest/gtest.h>

#include "base/check.h"
#include "dem/io/result_file.h"
#include "dem/io/stored_snapshot.h"
#include "dem/measure/measures.h"
#include "dem/measure/moment_stresses.h"
#include "tests/dem/scratch_folder.h"
#include "tests/dem/small_packings.h"
#include "tests/support/setups.h"

namespace densify::dem {
namespace {

constexpr StressPart parts[] = {StressPart::sintering, StressPart::viscoelastic, StressPart::total};

/// A simulation's snapshot with its density by envelope, and the measures of the same moment.
struct Shot {
  Snapshot snapshot;
  Measures measures;
};

Shot shoot(Simulation& simulation) {
  const double time = simulation.state().time;
  Recording recording;
  simulation.evaluate(&recording);
  const Measures m = measure(simulation, recording);
  return {take_snapshot(simulation, recording, {time, simulation.temperature(), 0, m.relative_density, "hold"}), m};
}

/// Necks of two materials, friction, and a sheared cell or walls on all sides; activated a while ago.
Shot packing(Setup setup, int steps) {
  Simulation simulation(std::move(setup));
  testing::run_steps(simulation, steps);
  EXPECT_TRUE(simulation.table().any_active());
  return shoot(simulation);
}

Stress six(const Mat3& m) {
  return {m(0, 0), m(1, 1), m(2, 2), m(1, 2), m(0, 2), m(0, 1)};
}

Mat3 full(const Stress& t) {
  Mat3 m;
  m << t[0], t[5], t[4], t[5], t[1], t[3], t[4], t[3], t[2];
  return m;
}

Stress sum(const std::vector<Stress>& all) {
  Stress total{};
  for (const Stress& s : all)
    for (std::size_t c = 0; c < 6; ++c) total[c] += s[c];
  return total;
}

double largest(const Stress& s) {
  double most = 0;
  for (const double x : s) most = std::max(most, std::abs(x));
  return most;
}

void expect_near(const Stress& a, const Stress& b, double tolerance) {
  for (std::size_t c = 0; c < 6; ++c) EXPECT_NEAR(a[c], b[c], tolerance) << c;
}

// One neck of radius 0.25 m that carries -3 N, 0.5 N of them F_sint: (6.1)-(6.4) by hand, A = pi/16 m^2.  Spheres of
// 1 m and 2 m, centres 2.8 m apart along x, u = -0.2: the contact point is 0.9 m and 1.9 m from the centres, so that
// sigma_xx = F s/V_p, and a lateral force T along y puts T s/(2 V_p) into xy.
Snapshot unequal_pair() {
  Snapshot s;
  s.moment.relative_density = 0.5;
  s.materials = {"A", "B"};
  s.has_necks = s.has_friction = true;
  s.id = {0, 1};
  s.material = {0, 1};
  s.position = {Vec3::Zero(), Vec3(2.8, 0, 0)};
  s.radius = {1, 2};
  s.first_id = {1};  // the larger first
  s.second_id = {0};
  s.start = {s.position[1]};
  s.branch = {Vec3(-2.8, 0, 0)};
  s.normal_force = {-3};
  s.tangential_force = {Vec3(0, 0.1, 0)};
  s.sintering_force = {0.5};
  s.neck_radius = {0.25};
  s.phase = {std::uint8_t(NeckPhase::sintering)};
  return s;
}

Snapshot with_stress(Snapshot s) {
  s.stress = particle_stresses(s, StressPart::total);
  return s;
}

TEST(ContactStress, OfANeckByHand) {
  Snapshot s = unequal_pair();
  const auto necks = neck_stresses(s);
  ASSERT_EQ(necks.size(), 1u);
  EXPECT_DOUBLE_EQ(necks[0].sintering, 8 / M_PI);
  EXPECT_DOUBLE_EQ(necks[0].viscoelastic, -56 / M_PI);
  EXPECT_DOUBLE_EQ(necks[0].total(), -48 / M_PI);
  EXPECT_FALSE(necks[0].at_equilibrium);
  // The thesis leaves out the necks that have come to a_max; a cold one short of it is no such neck.
  for (const auto phase : {NeckPhase::arriving, NeckPhase::bonded}) {
    s.phase = {std::uint8_t(phase)};
    EXPECT_TRUE(neck_stresses(s)[0].at_equilibrium);
  }
  s.phase = {std::uint8_t(NeckPhase::dormant)};
  EXPECT_FALSE(neck_stresses(s)[0].at_equilibrium);
  s.phase = {std::uint8_t(NeckPhase::loose)};
  EXPECT_TRUE(neck_stresses(s).empty());
}

TEST(ParticleStress, OfAnUnequalPairByHand) {
  const Snapshot s = unequal_pair();
  const double v0 = 4.0 / 3 * M_PI, v1 = 8 * v0;
  const auto total = particle_stresses(s, StressPart::total), sintering = particle_stresses(s, StressPart::sintering);
  expect_near(total[0], {-3 * 0.9 / v0, 0, 0, 0, 0, -0.5 * 0.1 * 0.9 / v0}, 1e-15);
  expect_near(total[1], {-3 * 1.9 / v1, 0, 0, 0, 0, -0.5 * 0.1 * 1.9 / v1}, 1e-15);
  expect_near(sintering[0], {0.5 * 0.9 / v0, 0, 0, 0, 0, 0}, 1e-15);
  // (6.10): V = (V_0 + V_1)/0.5.
  const ContactKinds kinds(s.materials);
  const auto by_kind = stress_by_contacts(s, kinds, StressPart::total);
  const double volume = 2 * (v0 + v1);
  expect_near(by_kind[kinds.of(0, 1)], {-3 * 2.8 / volume, 0, 0, 0, 0, -0.5 * 0.1 * 2.8 / volume}, 1e-15);
  EXPECT_EQ(largest(by_kind[kinds.of(0, 0)]) + largest(by_kind[kinds.walls()]), 0);
}

// Uniaxial tension 3: mean 1, deviator (2, -1, -1), von Mises 3; pure shear tau: sqrt(3) tau.
TEST(Stress, MeanAndDeviator) {
  EXPECT_DOUBLE_EQ(mean_stress({3, 0, 0, 0, 0, 0}), 1);
  EXPECT_EQ(deviator({3, 0, 0, 4, 5, 6}), (Stress{2, -1, -1, 4, 5, 6}));
  EXPECT_DOUBLE_EQ(von_mises_stress({3, 0, 0, 0, 0, 0}), 3);
  EXPECT_DOUBLE_EQ(von_mises_stress({0, 0, 0, 0, 2, 0}), 2 * std::sqrt(3.0));
  EXPECT_DOUBLE_EQ(von_mises_stress({5, 5, 5, 0, 0, 0}), 0);
}

TEST(ContactKinds, NamesAndNumbers) {
  const ContactKinds kinds({"A", "B", "C"});
  ASSERT_EQ(kinds.size(), 7u);
  EXPECT_EQ(kinds.name(kinds.of(0, 0)), "A - A");
  EXPECT_EQ(kinds.name(kinds.of(2, 1)), "B - C");
  EXPECT_EQ(kinds.name(kinds.of(2, 2)), "C - C");
  EXPECT_EQ(kinds.name(kinds.walls()), "walls");
}

// A crystal of touching spheres, centre distance L, Z neighbours, springs k pressed by u: F = k u, and by symmetry a
// mean stress of -Z F (L/2)/(3 V_p) in each particle and -phi times that in the cell, phi = V_p over the volume of a
// site: sites are all alike, so that particle stress = macroscopic stress over phi.  Stretched along z by a further
// strain the particle stress is no longer isotropic, but still that of the cell over phi.
TEST(ParticleStress, Crystals) {
  using test::Lattice;
  constexpr double r = 5e-6, overlap = 0.02 * r, k = 1e5;
  const std::pair<Lattice, double> neighbours[] = {
      {Lattice::simple_cubic, 6}, {Lattice::body_centred, 8}, {Lattice::face_centred, 12}};
  for (const auto& [lattice, z] : neighbours)
    for (const double stretch : {0.0, 0.004}) {
      auto setup = test::empty_setup(test::copper(), test::elastic_model(Elasticity::linear, k), test::hold(1, 300, 0));
      test::fill_periodic(setup, lattice, 3, 2 * r - overlap, r);
      for (auto& b : setup.particles.body) b.position[2] *= 1 + stretch;
      setup.cell.h(2, 2) *= 1 + stretch;
      Simulation simulation(setup);
      const Shot shot = shoot(simulation);
      const auto of_particles = particle_stresses(shot.snapshot, StressPart::total);
      const Stress macroscopic = sum(stress_by_contacts(shot.snapshot, ContactKinds({"Cu"}), StressPart::total));
      const double volume = 4.0 / 3 * M_PI * r * r * r, phi = shot.measures.relative_density;
      const double pressure = z * k * overlap * (r - 0.5 * overlap) / (3 * volume);
      for (const Stress& s : of_particles) {
        for (std::size_t c = 0; c < 6; ++c) EXPECT_NEAR(s[c] * phi, macroscopic[c], 1e-11 * phi * pressure) << c;
        if (stretch == 0) expect_near(s, {-pressure, -pressure, -pressure, 0, 0, 0}, 1e-9 * pressure);
      }
      if (stretch > 0) {
        EXPECT_GT(von_mises_stress(of_particles[0]), 1e-3 * pressure);
      }
    }
}

// (6.9) from particles with their volumes equals (6.10) from contacts and walls to rounding, each part of it, in a
// periodic cell and between walls, and both equal the sums of the history.
TEST(ParticleStress, SpecimenByParticlesAndByContacts) {
  for (const auto& shot : {packing(testing::periodic_packing(1), 260), packing(testing::cylinder_packing(1), 260)}) {
    const Snapshot& s = shot.snapshot;
    EXPECT_EQ(s.wall.empty(), s.wall_contact_id.empty());
    const ContactKinds kinds(s.materials);
    const double scale = largest(six(shot.measures.stress));
    ASSERT_GT(scale, 0);
    for (const StressPart part : parts) {
      const Stress by_contacts = sum(stress_by_contacts(s, kinds, part));
      const Stress by_particles = sum(stress_by_materials(s, particle_stresses(s, part)));
      expect_near(by_particles, by_contacts, 1e-13 * scale);
      if (part == StressPart::total) expect_near(by_contacts, six(shot.measures.stress), 1e-13 * scale);
      if (part == StressPart::sintering) expect_near(by_contacts, six(shot.measures.sintering_stress), 1e-13 * scale);
    }
    EXPECT_EQ(largest(stress_by_contacts(s, kinds, StressPart::sintering)[kinds.walls()]), 0);
    EXPECT_GT(largest(shot.measures.sintering_stress.isZero() ? Stress{} : six(shot.measures.sintering_stress)), 0);
  }
}

// Total = sintering + viscoelastic, for kinds of contact, particles and necks.
TEST(ParticleStress, PartsAddUp) {
  const Snapshot s = packing(testing::cylinder_packing(1), 260).snapshot;
  auto check = [](const auto& a, const auto& b, const auto& total) {
    ASSERT_EQ(a.size(), total.size());
    for (std::size_t p = 0; p < total.size(); ++p)
      for (std::size_t c = 0; c < 6; ++c)
        EXPECT_NEAR(a[p][c] + b[p][c], total[p][c], 1e-12 * (largest(a[p]) + largest(total[p])));
  };
  check(particle_stresses(s, parts[0]), particle_stresses(s, parts[1]), particle_stresses(s, parts[2]));
  const ContactKinds kinds(s.materials);
  check(stress_by_contacts(s, kinds, parts[0]), stress_by_contacts(s, kinds, parts[1]),
        stress_by_contacts(s, kinds, parts[2]));
  EXPECT_EQ(s.stress, particle_stresses(s, StressPart::total));
  for (const NeckStress& n : neck_stresses(s))
    EXPECT_NEAR(n.total() * M_PI * std::pow(s.neck_radius[n.contact], 2), s.normal_force[n.contact],
                1e-12 * std::abs(s.normal_force[n.contact]));
}

// The groups of a table hold every particle and every neck once, and again in "all".
TEST(MomentStresses, Groups) {
  const Snapshot s = packing(testing::cylinder_packing(1), 260).snapshot;
  const MomentStresses m = moment_stresses(s);
  EXPECT_LT(m.mismatch, 1e-14);
  const auto particles = by_materials(s, mean_stresses(m.of_particles[std::size_t(StressPart::total)]));
  ASSERT_EQ(particles.size(), 3u);
  EXPECT_EQ(particles[0].name, "soft");
  EXPECT_EQ(particles[2].name, "all");
  EXPECT_EQ(particles[0].values.size() + particles[1].values.size(), s.id.size());
  EXPECT_EQ(particles[2].values.size(), s.id.size());
  EXPECT_EQ(particles[s.material[0]].values[0], mean_stress(s.stress[0]));
  const auto necks = necks_by_kinds(s, m, StressPart::total, NeckSet::all);
  ASSERT_EQ(necks.size(), 4u);
  EXPECT_EQ(necks[1].name, "soft - hard");
  EXPECT_EQ(necks[3].values.size(), m.necks.size());
  ASSERT_FALSE(m.necks.empty());
  // One neck that has come to a_max is in one set only.
  Snapshot arrived = s;
  arrived.phase[m.necks[0].contact] = std::uint8_t(NeckPhase::bonded);
  std::size_t at_equilibrium = 0;
  const MomentStresses n = moment_stresses(arrived);
  for (const auto& neck : n.necks) at_equilibrium += neck.at_equilibrium;
  EXPECT_GE(at_equilibrium, 1u);
  EXPECT_EQ(necks_by_kinds(arrived, n, StressPart::total, NeckSet::short_of_equilibrium).back().values.size(),
            n.necks.size() - at_equilibrium);
  EXPECT_EQ(necks_by_kinds(unequal_pair(), moment_stresses(with_stress(unequal_pair())), StressPart::sintering,
                           NeckSet::all)[1]
                .values,
            std::vector<double>{8 / M_PI});
}

// Particle stresses that do not belong to the contacts beside them.
TEST(MomentStresses, RefusesWhatDoesNotFitTogether) {
  Snapshot s = packing(testing::cylinder_packing(1), 260).snapshot;
  moment_stresses(s);
  s.wall_contact_force[0] *= 1.001;
  EXPECT_NE(testing::message_of<RunError>([&] { moment_stresses(s); }).find("(6.9)"), std::string::npos);
}

// A rotated snapshot has the rotated stresses, the same mean and von Mises stresses and the same necks.
TEST(ParticleStress, Rotation) {
  const Snapshot s = packing(testing::cylinder_packing(1), 260).snapshot;
  const Mat3 q = Eigen::AngleAxisd(0.7, Vec3(1, -2, 0.5).normalized()).toRotationMatrix();
  Snapshot turned = s;
  for (auto* vectors : {&turned.position, &turned.start, &turned.branch, &turned.tangential_force,
                        &turned.wall_contact_force, &turned.wall_contact_arm})
    for (Vec3& v : *vectors) v = q * v;
  for (const StressPart part : parts) {
    const auto before = particle_stresses(s, part), after = particle_stresses(turned, part);
    double scale = 0;
    for (const Stress& t : before) scale = std::max(scale, largest(t));
    for (std::size_t p = 0; p < before.size(); ++p) {
      expect_near(after[p], six(q * full(before[p]) * q.transpose()), 1e-13 * scale);
      EXPECT_NEAR(mean_stress(after[p]), mean_stress(before[p]), 1e-13 * scale);
      EXPECT_NEAR(von_mises_stress(after[p]), von_mises_stress(before[p]), 1e-13 * scale);
    }
  }
}

// What is read back is what was taken; branches come from positions again.
TEST(StoredSnapshot, ReadsBack) {
  auto closing = testing::cylinder_packing(1);
  closing.contact.sintering->closing_porosity = 0.3;
  for (const auto& shot : {packing(testing::periodic_packing(1), 260), packing(closing, 260)}) {
    const Snapshot& s = shot.snapshot;
    EXPECT_EQ(s.wall.empty(), s.local_density.empty());
    const testing::ScratchFolder folder;
    ResultFile file(folder.path(), {"", "", "", {}}, 0);
    file.add_snapshot(s);
    const Snapshot r = read_snapshot(Hdf5Reader(file.path()), "/snapshots/000000");
    EXPECT_EQ(r.moment.relative_density, s.moment.relative_density);
    EXPECT_EQ(r.moment.stage, "hold");
    EXPECT_EQ(r.materials, s.materials);
    EXPECT_EQ(r.id, s.id);
    EXPECT_EQ(r.position, s.position);
    EXPECT_EQ(r.angular_velocity, s.angular_velocity);
    EXPECT_EQ(r.stress, s.stress);
    EXPECT_EQ(r.local_density, s.local_density);
    EXPECT_EQ(r.flow_share, s.flow_share);
    EXPECT_EQ(r.start, s.start);
    EXPECT_EQ(r.branch, s.branch);
    EXPECT_EQ(r.tangential_force, s.tangential_force);
    EXPECT_EQ(r.sintering_force, s.sintering_force);
    EXPECT_EQ(r.phase, s.phase);
    EXPECT_EQ(r.since, s.since);
    EXPECT_EQ(r.wall.size(), s.wall.size());
    EXPECT_EQ(r.wall_contact_id, s.wall_contact_id);
    EXPECT_EQ(r.wall_contact_force, s.wall_contact_force);
    EXPECT_EQ(r.wall_contact_arm, s.wall_contact_arm);
    EXPECT_EQ(r.cell.periodic, s.cell.periodic);
    EXPECT_EQ(r.cell.h, s.cell.h);
    EXPECT_EQ(r.cell.velocity_gradient, s.cell.velocity_gradient);
    EXPECT_EQ(particle_stresses(r, StressPart::total), s.stress);
  }
}

// Results of before wall contacts were written.
TEST(StoredSnapshot, RefusesADieWithoutWallContacts) {
  const Snapshot s = packing(testing::cylinder_packing(1), 260).snapshot;
  const testing::ScratchFolder folder;
  ResultFile file(folder.path(), {"", "", "", {}}, 0);
  file.add_snapshot(s);
  Hdf5Writer old(folder / "old.h5");
  const Hdf5Reader now(file.path());
  old.attribute("/", "layout", std::uint64_t(1));
  for (const char* part : {"materials", "particles", "contacts", "walls"})
    old.copy(now, std::string("/snapshots/000000/") + part, std::string("/shot/") + part);
  for (const char* name : {"time", "temperature", "pressure", "relative_density"})
    old.attribute("/shot", name, now.attribute<double>("/snapshots/000000", name));
  old.attribute("/shot", "stage", "hold");
  old.commit(Durability::kill);
  EXPECT_NE(testing::message_of<InputError>([&] {
              read_snapshot(Hdf5Reader(folder / "old.h5"), "/shot");
            }).find("no contacts with walls"),
            std::string::npos);
}

// Each mistake of a file is named with the dataset.
TEST(StoredSnapshot, RefusesWhatDoesNotFit) {
  const Snapshot good = packing(testing::cylinder_packing(1), 260).snapshot;
  auto message = [&](auto&& spoil) {
    Snapshot s = good;
    spoil(s);
    const testing::ScratchFolder folder;
    ResultFile file(folder.path(), {"", "", "", {}}, 0);
    file.add_snapshot(s);
    return testing::message_of<FileError>([&] { read_snapshot(Hdf5Reader(file.path()), "/snapshots/000000"); });
  };
  auto expect = [&](const std::string& text, auto&& spoil) {
    EXPECT_NE(message(spoil).find(text), std::string::npos) << message(spoil);
  };
  expect("particles/radius: another length", [](Snapshot& s) { s.radius.pop_back(); });
  expect("particles/position: another length", [](Snapshot& s) { s.position.pop_back(); });
  expect("particles/id: a number beyond", [](Snapshot& s) { s.id.back() = 1000000000; });
  expect("particles/material: a number without", [](Snapshot& s) { s.material[0] = 2; });
  expect("contacts/first_id: a contact of no particle", [](Snapshot& s) { s.second_id[0] = 99; });
  expect("contacts/phase: a number without", [](Snapshot& s) { s.phase[0] = 8; });
  expect("wall_contacts/id: a contact of no particle", [](Snapshot& s) { s.wall_contact_id[0] = 99; });
  expect("wall_contacts/wall: a number without", [](Snapshot& s) { s.wall_contact_wall[0] = 3; });
}

}  // namespace
}  // namespace densify::dem
