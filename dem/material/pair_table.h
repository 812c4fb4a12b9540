#pragma once
// The material side of every contact at the present temperature: one row a pair of materials.

#include "dem/law/contact_model.h"

namespace densify::dem {

/// Properties uniform over all contacts of one pair of materials at one temperature.
struct PairProperties {
  double four_thirds_modulus = unset;  ///< (4/3) E* x stiffness factor (4.19) [Pa]; unset with linear elasticity
  double mobility_factor = 0;          ///< 8 D_eff / pi (4.40) [m^5/(N s)]
  double surface_energy = 0;           ///< [J/m^2]
  double cap = 0;                      ///< 4 (1 - cos(Psi/2)) (4.36)
  double sine = 0;                     ///< sin(Psi/2) (4.32, 4.36)
  bool active = false;                 ///< sintering: T >= activation temperature
  bool activation_step = false;        ///< first step above it since it was last below
};

class PairTable {
 public:
  /// Throws InputError when the model needs a property that neither materials nor interfaces give.
  PairTable(std::vector<Material> materials, const std::vector<Interface>& given, const ContactModel& model);

  /// Recomputes the rows for a temperature [K] at a process time [s].
  void update(double temperature, double time);

  std::size_t materials() const { return materials_.size(); }
  const std::vector<Material>& material_list() const { return materials_; }
  /// Row of a pair, a <= b.
  const PairProperties& row(std::uint8_t a, std::uint8_t b) const { return rows_[index(a, b)]; }
  const Interface& interface(std::uint8_t a, std::uint8_t b) const { return interfaces_[index(a, b)]; }
  std::size_t index(std::uint8_t a, std::uint8_t b) const { return std::size_t(a) * materials_.size() + b; }
  /// True when any pair sinters now or can hold necks.
  bool any_active() const;

  /// Process time at which each pair was last activated, NaN while inactive: the only state that a restart needs.
  std::vector<double>& active_since() { return active_since_; }
  const std::vector<double>& active_since() const { return active_since_; }

 private:
  std::vector<Material> materials_;
  std::vector<Interface> interfaces_;
  std::vector<PairProperties> rows_;
  std::vector<double> active_since_;
  ContactModel model_;
};

}  // namespace densify::dem
