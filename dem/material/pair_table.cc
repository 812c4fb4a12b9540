#include "dem/material/pair_table.h"

#include <cmath>

#include "base/check.h"

namespace densify::dem {

namespace {

void require(bool given, const std::string& what, const Material& a, const Material& b) {
  if (given) return;
  const std::string pair =
      a.name == b.name ? "material \"" + a.name + "\"" : "\"" + a.name + "\" with \"" + b.name + "\"";
  throw InputError("materials: " + what + " of " + pair +
                   " is not given but the contact model needs it; set it in [materials." + a.name + "]" +
                   (a.name == b.name ? "" : " or in an [[interface]] between the two"));
}

}  // namespace

PairTable::PairTable(std::vector<Material> materials, const std::vector<Interface>& given, const ContactModel& model)
    : materials_(std::move(materials)), model_(model) {
  const auto n = std::uint8_t(materials_.size());
  interfaces_.resize(materials_.size() * n);
  rows_.resize(interfaces_.size());
  active_since_.assign(interfaces_.size(), unset);
  for (std::uint8_t a = 0; a < n; ++a)
    for (std::uint8_t b = a; b < n; ++b) {
      const Interface f = complete_interface(materials_, a, b, given);
      interfaces_[index(a, b)] = f;
      if (model_.elasticity == Elasticity::hertz)
        require(std::isfinite(interface_modulus(f, materials_, 300.0)), "Young's modulus or Poisson's ratio",
                materials_[a], materials_[b]);
      if (model_.sintering) {
        require(f.diffusion.complete(), "grain boundary diffusion (atomic_volume, diffusion_prefactor, ...)",
                materials_[a], materials_[b]);
        require(std::isfinite(f.surface_energy), "surface_energy", materials_[a], materials_[b]);
        require(std::isfinite(f.dihedral_angle), "dihedral_angle", materials_[a], materials_[b]);
        require(std::isfinite(f.activation_temperature), "activation_temperature", materials_[a], materials_[b]);
        if (!(model_.sintering->starting_neck < std::sin(0.5 * f.dihedral_angle)))
          throw InputError("contact.sintering.starting_neck: not below sin(Psi/2) of \"" + materials_[a].name +
                           "\" with \"" + materials_[b].name +
                           "\", the neck at equilibrium over the radius (4.32); lower it, or raise dihedral_angle");
      }
    }
}

void PairTable::update(double temperature, double time) {
  const auto n = std::uint8_t(materials_.size());
  for (std::uint8_t a = 0; a < n; ++a)
    for (std::uint8_t b = a; b < n; ++b) {
      const Interface& f = interfaces_[index(a, b)];
      PairProperties& p = rows_[index(a, b)];
      if (model_.elasticity == Elasticity::hertz)
        p.four_thirds_modulus = 4.0 / 3.0 * model_.stiffness_factor * interface_modulus(f, materials_, temperature);
      if (!model_.sintering) continue;
      p.mobility_factor = 8 * f.diffusion.effective(temperature) / M_PI;
      p.surface_energy = f.surface_energy;
      p.cap = 8 * std::pow(std::sin(0.25 * f.dihedral_angle), 2);  // 4 (1 - cos(Psi/2)) for small Psi, too
      p.sine = std::sin(0.5 * f.dihedral_angle);
      p.active = temperature >= f.activation_temperature;
      if (p.active && p.mobility_factor == 0 && model_.sintering->model == SinteringModel::viscous)
        throw RunError("nothing diffuses between \"" + materials_[a].name + "\" and \"" + materials_[b].name +
                       "\" at " + std::to_string(temperature) +
                       " K, so that viscous contacts are rigid; raise activation_temperature, or use model = "
                       "\"viscoelastic\"");
      double& since = active_since_[index(a, b)];
      if (!p.active)
        since = unset;
      else if (std::isnan(since))
        since = time;
      p.activation_step = p.active && since == time;
    }
}

bool PairTable::any_active() const {
  for (const auto& p : rows_)
    if (p.active) return true;
  return false;
}

}  // namespace densify::dem
