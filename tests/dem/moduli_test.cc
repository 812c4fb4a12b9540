// What a packing is as a material: moduli, viscosities and sintering stress against closed forms and invariances.

#include "dem/network/moduli.h"

#include <algorithm>
#include <numeric>

#include "base/check.h"
#include "dem/io/result_file.h"
#include "tests/dem/scratch_folder.h"
#include "tests/dem/small_packings.h"
#include "tests/support/lattice_network.h"

namespace densify::dem {
namespace {

using test::Lattice;
using test::lattice_network;
using test::LatticeCase;

constexpr double youngs = 1e11, poisson = 0.3, shear = youngs / 2.6, radius = 5e-6, spacing = 9.5e-6;
const std::vector<Material> materials{test::copper()};
const ModuliSettings settings;

/// Springs (or dashpots) k along and t across every contact of length L.
Mat6 cubic(Lattice lattice, double k, double t, double l) {
  const double s3 = std::sqrt(3.0), s2 = std::sqrt(2.0);
  double c11 = s2 * (k + t) / l, c12 = (k - t) / (s2 * l), c44 = (k + t) / (s2 * l);
  if (lattice == Lattice::simple_cubic) c11 = k / l, c12 = 0, c44 = t / (2 * l);
  if (lattice == Lattice::body_centred)
    c11 = (k + 2 * t) / (s3 * l), c12 = (k - t) / (s3 * l), c44 = (k + t / 2) / (s3 * l);
  Mat6 c = Mat6::Zero();
  c.topLeftCorner<3, 3>().setConstant(c12);
  for (int a = 0; a < 3; ++a) c(a, a) = c11, c(a + 3, a + 3) = c44;
  return c;
}

double difference(const Mat6& a, const Mat6& b) {
  return (a - b).cwiseAbs().maxCoeff() / b.cwiseAbs().maxCoeff();
}

// Every site of SC, BCC and FCC is a centre of symmetry: nothing relaxes, no particle turns, and the closed forms of
// `cubic` hold for every contact model.
TEST(Moduli, ElasticLattices) {
  for (const Lattice lattice : {Lattice::simple_cubic, Lattice::body_centred, Lattice::face_centred}) {
    LatticeCase c;
    c.lattice = lattice;
    const SpecimenNetwork s = lattice_network(c);
    EXPECT_EQ(structure_of(s).directions, 3);
    for (const NeckModel model : all_neck_models) {
      const NeckHalf h{youngs, poisson, radius, 0.5 * spacing};
      const EdgeLaw l =
          model == NeckModel::normal_spring ? EdgeLaw{1e5, 0, 0} : neck_stiffness(model, h, h, 0.4 * radius, true);
      const TensorAnswer a = elastic_answer(s, materials, model, settings);
      const Mat6 exact = cubic(lattice, l.coefficient, l.lateral, spacing);
      EXPECT_LT(difference(a.response.affine, exact), 1e-12) << name_of(model);
      EXPECT_LT(difference(a.response.relaxed, exact), 1e-9) << name_of(model);
    }
  }
}

// Dashpots eta = pi a^4/(8 D_eff) (4.40), D_eff of copper at 1300 K from Table 5.1, and F_sint (4.36): the
// viscosity is the lattice's closed form, the sintering stress sum F L/(3 V), and the free rate of a cubic crystal
// stress over bulk viscosity, (C11 + 2 C12)/3.
TEST(Moduli, ViscousLattices) {
  const double a = 0.4 * radius, diffusion = 3.832e-19 * 1.18e-29 / (1.380649e-23 * 1300),
               eta = M_PI * std::pow(a, 4) / (8 * diffusion), psi = 146 * M_PI / 180;
  const double f = M_PI * 1.72 * (4 * radius * (1 - std::cos(psi / 2)) + a * std::sin(psi / 2));
  for (const Lattice lattice : {Lattice::simple_cubic, Lattice::body_centred, Lattice::face_centred})
    for (const SinteringModel model : {SinteringModel::viscoelastic, SinteringModel::viscous}) {
      LatticeCase c;
      c.lattice = lattice, c.model = model, c.phase = NeckPhase::sintering;
      const SpecimenNetwork s = lattice_network(c);
      ModuliSettings with = settings;
      with.tangential_viscosity = 0.3;
      const ViscousAnswer v = viscous_answer(s, with);
      const Mat6 exact = cubic(lattice, eta, 0.3 * eta, spacing);
      EXPECT_LT(difference(v.viscosity.response.relaxed, exact), 1e-9);
      const double stress = f * spacing * double(s.network.edges.size()) / (3 * s.volume);
      for (int k = 0; k < 6; ++k) EXPECT_NEAR(v.sintering_stress[k] / stress, k < 3 ? 1 : 0, 1e-9);
      EXPECT_NEAR(v.densification_rate / (3 * stress / (exact(0, 0) + 2 * exact(0, 1))), 1, 2e-9);
      EXPECT_EQ(v.flowing, s.network.edges.size());
    }
}

LatticeCase shaken(int cells) {
  LatticeCase c;
  c.cells = cells, c.shaken = 0.08;
  return c;
}

// Affine estimate: the isotropic part of any network is K = sum k L^2/(9 V), G = sum (2 k + 3 t) L^2/(30 V); for N
// spheres of diameter L and coordination Z that is K = Z phi k/(3 pi d), G = Z phi (2 k + 3 t)/(10 pi d).
TEST(Moduli, AffineEstimate) {
  const SpecimenNetwork s = lattice_network(shaken(2));
  ModuliSettings with = settings;
  with.tangential = 0.6;
  const TensorAnswer a = elastic_answer(s, materials, NeckModel::normal_spring, with);
  double squares = 0;
  for (const auto& e : s.network.edges) squares += e.branch.squaredNorm();
  EXPECT_NEAR(a.affine.bulk / (1e5 * squares / (9 * s.volume)), 1, 1e-12);
  EXPECT_NEAR(a.affine.shear / ((2 + 3 * 0.6) * 1e5 * squares / (30 * s.volume)), 1, 1e-12);
  LatticeCase c;
  const SpecimenNetwork crystal = lattice_network(c);
  const TensorAnswer exact = elastic_answer(crystal, materials, NeckModel::normal_spring, with);
  const double phi = double(crystal.network.particles) * M_PI * std::pow(spacing, 3) / (6 * crystal.volume);
  EXPECT_NEAR(exact.affine.bulk / (12 * phi * 1e5 / (3 * M_PI * spacing)), 1, 1e-12);
  EXPECT_NEAR(exact.affine.shear / (12 * phi * 1e5 * (2 + 3 * 0.6) / (10 * M_PI * spacing)), 1, 1e-12);
}

Mat6 relaxed(const SpecimenNetwork& s, NeckModel model) {
  return elastic_answer(s, materials, model, settings).response.relaxed;
}

// A rotated packing has the rotated tensor.
TEST(Moduli, Rotation) {
  const SpecimenNetwork s = lattice_network(shaken(2));
  const Mat3 q = Eigen::AngleAxisd(0.7, Vec3(1, -2, 0.5).normalized()).toRotationMatrix();
  SpecimenNetwork turned = s;
  turned.cell.h = q * s.cell.h;
  for (auto& x : turned.position) x = q * x;
  for (auto& e : turned.network.edges) e.normal = q * e.normal, e.branch = q * e.branch;
  for (const NeckModel model : all_neck_models)
    EXPECT_LT(difference(relaxed(turned, model), rotated(relaxed(s, model), q)), 1e-9) << name_of(model);
  EXPECT_NEAR(isotropic_part(rotated(relaxed(s, NeckModel::series), q)).shear /
                  isotropic_part(relaxed(s, NeckModel::series)).shear,
              1, 1e-12);
}

// Twice as large in all lengths: the moduli of necks stay (k ~ a), viscosities grow eightfold (eta ~ a^4), the
// sintering stress is halved.
TEST(Moduli, Scaling) {
  LatticeCase c = shaken(2);
  c.phase = NeckPhase::sintering;
  const SpecimenNetwork s = lattice_network(c);
  c.spacing *= 2, c.radius *= 2;
  const SpecimenNetwork large = lattice_network(c);
  for (const NeckModel model : {NeckModel::bonded_neck, NeckModel::neck_beam, NeckModel::series})
    EXPECT_LT(difference(relaxed(large, model), relaxed(s, model)), 1e-9) << name_of(model);
  const ViscousAnswer v = viscous_answer(s, settings), w = viscous_answer(large, settings);
  EXPECT_LT(difference(w.viscosity.response.relaxed, 8 * v.viscosity.response.relaxed), 1e-9);
  EXPECT_LT((2 * w.sintering_stress - v.sintering_stress).norm() / v.sintering_stress.norm(), 1e-9);
}

TEST(Moduli, Renumbering) {
  const SpecimenNetwork s = lattice_network(shaken(2));
  std::vector<std::uint32_t> place(s.network.particles);
  std::iota(place.begin(), place.end(), 0u);
  std::shuffle(place.begin(), place.end(), std::mt19937(5));
  SpecimenNetwork other = s;
  for (std::size_t p = 0; p < place.size(); ++p) other.position[place[p]] = s.position[p];
  for (auto& e : other.network.edges) {
    e.i = place[e.i], e.j = place[e.j];
    if (e.i % 3 != 0) continue;  // some the other way round
    std::swap(e.i, e.j);
    e.lever = e.branch.norm() - e.lever;
    e.normal = -e.normal, e.branch = -e.branch;
  }
  std::reverse(other.network.edges.begin(), other.network.edges.end());
  for (const NeckModel model : all_neck_models)
    EXPECT_LT(difference(relaxed(other, model), relaxed(s, model)), 1e-9) << name_of(model);
}

/// The same cell two times along each edge.
SpecimenNetwork eightfold(const SpecimenNetwork& s) {
  SpecimenNetwork all = s;
  all.cell.h *= 2;
  all.volume *= 8;
  all.network.edges.clear();
  all.far_radius.clear(), all.far_material.clear();
  const std::size_t n = s.network.particles;
  auto copy = [&](const Eigen::Vector3i& c) { return n * std::size_t((c[0] & 1) * 4 + (c[1] & 1) * 2 + (c[2] & 1)); };
  all.network.particles = 8 * n;
  all.position.resize(8 * n), all.radius.resize(8 * n), all.material.resize(8 * n);
  for (int k = 0; k < 8; ++k) {
    const Eigen::Vector3i c(k >> 2, (k >> 1) & 1, k & 1);
    for (std::size_t p = 0; p < n; ++p) {
      all.position[copy(c) + p] = s.position[p] + s.cell.h * c.cast<double>();
      all.radius[copy(c) + p] = s.radius[p], all.material[copy(c) + p] = s.material[p];
    }
    for (NetworkEdge e : s.network.edges) {
      const Vec3 across = s.cell.h.inverse() * (s.position[e.i] + e.branch - s.position[e.j]);
      const Eigen::Vector3i image = across.array().round().cast<int>();
      e.i = std::uint32_t(copy(c) + e.i), e.j = std::uint32_t(copy(c + image) + e.j);
      all.network.edges.push_back(e);
      all.far_radius.push_back(s.radius[0]), all.far_material.push_back(0);
    }
  }
  return all;
}

// A network two times along each edge is the same material; the large one goes through multigrid.
TEST(Moduli, Replication) {
  const SpecimenNetwork s = lattice_network(shaken(3)), all = eightfold(s);
  EXPECT_EQ(structure_of(all).islands, 1u);
  for (const NeckModel model : all_neck_models)
    EXPECT_LT(difference(relaxed(all, model), relaxed(s, model)), 1e-8) << name_of(model);
  LatticeCase c = shaken(3);
  c.phase = NeckPhase::sintering;
  const SpecimenNetwork soft = lattice_network(c);
  const ViscousAnswer v = viscous_answer(soft, settings), w = viscous_answer(eightfold(soft), settings);
  EXPECT_LT(difference(w.viscosity.response.relaxed, v.viscosity.response.relaxed), 1e-8);
  EXPECT_NEAR(w.densification_rate / v.densification_rate, 1, 1e-8);
}

// Multigrid over several levels and a factorisation give the same; both kinds of node.
TEST(Moduli, MultigridAgainstFactorisation) {
  const SpecimenNetwork s = eightfold(lattice_network(shaken(2)));
  for (const Rotation rotation : {Rotation::held, Rotation::free}) {
    auto law = [](const NetworkEdge& e) { return EdgeLaw{1e5 * (1 + e.normal[0]), 3e4, 0, 1e-7, 1e-7}; };
    const CellResponse whole = probe_cell(s.network, law, {s.volume, 1e-10, rotation, 1000000});
    const CellResponse levels = probe_cell(s.network, law, {s.volume, 1e-10, rotation, 0});
    EXPECT_LT(whole.iterations, 10);
    EXPECT_GT(levels.iterations, whole.iterations);
    EXPECT_LT(levels.iterations, 60);
    EXPECT_LT(difference(levels.relaxed, whole.relaxed), 1e-9);
  }
}

/// Two spheres in a row along z, with contacts of stiffness k1 and k2 in turn, in a cell of cross-section A.
SpecimenNetwork chain(double l1, double l2, double area) {
  SpecimenNetwork s;
  s.cell.periodic = true;
  s.cell.h = Vec3(std::sqrt(area), std::sqrt(area), l1 + l2).asDiagonal();
  s.volume = s.cell.volume();
  s.time = 0;
  s.position = {Vec3::Zero(), Vec3(0, 0, l1)};
  s.radius = {radius, radius}, s.material = {0, 0}, s.far_radius = s.radius, s.far_material = {0, 0};
  s.network.particles = 2;
  NetworkEdge e{0, 1, false, 0, Vec3::UnitZ(), l1 * Vec3::UnitZ(), 0, 0, 0.5 * l1, {}};
  s.network.edges.push_back(e);
  e.i = 1, e.j = 0, e.branch = l2 * Vec3::UnitZ(), e.lever = 0.5 * l2;
  s.network.edges.push_back(e);
  return s;
}

// Springs in series: C33 = (l1 + l2)/(A (1/k1 + 1/k2)); affine (k1 l1^2 + k2 l2^2)/V.
TEST(Moduli, ChainOfTwoSpheres) {
  const double l1 = 9e-6, l2 = 7e-6, area = 1e-10, k1 = 1e5, k2 = 3e5;
  const SpecimenNetwork s = chain(l1, l2, area);
  const CellResponse r = probe_cell(s.network,
                                    [&](const NetworkEdge& e) {
                                      return EdgeLaw{e.i == 0 ? k1 : k2, 0, 0};
                                    },
                                    {s.volume, 1e-10, Rotation::held, 100});
  EXPECT_NEAR(r.relaxed(2, 2) / ((l1 + l2) / (area * (1 / k1 + 1 / k2))), 1, 1e-9);
  EXPECT_NEAR(r.affine(2, 2) / ((k1 * l1 * l1 + k2 * l2 * l2) / s.volume), 1, 1e-12);
  EXPECT_LT(r.relaxed.topLeftCorner(6, 2).cwiseAbs().maxCoeff() / r.relaxed(2, 2), 1e-12);
  const NetworkStructure n = structure_of(s);
  EXPECT_EQ(n.directions, 1);
  EXPECT_EQ(n.coordination, 2);
  EXPECT_NEAR(n.fabric(2, 2), 1, 1e-15);
  EXPECT_THROW(require_percolation(s, n), InputError);
}

// A straight chain of springs resists being pulled.  One that zigzags resists nothing, for two forces that are not
// parallel cannot balance: of its six motions only two meet a spring.
TEST(Moduli, FloppyNetwork) {
  SpecimenNetwork s = chain(9e-6, 9e-6, 1e-10);
  auto law = [](const NetworkEdge&) { return EdgeLaw{1e5, 0, 0}; };
  const ProbeSettings probe{s.volume, 1e-10, Rotation::held, 100};
  EXPECT_FALSE(probe_cell(s.network, law, probe).floppy);
  EXPECT_EQ(count_soft_modes(s.network, law, Rotation::held, 1e-9), 5u);
  const Vec3 aside(2e-6, 0, 0);
  s.network.edges[0].branch += aside, s.network.edges[1].branch -= aside;
  for (auto& e : s.network.edges) e.normal = e.branch.normalized();
  EXPECT_TRUE(probe_cell(s.network, law, probe).floppy);
  EXPECT_EQ(count_soft_modes(s.network, law, Rotation::held, 1e-9), 4u);
}

// A region whose edges end at contact points that move with it: one sphere of a simple cubic crystal, six half contacts
// of stiffness 2 k and length L/2, is the crystal.
TEST(Moduli, RegionOfHalvedContacts) {
  Network n;
  n.particles = 1;
  for (int axis = 0; axis < 3; ++axis)
    for (const double side : {-1.0, 1.0}) {
      const Vec3 normal = side * Vec3::Unit(axis);
      n.edges.push_back({0, 0, true, 0, normal, 0.5 * spacing * normal, 0, 0, 0.5 * spacing, {}});
    }
  const double k = 1e5, t = 3e4;
  for (const Rotation rotation : {Rotation::held, Rotation::free}) {
    const CellResponse r = probe_cell(n,
                                      [&](const NetworkEdge&) {
                                        return EdgeLaw{2 * k, 2 * t, 0, 1e-7, 1e-7};
                                      },
                                      {std::pow(spacing, 3), 1e-10, rotation, 100});
    EXPECT_LT(difference(r.relaxed, cubic(Lattice::simple_cubic, k, t, spacing)), 1e-12);
    require_sound(r, 1e-9);
  }
}

// Isotropic C of K and G: the parts come back, no anisotropy; SC with C11 = 2, C12 = 0, C44 = 0.5: K = 2/3,
// G = (2 + 3 x 0.5)/5 = 0.7, G_R = 5/(4/2 + 3/0.5) = 0.625, universal index 5 x 0.7/0.625 + 1 - 6 = 0.6.
TEST(IsotropicPart, ClosedForms) {
  Mat6 c = Mat6::Zero();
  c.topLeftCorner<3, 3>().setConstant(3.0 - 2.0 / 3 * 1.5);
  for (int a = 0; a < 3; ++a) c(a, a) = 3.0 + 4.0 / 3 * 1.5, c(a + 3, a + 3) = 1.5;
  const IsotropicPart p = isotropic_part(c);
  EXPECT_NEAR(p.bulk, 3, 1e-14);
  EXPECT_NEAR(p.shear, 1.5, 1e-14);
  EXPECT_NEAR(p.youngs, 27.0 / 7, 1e-14);
  EXPECT_NEAR(p.poisson, 2.0 / 7, 1e-14);
  EXPECT_NEAR(p.distance, 0, 1e-14);
  EXPECT_NEAR(p.universal, 0, 1e-13);
  const IsotropicPart sc = isotropic_part((Vec6() << 2, 2, 2, 0.5, 0.5, 0.5).finished().asDiagonal());
  EXPECT_NEAR(sc.bulk, 2.0 / 3, 1e-14);
  EXPECT_NEAR(sc.shear, 0.7, 1e-14);
  EXPECT_NEAR(sc.universal, 0.6, 1e-13);
}

// The checks of every call, each by a response that breaks it.
TEST(Moduli, ChecksRefuse) {
  CellResponse r;
  r.relaxed.setIdentity();
  require_sound(r, 1e-6);
  for (double CellResponse::*figure : {&CellResponse::asymmetry, &CellResponse::power_mismatch}) {
    CellResponse bad = r;
    bad.*figure = 2e-6;
    EXPECT_THROW(require_sound(bad, 1e-6), RunError);
  }
  CellResponse bad = r;
  bad.smallest_eigenvalue = -2e-6;
  EXPECT_THROW(require_sound(bad, 1e-6), RunError);
  bad.smallest_eigenvalue = 0;
  bad.relaxed(0, 0) = NAN;
  EXPECT_THROW(require_sound(bad, 1e-6), RunError);
}

// The network of a snapshot is that of the simulation it was taken of: two materials, necks in transition,
// pores that resist or not.
TEST(Moduli, OfASnapshot) {
  for (const auto make : {testing::periodic_packing, testing::closing_packing}) {
    Simulation simulation(make(1));
    testing::run_steps(simulation, 260);
    ASSERT_TRUE(simulation.table().any_active());
    const State before = simulation.state();
    Recording recording;
    simulation.evaluate(&recording);
    const SpecimenNetwork live = network_of(simulation);
    const testing::ScratchFolder folder;
    ResultFile file(folder.path(), {"", "", "", {}}, 0);
    file.add_snapshot(take_snapshot(simulation, recording,
                                    {before.time, simulation.temperature(), 0, live.relative_density, "press"}));
    Scene scene;
    scene.materials = simulation.setup().materials, scene.interfaces = simulation.setup().interfaces;
    scene.contact = simulation.setup().contact;
    scene.integration.mass_scaling = simulation.setup().integration.mass_scaling;
    const Hdf5Reader reader(file.path());
    const auto moments = stored_moments(reader);
    ASSERT_EQ(moments.size(), 1u);
    const SpecimenNetwork stored = read_network(reader, scene, moments[0]);
    ASSERT_EQ(stored.network.edges.size(), live.network.edges.size());
    for (const NeckModel model : all_neck_models) {
      const auto of = [&](const SpecimenNetwork& s) {
        return elastic_answer(s, scene.materials, model, settings).response.affine;
      };
      EXPECT_LT(difference(of(stored), of(live)), 1e-12) << name_of(model);
    }
    const ViscousAnswer v = viscous_answer(stored, settings), w = viscous_answer(live, settings);
    EXPECT_LT(difference(v.viscosity.response.affine, w.viscosity.response.affine), 1e-12);
    EXPECT_LT((v.affine_sintering_stress - w.affine_sintering_stress).norm() / w.affine_sintering_stress.norm(), 1e-12);
  }
}

// What the viscous answer calls rigid is cut where it says: one bonded neck among flowing ones, at the median's 1e4.
TEST(Moduli, RigidContacts) {
  LatticeCase c = shaken(2);
  c.phase = NeckPhase::sintering;
  SpecimenNetwork s = lattice_network(c);
  s.network.edges[7].law.viscosity = std::numeric_limits<double>::infinity();
  const ViscousAnswer v = viscous_answer(s, settings);
  EXPECT_EQ(v.rigid, 1u);
  EXPECT_EQ(v.flowing, s.network.edges.size() - 1);
  ModuliSettings stiffer = settings;
  stiffer.rigid *= 10;
  EXPECT_LT(difference(viscous_answer(s, stiffer).viscosity.response.relaxed, v.viscosity.response.relaxed), 1e-4);
}

// A small particle between two images of a large one, off their line by an angle of 2e-4: the pull of its two contacts
// holds it in line, so that they carry as two dashpots eta in series over the edge L, N_11 = eta/(2 L), and the
// sintering force F as sigma_s,11 = F/L^2.  The network at that moment alone lets it escape sideways without
// resistance; the tangential share t resists, leaving an error of the square of the angle over t, 4e-4.
TEST(Moduli, ParticleHeldInLine) {
  constexpr double edge = 1e-5, eta = 1e5, pull = 2e-5, angle = 2e-4;
  SpecimenNetwork s;
  s.cell.periodic = true;
  s.cell.h = edge * Mat3::Identity();
  s.volume = s.cell.volume();
  s.network.particles = 2;
  auto add = [&](std::uint32_t i, std::uint32_t j, const Vec3& branch, double active) {
    const double d = branch.norm();
    s.network.edges.push_back(
        {i, j, false, s.network.edges.size(), branch / d, branch, -1e-7, 1e-6, d / 2, {1e5, 0, eta, active, 0}});
  };
  const double off = angle * edge / 2;
  add(0, 1, {edge / 2, off, 0}, pull);
  add(1, 0, {edge / 2, -off, 0}, pull);
  add(0, 0, {0, edge, 0}, 0);
  add(0, 0, {0, 0, edge}, 0);
  const ViscousAnswer held = viscous_answer(s, settings);
  EXPECT_NEAR(held.viscosity.response.relaxed(0, 0) / (eta / (2 * edge)), 1, 1e-3);
  EXPECT_NEAR(held.sintering_stress[0] / (pull / (edge * edge)), 1, 1e-3);
  EXPECT_NEAR(held.viscosity.response.relaxed(1, 1) / (eta / edge), 1, 1e-3);
  ModuliSettings free = settings;
  free.tangential_viscosity = 0;
  EXPECT_LT(viscous_answer(s, free).viscosity.response.relaxed(0, 0), 1e-3 * eta / (2 * edge));
}

}  // namespace
}  // namespace densify::dem
