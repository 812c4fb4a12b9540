#include "dem/io/particle_import.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <functional>

#include "base/check.h"

using namespace densify;
using namespace densify::dem;

namespace {

constexpr double um = 1e-6;

/// A file in the test's own folder with the given text.
std::string write(const std::string& text) {
  const auto* test = testing::UnitTest::GetInstance()->current_test_info();
  const std::string path =
      testing::TempDir() + "densify_import_" + test->test_suite_name() + "_" + test->name() + ".txt";
  std::ofstream(path) << text;
  return path;
}

std::string message(const std::function<void()>& f) {
  try {
    f();
  } catch (const InputError& e) {
    return e.what();
  }
  return "accepted";
}

/// The message names the line ("<file>:<line>: ", or no line for 0) and says `part`.
void expect_refused(ImportedParticles (*read)(const std::filesystem::path&, double), const std::string& text, int line,
                    const std::string& part) {
  const std::string file = write(text), got = message([&] { read(file, um); });
  const std::string start = file + ":" + (line > 0 ? std::to_string(line) + ":" : "") + " ";
  EXPECT_EQ(got.substr(0, start.size()), start) << got;
  EXPECT_NE(got.find(part), got.npos) << got;
}

void table_refused(const std::string& text, int line, const std::string& part) {
  expect_refused(read_particle_table, text, line, part);
}

void lammps_refused(const std::string& text, int line, const std::string& part) {
  expect_refused(read_lammps_data, text, line, part);
}

const std::string lammps_header =
    "title\n\n2 atoms\n1 atom types\n\n0 10 xlo xhi\n-1 9 ylo yhi\n2 12 zlo zhi\n\nAtoms\n\n";

}  // namespace

// Commas or blanks, any order of columns, comments, empty lines, Windows line ends: the same two particles in metres.
TEST(ParticleTable, ReadsCommasAndBlanks) {
  for (const char* text :
       {"x,y,z,radius,material\n1, 2,+3e0,0.5,NiAl\n\n-4,5,6,1.5, Al2O3\n",
        "# from elsewhere\r\nmaterial radius z y x\r\nNiAl 0.5 3 2 1 # first\r\nAl2O3\t1.5 6 5 -4"}) {
    const ImportedParticles p = read_particle_table(write(text), um);
    ASSERT_EQ(p.size(), 2u);
    EXPECT_TRUE(p.position[0].isApprox(Vec3(1, 2, 3) * um, 1e-15));
    EXPECT_TRUE(p.position[1].isApprox(Vec3(-4, 5, 6) * um, 1e-15));
    EXPECT_DOUBLE_EQ(p.radius[1], 1.5 * um);
    EXPECT_EQ(p.material, (std::vector<std::string>{"NiAl", "Al2O3"}));
    EXPECT_FALSE(p.box);
  }
  EXPECT_EQ(read_particle_table(write("x y z radius material\n\n0 0 0 1 a\n"), 1).line[0], 3);
}

TEST(ParticleTable, RefusesMissingFile) {
  const std::string got = message([] { read_particle_table("no_such_folder/particles.csv", 1); });
  EXPECT_NE(got.find("no_such_folder/particles.csv: the particle file cannot be read"), got.npos) << got;
}

TEST(ParticleTable, RefusesFolder) {
  EXPECT_NE(message([] { read_particle_table(testing::TempDir(), 1); }).find("cannot be read"), std::string::npos);
}

