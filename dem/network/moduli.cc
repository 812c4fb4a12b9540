#include "dem/network/moduli.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "base/check.h"

namespace densify::dem {

namespace {

TensorAnswer answer(const SpecimenNetwork& s, const std::vector<EdgeLaw>& laws, Rotation rotation,
                    const ModuliSettings& settings) {
  const auto start = std::chrono::steady_clock::now();
  TensorAnswer a;
  const NetworkEdge* const first = s.network.edges.data();
  const auto law = [&](const NetworkEdge& e) { return laws[std::size_t(&e - first)]; };
  a.response = probe_cell(s.network, law, {s.volume, settings.balance, rotation, 250, settings.watch});
  require_sound(a.response, settings.tolerance);
  a.relaxed = isotropic_part(a.response.relaxed);
  a.affine = isotropic_part(a.response.affine);
  if (std::isfinite(settings.soft_share))
    a.soft_modes = double(count_soft_modes(s.network, law, rotation, settings.soft_share));
  a.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return a;
}

bool flows(const NetworkEdge& e) {
  return std::isfinite(e.law.viscosity) && e.law.viscosity > 0;
}

/// Dashpots of the contacts; counts in `v` those that flow and those that are cut.
std::vector<EdgeLaw> viscous_laws(const SpecimenNetwork& s, const ModuliSettings& settings, ViscousAnswer& v) {
  std::vector<double> flowing;
  for (const NetworkEdge& e : s.network.edges)
    if (flows(e)) flowing.push_back(e.law.viscosity);
  if (flowing.empty())
    throw InputError("no contact flows at " + std::to_string(s.time) + " s, so that there is no viscosity");
  v.flowing = flowing.size();
  std::nth_element(flowing.begin(), flowing.begin() + std::ptrdiff_t(flowing.size() / 2), flowing.end());
  const double median = flowing[flowing.size() / 2], stiffest = settings.rigid * median;
  std::vector<EdgeLaw> laws;
  for (const NetworkEdge& e : s.network.edges) {
    const bool holds = flows(e) || e.neck_radius > 0 || e.overlap < 0;
    const double eta = holds ? std::min(e.law.viscosity > 0 ? e.law.viscosity : stiffest, stiffest) : 0.0;
    const bool rigid = eta == stiffest;
    v.rigid += rigid;
    laws.push_back({eta, settings.tangential_viscosity * (rigid ? median : eta), e.law.active});
  }
  return laws;
}

}  // namespace

TensorAnswer elastic_answer(const SpecimenNetwork& s, const std::vector<Material>& materials, NeckModel model,
                            const ModuliSettings& settings) {
  return answer(s, elastic_laws(s, materials, model, settings.tangential), rotation_of(model), settings);
}

std::size_t count_flowing(const SpecimenNetwork& s) {
  return std::size_t(std::count_if(s.network.edges.begin(), s.network.edges.end(), flows));
}

ViscousAnswer viscous_answer(const SpecimenNetwork& s, const ModuliSettings& settings) {
  ViscousAnswer v{};
  v.viscosity = answer(s, viscous_laws(s, settings, v), Rotation::held, settings);
  v.sintering_stress = v.viscosity.response.relaxed_active;
  v.affine_sintering_stress = v.viscosity.response.affine_active;
  // A network that resists nothing has no rate of its own.
  v.free_strain_rate = v.viscosity.response.floppy ? Vec6(Vec6::Constant(unset))
                                                   : free_rate(v.viscosity.response.relaxed, v.sintering_stress);
  v.densification_rate = -v.free_strain_rate.head<3>().sum();
  return v;
}

TensorAnswer unknown_elastic_answer() {
  TensorAnswer a;
  for (Mat6* c : {&a.response.affine, &a.response.relaxed}) c->setConstant(unset);
  for (double* x : {&a.response.asymmetry, &a.response.power_mismatch, &a.response.smallest_eigenvalue,
                    &a.response.imbalance, &a.seconds})
    *x = unset;
  a.relaxed = a.affine = {unset, unset, unset, unset, unset, unset};
  return a;
}

ViscousAnswer unknown_viscous_answer(const SpecimenNetwork& s, const ModuliSettings& settings) {
  ViscousAnswer v{};
  viscous_laws(s, settings, v);
  v.viscosity = unknown_elastic_answer();
  for (Vec6* x : {&v.sintering_stress, &v.affine_sintering_stress, &v.free_strain_rate}) x->setConstant(unset);
  v.densification_rate = unset;
  return v;
}

std::vector<Phase> solid_phases(const SpecimenNetwork& s, const std::vector<Material>& materials) {
  std::vector<double> volume(materials.size(), 0.0);
  double all = 0;
  for (std::size_t p = 0; p < s.radius.size(); ++p) {
    const double cube = s.radius[p] * s.radius[p] * s.radius[p];
    volume[s.material[p]] += cube;
    all += cube;
  }
  std::vector<Phase> phases;
  for (std::size_t m = 0; m < materials.size(); ++m) {
    if (volume[m] == 0) continue;
    const double youngs = materials[m].youngs_modulus(s.temperature),
                 poisson = materials[m].poissons_ratio(s.temperature);
    if (!(youngs > 0 && std::isfinite(poisson)))
      throw InputError("the dense body needs Young's modulus and Poisson's ratio of \"" + materials[m].name +
                       "\"; set youngs_modulus and poissons_ratio in [materials." + materials[m].name + "]");
    phases.push_back({volume[m] / all, isotropic_moduli(youngs, poisson)});
  }
  return phases;
}

void require_percolation(const SpecimenNetwork& s, const NetworkStructure& n) {
  if (n.directions == 3) return;
  throw InputError("no network spans the " + std::string(s.cell.periodic ? "cell" : "region") + " at " +
                   std::to_string(s.time) + " s (" + std::to_string(n.contacts) + " contacts of " +
                   std::to_string(n.particles) + " particles in " + std::to_string(n.islands) +
                   " parts, connected in " + std::to_string(n.directions) +
                   " of 3 directions), so that it resists nothing; choose a denser state");
}

}  // namespace densify::dem
