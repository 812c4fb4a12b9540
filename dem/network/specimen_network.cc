#include "dem/network/specimen_network.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/check.h"
#include "dem/io/snapshot.h"
#include "dem/state/spatial_order.h"

namespace densify::dem {

namespace {

/// The part of a specimen that is probed.
struct Region {
  Vec3 low = Vec3::Constant(-std::numeric_limits<double>::infinity()), high = -low;
  double radius = std::numeric_limits<double>::infinity();  // about the z axis

  bool holds(const Vec3& x) const {
    return (x.array() >= low.array()).all() && (x.array() <= high.array()).all() &&
           x.head<2>().squaredNorm() <= radius * radius;
  }
  double volume() const {
    const Vec3 size = high - low;
    if (size[2] <= 0) return 0;
    if (std::isfinite(radius)) return radius > 0 ? M_PI * radius * radius * size[2] : 0.0;
    return size[0] > 0 && size[1] > 0 ? size.prod() : 0.0;
  }
};

/// At least `distance` from every wall and, where a punch has lifted off, from the powder's ends.
Region inner_region(const Hdf5Reader& file, const std::string& walls, double distance, const Particles& particles) {
  Region region;
  const auto shape = file.texts(walls + "/shape");
  const auto point = file.read<double>(walls + "/point"), normal = file.read<double>(walls + "/normal"),
             radius = file.read<double>(walls + "/radius");
  for (std::size_t w = 0; w < shape.size(); ++w) {
    if (shape[w] == "cylinder") {
      region.radius = radius[w] - distance;
      continue;
    }
    for (int axis = 0; axis < 3; ++axis) {
      const double n = normal[3 * w + std::size_t(axis)], at = point[3 * w + std::size_t(axis)];
      if (n > 0.5) region.low[axis] = std::max(region.low[axis], at + distance);
      if (n < -0.5) region.high[axis] = std::min(region.high[axis], at - distance);
    }
  }
  double top = -std::numeric_limits<double>::infinity(), base = -top;
  for (const auto& b : particles.body) {
    top = std::max(top, b.position[2] + b.radius);
    base = std::min(base, b.position[2] - b.radius);
  }
  region.high[2] = std::min(region.high[2], top - distance);
  region.low[2] = std::max(region.low[2], base + distance);
  return region;
}

/// The law of a pair, linearised at rest.
Linearisation linearise(const Scene& scene, const PairTable& table, const Particles& p, std::uint32_t i,
                        std::uint32_t j, double overlap, const NeckHistory* neck, double flow_share, double time) {
  const double ri = p.body[i].radius, rj = p.body[j].radius;
  NormalInput in;
  in.overlap = overlap;
  in.rate = in.step = 0;
  in.time = time;
  in.flow_share = flow_share;
  in.elastic_radius = elastic_radius(scene.contact, ri, rj);
  in.sintering_radius = neck ? sintering_radius(scene.contact.sintering->radius, ri, rj) : 0.0;
  in.reduced_mass = 1 / (p.body[i].inverse_mass + p.body[j].inverse_mass);
  const auto [a, b] = std::minmax(p.material[i], p.material[j]);
  return with_law(scene.contact, table.row(a, b), neck != nullptr, [&](const auto& law) {
    if constexpr (has_necks<std::decay_t<decltype(law)>>)
      return law.linearise(in, *neck);
    else
      return law.linearise(in);
  });
}

Particles read_particles(const Hdf5Reader& file, const std::string& group, const Scene& scene) {
  Particles p;
  p.id = file.read<std::uint32_t>(group + "/id");
  p.material = file.read<std::uint8_t>(group + "/material");
  const auto position = file.read<double>(group + "/position"), radius = file.read<double>(group + "/radius");
  if (position.size() != 3 * p.id.size() || radius.size() != p.id.size() || p.material.size() != p.id.size())
    throw FileError(file.path().string() + ": " + group + ": lists of different length");
  for (std::size_t k = 0; k < p.id.size(); ++k) {
    if (p.material[k] >= scene.materials.size())
      throw FileError(file.path().string() + ": " + group + "/material: a number without a material");
    const double r = radius[k];
    const double mass = 4.0 / 3 * M_PI * r * r * r * scene.materials[p.material[k]].density;
    p.reference_radius.push_back(r);  // what spatial_order goes by
    p.body.push_back(
        {Eigen::Map<const Vec3>(&position[3 * k]), r, Vec3::Zero(), 1 / (scene.integration.mass_scaling * mass)});
  }
  return p;
}

}  // namespace

std::vector<StoredMoment> stored_moments(const Hdf5Reader& file) {
  std::vector<StoredMoment> moments;
  for (std::uint64_t s = 0;; ++s) {
    const std::string group = "/snapshots/" + six_digits(s);
    if (!file.has(group)) return moments;
    moments.push_back({group, file.attribute<double>(group, "time"), file.attribute<double>(group, "temperature"),
                       file.attribute<double>(group, "relative_density")});
  }
}

SpecimenNetwork read_network(const Hdf5Reader& file, const Scene& scene, const StoredMoment& moment) {
  SpecimenNetwork s;
  s.time = moment.time;
  s.temperature = moment.temperature;
  s.relative_density = moment.relative_density;
  s.stage = file.attribute<std::string>(moment.group, "stage");
  Particles all = read_particles(file, moment.group + "/particles", scene);
  // Neighbours in space near in memory.
  const auto order = spatial_order(all);
  permute(all.body, order), permute(all.material, order), permute(all.id, order);

  Region region;
  if (file.has(moment.group + "/cell/edges")) {
    const auto h = file.read<double>(moment.group + "/cell/edges"),
               origin = file.read<double>(moment.group + "/cell/origin");
    s.cell.periodic = true;
    s.cell.h = Eigen::Map<const Mat3>(h.data());  // one edge vector a row there, a column here
    s.cell.origin = Eigen::Map<const Vec3>(origin.data());
    s.volume = s.cell.volume();
  } else if (file.has(moment.group + "/walls/shape")) {
    double diameter = 0;
    for (const auto& b : all.body) diameter += 2 * b.radius / double(all.size());
    region = inner_region(file, moment.group + "/walls", 2 * diameter, all);
    s.volume = region.volume();
    if (!(s.volume > 0))
      throw InputError(file.path().string() +
                       ": no region lies two mean diameters from every wall; a larger specimen has one");
  } else {
    throw InputError(file.path().string() +
                     ": neither a periodic cell nor walls, so that there is no volume to refer "
                     "stresses to; use specimen.shape = \"periodic\", \"cylinder\" or \"box\"");
  }

  constexpr std::uint32_t outside = 0xffffffff;
  std::vector<std::uint32_t> place(all.size(), outside), of_id;
  for (std::uint32_t p = 0; p < all.size(); ++p) {
    if (all.id[p] >= of_id.size()) of_id.resize(all.id[p] + 1, outside);
    of_id[all.id[p]] = p;
    if (!s.cell.periodic && !region.holds(all.body[p].position)) continue;
    place[p] = std::uint32_t(s.position.size());
    s.position.push_back(all.body[p].position);
    s.radius.push_back(all.body[p].radius);
    s.material.push_back(all.material[p]);
  }
  s.network.particles = s.position.size();

  PairTable table(scene.materials, scene.interfaces, scene.contact);
  table.update(s.temperature, s.time);
  const std::string contacts = moment.group + "/contacts";
  const auto first = file.read<std::uint32_t>(contacts + "/first_id"),
             second = file.read<std::uint32_t>(contacts + "/second_id");
  std::vector<std::uint8_t> image, phase;
  std::vector<double> neck_radius, elastic, since, flow_share(first.size(), 1.0);
  if (s.cell.periodic) image = file.read<std::uint8_t>(contacts + "/image");
  const bool necks = file.has(contacts + "/neck_radius");
  if (necks) {
    neck_radius = file.read<double>(contacts + "/neck_radius");
    elastic = file.read<double>(contacts + "/elastic_displacement");
    phase = file.read<std::uint8_t>(contacts + "/phase");
    // Results of before have no begin of transitions: taken as ended.
    since.assign(first.size(), -std::numeric_limits<double>::infinity());
    if (file.has(contacts + "/since")) since = file.read<double>(contacts + "/since");
    if (file.has(contacts + "/flow_share")) flow_share = file.read<double>(contacts + "/flow_share");
  }
  for (std::size_t k = 0; k < first.size(); ++k) {
    if (first[k] >= of_id.size() || second[k] >= of_id.size() || of_id[first[k]] == outside ||
        of_id[second[k]] == outside)
      throw FileError(file.path().string() + ": " + contacts + ": a contact of no particle");
    std::uint32_t i = of_id[first[k]], j = of_id[second[k]];
    Vec3 branch = all.body[j].position - all.body[i].position;
    if (s.cell.periodic) branch += s.cell.shift(image[k]);
    if (place[i] == outside) std::swap(i, j), branch = -branch;
    if (place[i] == outside) continue;
    const double d = branch.norm();
    NetworkEdge e{place[i], 0, place[j] == outside, k, branch / d, branch, 0, 0, 0, {}};
    e.overlap = d - all.body[i].radius - all.body[j].radius;
    e.lever = all.body[i].radius + 0.5 * e.overlap;
    NeckHistory neck;
    if (necks) {
      neck = {neck_radius[k], elastic[k], since[k], NeckPhase(phase[k])};
      if (neck.phase != NeckPhase::loose) e.neck_radius = neck.radius;
    }
    e.law = linearise(scene, table, all, i, j, e.overlap, necks ? &neck : nullptr, flow_share[k], s.time);
    if (e.at_wall) {  // half of the contact, up to its plane
      e.branch = e.lever * e.normal;
      e.law.stiffness *= 2, e.law.damper *= 2, e.law.viscosity *= 2;
    } else {
      e.j = place[j];
    }
    s.network.edges.push_back(e);
    s.far_radius.push_back(all.body[j].radius);
    s.far_material.push_back(all.material[j]);
  }
  return s;
}

SpecimenNetwork network_of(const Simulation& simulation) {
  const State& state = simulation.state();
  if (!state.cell.periodic) throw InputError("the network of a simulation as it stands needs a periodic cell");
  SpecimenNetwork s;
  s.time = state.time;
  s.temperature = simulation.temperature();
  s.cell = state.cell;
  s.volume = s.cell.volume();
  s.network = build_network({state.particles, state.contacts, state.cell, simulation.table(),
                             simulation.setup().contact, state.walls, simulation.pores()},
                            state.time);
  double solid = 0;
  for (const auto& b : state.particles.body) {
    s.position.push_back(b.position);
    s.radius.push_back(b.radius);
    solid += 4.0 / 3 * M_PI * b.radius * b.radius * b.radius;
  }
  s.relative_density = solid / s.volume;
  s.material = state.particles.material;
  for (const auto& e : s.network.edges) {
    s.far_radius.push_back(s.radius[e.j]);
    s.far_material.push_back(s.material[e.j]);
  }
  return s;
}

}  // namespace densify::dem