TEST(ParticleTable, RefusesEmptyFile) {
  table_refused("\n# nothing\n", 0, "empty");
}
TEST(ParticleTable, RefusesHeaderAlone) {
  table_refused("x y z radius material\n", 0, "no particles");
}
TEST(ParticleTable, RefusesUnknownColumn) {
  table_refused("x y z diameter material\n", 1, "unknown column 'diameter'");
}
TEST(ParticleTable, RefusesMissingColumn) {
  table_refused("x y z material\n", 1, "'radius' must be named exactly once");
}
TEST(ParticleTable, RefusesRepeatedColumn) {
  table_refused("x x y z radius material\n", 1, "'x' must be named");
}
TEST(ParticleTable, RefusesTooFewColumns) {
  table_refused("x y z radius material\n0 0 0 1 a\n0 0 1 a\n", 3, "4 columns; the header names 5");
}
TEST(ParticleTable, RefusesTooManyColumns) {
  table_refused("x,y,z,radius,material\n0,0,0,1,a,7\n", 2, "6 columns; the header names 5");
}
TEST(ParticleTable, RefusesNaN) {
  table_refused("x y z radius material\n0 nan 0 1 a\n", 2, "y: 'nan' is not a finite");
}
TEST(ParticleTable, RefusesInfinity) {
  table_refused("x y z radius material\n0 0 -inf 1 a\n", 2, "z: '-inf' is not a");
}
TEST(ParticleTable, RefusesOverflow) {
  table_refused("x y z radius material\n1e999 0 0 1 a\n", 2, "not a finite");
}
TEST(ParticleTable, RefusesWord) {
  table_refused("x y z radius material\n0 0 1.2.3 1 a\n", 2, "z: '1.2.3' is not a number");
}
TEST(ParticleTable, RefusesEmptyField) {
  table_refused("x,y,z,radius,material\n0,,0,1,a\n", 2, "y: '' is not a number");
}
TEST(ParticleTable, RefusesEmptyMaterial) {
  table_refused("x,y,z,radius,material\n0,0,0,1,\n", 2, "material");
}
TEST(ParticleTable, RefusesNegativeRadius) {
  table_refused("x y z radius material\n0 0 0 -1 a\n", 2, "radius: -1 is not above");
}
TEST(ParticleTable, RefusesZeroRadius) {
  table_refused("x y z radius material\n0 0 0 0 a\n", 2, "radius: 0 is not above");
}
TEST(ParticleTable, RefusesInfiniteRadius) {
  table_refused("x y z radius material\n0 0 0 inf a\n", 2, "radius: 'inf'");
}

// Diameters become radii, types become material names, the box a periodic cell with its tilts above the diagonal.
TEST(LammpsData, ReadsAtomsAndBox) {
  const std::string text =
      "Atoms in a title\n\n2 atoms\n3 atom types\n0 10 xlo xhi\n-1 9 ylo yhi\n2 12 zlo zhi\n1 -2 3 xy xz yz\n\n"
      "Masses\n\n1 1.0\n2 1.0\n\nAtoms # sphere\n\n7 1 2.0 1.0 1 2 3\n3 3 4.0 1.0 4 5 6 0 -1 0\n\nVelocities\n\n7 0 0 "
      "0\n";
  const ImportedParticles p = read_lammps_data(write(text), um);
  ASSERT_EQ(p.size(), 2u);
  EXPECT_TRUE(p.position[1].isApprox(Vec3(4, 5, 6) * um, 1e-15));
  EXPECT_DOUBLE_EQ(p.radius[0], 1 * um);
  EXPECT_EQ(p.material, (std::vector<std::string>{"1", "3"}));
  EXPECT_EQ(p.line, (std::vector<int>{17, 18}));
  ASSERT_TRUE(p.box);
  Mat3 h;
  h << 10, 1, -2, 0, 10, 3, 0, 0, 10;
  EXPECT_TRUE(p.box->periodic);
  EXPECT_TRUE(p.box->h.isApprox(h * um, 1e-15));
  EXPECT_TRUE(p.box->origin.isApprox(Vec3(0, -1, 2) * um, 1e-15));
}

TEST(LammpsData, ReadsFileWithoutBox) {
  EXPECT_FALSE(read_lammps_data(write("t\n1 atoms\nAtoms\n\n1 1 2 1 0 0 0\n"), um).box);
}

