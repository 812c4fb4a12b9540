#include "dem/network/neck_models.h"

#include <cmath>

#include "base/check.h"
#include "base/nearest.h"

namespace densify::dem {

namespace {

/// Displacement or rotation of one half under unit force or couple.
struct Compliance {
  double normal, lateral, bending, torsion;
};

/// A rigid circle of radius a on a half-space: normal (1-nu^2)/(2 E a) (Sneddon), lateral (2-nu)/(8 G a) (Mindlin),
/// tilting 3 (1-nu^2)/(4 E a^3), twisting 3/(16 G a^3) (Reissner and Sagoci); K. L. Johnson, Contact Mechanics, 1985.
Compliance constriction(const NeckHalf& h, double a) {
  const double shear = h.youngs / (2 * (1 + h.poisson)), plane = (1 - h.poisson * h.poisson) / h.youngs;
  return {plane / (2 * a), (2 - h.poisson) / (8 * shear * a), 3 * plane / (4 * a * a * a),
          3 / (16 * shear * a * a * a)};
}

/// A column of circular cross-section of radius a.
Compliance column(const NeckHalf& h, double a) {
  const double shear = h.youngs / (2 * (1 + h.poisson)), area = M_PI * a * a, inertia = 0.25 * M_PI * a * a * a * a;
  return {h.length / (h.youngs * area), h.length / (shear * area), h.length / (h.youngs * inertia),
          h.length / (2 * shear * inertia)};
}

Compliance half_compliance(NeckModel model, const NeckHalf& h, double a) {
  if (model == NeckModel::bonded_neck) return constriction(h, a);
  if (model == NeckModel::neck_beam) return column(h, a);
  // The constriction in a column of finite width fades as the neck becomes as wide as the sphere: (1 - a/r)^(3/2) of
  // the half-space's (Cooper, Mikic and Yovanovich, 1969, for the flux through a circle in a tube).
  const double share = std::pow(std::max(0.0, 1 - a / h.radius), 1.5);
  const Compliance to = constriction(h, a), through = column(h, h.radius);
  return {share * to.normal + through.normal, share * to.lateral + through.lateral,
          share * to.bending + through.bending, share * to.torsion + through.torsion};
}

EdgeLaw law_of(const Compliance& c, bool joined) {
  return {1 / c.normal, 1 / c.lateral, 0, joined ? 1 / c.bending : 0, joined ? 1 / c.torsion : 0};
}

constexpr const char* names[] = {"normal_spring", "bonded_neck", "neck_beam", "series"};

}  // namespace

std::string name_of(NeckModel model) {
  return names[std::size_t(model)];
}

NeckModel neck_model(const std::string& name) {
  std::vector<std::string> known;
  std::string list;
  for (const NeckModel m : all_neck_models) {
    if (name == name_of(m)) return m;
    known.push_back(name_of(m));
    list += (list.empty() ? "" : ", ") + name_of(m);
  }
  throw InputError("--model " + name + ": no such contact model; there are " + list + did_you_mean(name, known));
}

Rotation rotation_of(NeckModel model) {
  return model == NeckModel::normal_spring ? Rotation::held : Rotation::free;
}

EdgeLaw neck_stiffness(NeckModel model, const NeckHalf& i, const NeckHalf& j, double a, bool joined) {
  if (!(a > 0)) return {0, 0, 0};
  const Compliance p = half_compliance(model, i, a), q = half_compliance(model, j, a);
  return law_of({p.normal + q.normal, p.lateral + q.lateral, p.bending + q.bending, p.torsion + q.torsion}, joined);
}

EdgeLaw half_stiffness(NeckModel model, const NeckHalf& h, double a, bool joined) {
  return a > 0 ? law_of(half_compliance(model, h, a), joined) : EdgeLaw{0, 0, 0};
}

std::vector<EdgeLaw> elastic_laws(const SpecimenNetwork& s, const std::vector<Material>& materials, NeckModel model,
                                  double tangential) {
  std::vector<double> youngs, poisson;
  for (const Material& m : materials) {
    youngs.push_back(m.youngs_modulus(s.temperature));
    poisson.push_back(m.poissons_ratio(s.temperature));
    if (model != NeckModel::normal_spring && !(youngs.back() > 0 && std::isfinite(poisson.back())))
      throw InputError("--model " + name_of(model) + ": it needs Young's modulus and Poisson's ratio of \"" + m.name +
                       "\"; set youngs_modulus and poissons_ratio in [materials." + m.name + "]");
  }
  std::vector<EdgeLaw> laws;
  for (std::size_t k = 0; k < s.network.edges.size(); ++k) {
    const NetworkEdge& e = s.network.edges[k];
    if (model == NeckModel::normal_spring) {
      // A viscous contact has no spring of its own.
      if (std::isinf(e.law.stiffness))
        throw InputError("--model normal_spring: the viscous contact law has no spring; choose another model");
      laws.push_back({e.law.stiffness, std::isfinite(tangential) ? tangential * e.law.stiffness : 0.0, 0});
      continue;
    }
    const bool joined = e.neck_radius > 0;
    const double ri = s.radius[e.i], rj = s.far_radius[k];
    const double a = joined ? e.neck_radius : std::sqrt(ri * rj / (ri + rj) * std::max(0.0, -e.overlap));
    const std::uint8_t mi = s.material[e.i], mj = s.far_material[k];
    constexpr double shortest = 0.1;  // of the radius: very unequal spheres may have the neck behind a centre
    const NeckHalf i{youngs[mi], poisson[mi], ri, std::max(e.lever, shortest * ri)};
    const NeckHalf j{youngs[mj], poisson[mj], rj, std::max(e.branch.norm() - e.lever, shortest * rj)};
    EdgeLaw law = e.at_wall ? half_stiffness(model, i, a, joined) : neck_stiffness(model, i, j, a, joined);
    if (std::isfinite(tangential)) law.lateral = tangential * law.coefficient;
    laws.push_back(law);
  }
  return laws;
}

}  // namespace densify::dem
