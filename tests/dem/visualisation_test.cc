#include "dem/io/visualisation.h"

#include "base/check.h"
#include "tests/dem/scratch_folder.h"

using namespace densify;
using namespace densify::dem;
using namespace densify::dem::testing;

namespace {

/// Two particles and a neck between them.
Snapshot pair(double time) {
  Snapshot s;
  s.moment.time = time;
  s.has_necks = true;
  s.id = {0, 1};
  s.material = {0, 1};
  s.position = {Vec3(0, 0, 0), Vec3(2, 0, 0)};
  s.radius = {1, 1};
  s.velocity = {Vec3::Zero(), Vec3::Zero()};
  s.stress = {Stress{3, 0, 0, 0, 0, 0}, Stress{}};
  s.coordination = {1, 1};
  s.first_id = {0};
  s.second_id = {1};
  s.start = {Vec3::Zero()};
  s.branch = {Vec3(2, 0, 0)};
  s.normal_force = {-1};
  s.sintering_force = {0.5};
  s.neck_radius = {0.25};
  return s;
}

}  // namespace

// Base64 by hand: material holds 0, 1 after its length 2 as eight bytes, 02 00 .. 00 | 00 01, so "AgAAAAAAAAAAAQ==";
// the neck radius 0.25f is 00 00 80 3e after 04 00 .. 00.  (All arrays are decoded in results_test.py.)
TEST(Visualisation, ArraysAreLengthAndContentInBase64) {
  const ScratchFolder folder;
  write_particles_vtp(folder / "p.vtp", pair(0), StressFields::left_out);
  const std::string particles = content_of(folder / "p.vtp");
  EXPECT_NE(particles.find("NumberOfPoints=\"2\" NumberOfVerts=\"2\""), std::string::npos);
  EXPECT_NE(particles.find("Name=\"material\" NumberOfComponents=\"1\" format=\"binary\">AgAAAAAAAAAAAQ==<"),
            std::string::npos);
  write_contacts_vtp(folder / "c.vtp", pair(0), StressFields::left_out);
  const std::string contacts = content_of(folder / "c.vtp");
  EXPECT_NE(contacts.find("NumberOfPoints=\"2\" NumberOfVerts=\"0\" NumberOfLines=\"1\""), std::string::npos);
  EXPECT_NE(contacts.find("Name=\"neck_radius\" NumberOfComponents=\"1\" format=\"binary\">BAAAAAAAAAAAAIA+<"),
            std::string::npos);
}

// A periodic cell has its twelve edges beside the particles, a specimen without one has no such files.
TEST(Visualisation, EdgesOfAPeriodicCell) {
  const ScratchFolder folder;
  Snapshot s = pair(0);
  Visualisation(folder / "free", 0, StressFields::left_out).add(s);
  EXPECT_FALSE(std::filesystem::exists(folder / "free/cell.pvd"));
  s.cell.periodic = true;
  s.cell.h = 4 * Mat3::Identity();
  Visualisation(folder / "periodic", 0, StressFields::left_out).add(s);
  EXPECT_NE(content_of(folder / "periodic/cell.pvd").find("file=\"cell_000000.vtp\""), std::string::npos);
  const std::string cell = content_of(folder / "periodic/cell_000000.vtp");
  EXPECT_NE(cell.find("NumberOfPoints=\"24\" NumberOfVerts=\"0\" NumberOfLines=\"12\""), std::string::npos);
  // The first edge, (0 0 0) to (4 0 0), after the length 576 = 40 02 00 ..: 4.0 is 00 00 00 00 00 00 10 40.
  EXPECT_NE(cell.find("Name=\"Points\" NumberOfComponents=\"3\" format=\"binary\">"
                      "QAIAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAQQAAA"),
            std::string::npos);
}

// Without necks there is no array for them.
TEST(Visualisation, OnlyFeaturesInUse) {
  const ScratchFolder folder;
  Snapshot s = pair(0);
  s.has_necks = false;
  write_contacts_vtp(folder / "c.vtp", s, StressFields::written);
  EXPECT_EQ(content_of(folder / "c.vtp").find("neck_"), std::string::npos);
  write_particles_vtp(folder / "p.vtp", s, StressFields::written);
  EXPECT_NE(content_of(folder / "p.vtp").find("\"stress\""), std::string::npos);
  EXPECT_EQ(content_of(folder / "p.vtp").find("sintering"), std::string::npos);
}

// Stress fields stand behind the other arrays and only when they are asked for; a contact without neck has none.
// (Values are decoded in results_test.py.)
TEST(Visualisation, StressFieldsWhenAskedFor) {
  const ScratchFolder folder;
  Snapshot s = pair(0);
  s.phase = {std::uint8_t(NeckPhase::sintering)};
  write_particles_vtp(folder / "without", s, StressFields::left_out);
  write_particles_vtp(folder / "with", s, StressFields::written);
  for (const char* name : {"\"stress\"", "\"sintering_mean_stress\"", "\"viscoelastic_mean_stress\""}) {
    EXPECT_EQ(content_of(folder / "without").find(name), std::string::npos) << name;
    EXPECT_NE(content_of(folder / "with").find(name), std::string::npos) << name;
  }
  write_contacts_vtp(folder / "without", s, StressFields::left_out);
  EXPECT_EQ(content_of(folder / "without").find("neck_stress"), std::string::npos);
  s.phase = {std::uint8_t(NeckPhase::loose)};
  write_contacts_vtp(folder / "loose", s, StressFields::written);
  // NaN is 00 00 c0 7f after the length 04 00 .. 00.
  EXPECT_NE(content_of(folder / "loose")
                .find("Name=\"neck_stress\" NumberOfComponents=\"1\" format=\"binary\">BAAAAAAAAAAAAMB/<"),
            std::string::npos);
}

// The pictures of a run that was killed after its second and resumed after its first are those of a run in one go.
TEST(Visualisation, ResumesItsCollections) {
  const ScratchFolder folder;
  Visualisation whole(folder / "whole", 0, StressFields::left_out);
  for (double time : {0.0, 0.1, 1e-7}) whole.add(pair(time));
  {
    Visualisation killed(folder / "cut", 0, StressFields::left_out);
    for (double time : {0.0, 5.0}) killed.add(pair(time));
  }
  Visualisation resumed(folder / "cut", 1, StressFields::left_out);
  EXPECT_EQ(resumed.pictures(), 1u);
  for (double time : {0.1, 1e-7}) resumed.add(pair(time));
  for (const char* name : {"particles.pvd", "contacts.pvd", "particles_000002.vtp"})
    EXPECT_EQ(content_of(folder / ("cut/" + std::string(name))), content_of(folder / ("whole/" + std::string(name))))
        << name;
  EXPECT_NE(content_of(folder / "cut/contacts.pvd").find("timestep=\"0.1\" part=\"0\" file=\"contacts_000001.vtp\""),
            std::string::npos);
  EXPECT_NE(
      message_of<InputError>([&] { Visualisation(folder / "cut", 4, StressFields::left_out); }).find("fewer pictures"),
      std::string::npos);
}