TEST(LammpsData, RefusesMissingFile) {
  EXPECT_NE(message([] { read_lammps_data("no_such_folder/a.data", 1); }).find("cannot be read"), std::string::npos);
}
TEST(LammpsData, RefusesFileWithoutAtoms) {
  lammps_refused("x,y,z,radius,material\n0,0,0,1,a\n", 0, "no section Atoms");
}
TEST(LammpsData, RefusesMissingDeclaration) {
  lammps_refused("t\n\nAtoms\n\n1 1 2 1 0 0 0\n", 3, "does not declare");
}
TEST(LammpsData, RefusesZeroAtoms) {
  lammps_refused("t\n0 atoms\nAtoms\n", 2, "declares 0 atoms");
}
TEST(LammpsData, RefusesNegativeAtoms) {
  lammps_refused("t\n-5 atoms\nAtoms\n", 2, "declares -5 atoms");
}
TEST(LammpsData, RefusesFractionalAtoms) {
  lammps_refused("t\n1.5 atoms\nAtoms\n", 2, "'1.5' is not an integer");
}
TEST(LammpsData, RefusesTruncatedFile) {
  lammps_refused(lammps_header + "1 1 2 1 0 0 0\n", 12, "truncated: 2 atoms are declared in line 3, 1 found");
}
TEST(LammpsData, RefusesSectionThatEndsEarly) {
  lammps_refused(lammps_header + "1 1 2 1 0 0 0\n\nVelocities\n", 14, "truncated");
}
TEST(LammpsData, RefusesTruncatedRow) {
  lammps_refused(lammps_header + "1 1 2 1 0 0 0\n2 1 2 1 5 5", 13, "6 columns; expected 7");
}
TEST(LammpsData, RefusesMoreAtomsThanDeclared) {
  lammps_refused(lammps_header + "1 1 2 1 0 0 0\n2 1 2 1 5 5 5\n3 1 2 1 5 5 9\n", 14, "more atoms than the 2 declared");
}
TEST(LammpsData, RefusesRepeatedId) {
  lammps_refused(lammps_header + "1 1 2 1 0 0 0\n1 1 2 1 5 5 5\n", 13, "id 1 was already used in line 12");
}
TEST(LammpsData, RefusesOtherStyle) {
  lammps_refused("t\n1 atoms\nAtoms # atomic\n\n1 1 0 0 0\n", 3, "'atomic'");
}
TEST(LammpsData, RefusesNaN) {
  lammps_refused(lammps_header + "1 1 2 1 0 nan 0\n", 12, "y: 'nan' is not a finite");
}
TEST(LammpsData, RefusesInfinity) {
  lammps_refused(lammps_header + "1 1 2 1 inf 0 0\n", 12, "x: 'inf' is not a finite");
}
TEST(LammpsData, RefusesWord) {
  lammps_refused(lammps_header + "1 1 2 1 0 0 0x\n", 12, "z: '0x' is not a number");
}
TEST(LammpsData, RefusesFractionalType) {
  lammps_refused(lammps_header + "1 1.5 2 1 0 0 0\n", 12, "type: '1.5'");
}
TEST(LammpsData, RefusesNegativeDiameter) {
  lammps_refused(lammps_header + "1 1 -2 1 0 0 0\n", 12, "diameter: -2 is not");
}
TEST(LammpsData, RefusesZeroDiameter) {
  lammps_refused(lammps_header + "1 1 0 1 0 0 0\n", 12, "diameter: 0 is not");
}
TEST(LammpsData, RefusesBoxWithoutExtent) {
  lammps_refused("t\n1 atoms\n1 1 xlo xhi\nAtoms\n", 3, "no extent");
}
TEST(LammpsData, RefusesIncompleteBox) {
  lammps_refused("t\n1 atoms\n0 1 xlo xhi\nAtoms\n\n", 4, "box is incomplete");
}

// Spheres of radius 1 and 2, centres 2.9 apart: the overlap 0.1 is 0.1 of the smaller radius.
TEST(RejectOverlaps, NamesTheWorstPair) {
  const ImportedParticles p =
      read_particle_table(write("x y z radius material\n0 0 0 1 a\n2.9 0 0 2 a\n-1.99 0 0 1 a\n100 0 0 1 a\n"), 1);
  EXPECT_NO_THROW(reject_overlaps(p, Cell{}, 0.11));
  const std::string got = message([&] { reject_overlaps(p, Cell{}, 0.005); });
  EXPECT_NE(got.find(p.file + ":2: the particle overlaps the one in line 3 by 0.1 of the smaller radius"), got.npos)
      << got;
}

// Across the face of a periodic cell of edge 10, with centres given outside it: 9.5 + 10 and 0.9 are 1.4 apart.
TEST(RejectOverlaps, SeesPeriodicImages) {
  const ImportedParticles p = read_particle_table(write("x y z radius material\n19.5 5 5 1 a\n0.9 5 5 1 a\n"), 1);
  Cell cell;
  EXPECT_NO_THROW(reject_overlaps(p, cell, 0));
  cell.periodic = true;
  cell.h = Mat3::Identity() * 10;
  EXPECT_NO_THROW(reject_overlaps(p, cell, 0.61));
  EXPECT_THROW(reject_overlaps(p, cell, 0.59), InputError);
}

// 1e57 edges away no digit is left that tells the place in the cell.
TEST(RejectOverlaps, FarFromTheCell) {
  ImportedParticles p;
  p.file = "far.csv";
  p.position = {Vec3(1, 1, 1), Vec3(5, 1e58, 5)};
  p.radius = {1, 1};
  p.line = {2, 3};
  Cell cell;
  cell.periodic = true;
  cell.h = 10 * Mat3::Identity();
  const std::string got = message([&] { reject_overlaps(p, cell, 0); });
  EXPECT_NE(got.find("far.csv:3: the particle is so far from the periodic cell"), std::string::npos) << got;
}
