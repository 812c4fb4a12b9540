#pragma once
// Rigid walls: planes and an upright cylinder, with contacts of the loose law and friction but no necks (Hertz with the
// particle's own radius and the effective modulus of particle and wall).

#include <cmath>

#include "dem/contact/force_pass.h"

namespace densify::dem {

enum class WallShape : std::uint8_t { plane, cylinder };

/// One rigid wall.  A plane keeps particles on the side its normal points to; a cylinder about the z axis keeps them
/// inside.
struct Wall {
  std::string name;
  WallShape shape = WallShape::plane;
  Vec3 point = Vec3::Zero();     ///< on the plane, or on the cylinder's axis [m]
  Vec3 normal = Vec3::UnitZ();   ///< of a plane, into the powder
  double radius = 0;             ///< of a cylinder [m]
  Vec3 velocity = Vec3::Zero();  ///< of a plane [m/s]
  double radius_rate = 0;        ///< of a cylinder [m/s]
  double thermal_rate = 0;       ///< relative growth rate of a lateral wall's position by expansion [1/s]

  /// Moves on for a time [s].
  void move(double step) {
    point += step * velocity;
    radius += step * radius_rate;
  }
  /// Stretches the container across by heat; false for a wall that this leaves alone, bottom or punch.
  bool stretch(double factor) {
    constexpr double lateral = 0.5;
    if (shape == WallShape::cylinder)
      radius *= factor;
    else if (std::abs(normal[2]) < lateral)
      point *= factor;
    else
      return false;
    return true;
  }
};

/// What walls are made of.
struct WallMaterial {
  double youngs_modulus = unset;  ///< [Pa]; unset: rigid against the particle's own modulus
  double poissons_ratio = unset;
};

/// One particle near one wall.
struct WallContact {
  std::uint32_t particle;
  std::uint8_t wall;
  Vec3 tangential = Vec3::Zero();  ///< friction spring [m]
};

/// What one wall contact did in a recorded pass.
struct WallRecord {
  std::uint32_t particle;
  std::uint8_t wall;
  Vec3 force;             ///< on the particle [N]
  Vec3 branch;            ///< from the particle's centre to the contact point [m]
  double elastic_energy;  ///< [J]
};

class Walls {
 public:
  Walls() = default;
  Walls(std::vector<Wall> walls, WallMaterial material) : wall(std::move(walls)), material_(material) {}

  std::vector<Wall> wall;

  /// Signed gap of a centre to the wall's surface (negative outside) [m] and the unit normal from centre to wall.
  static double gap(const Wall&, const Vec3& x, Vec3& toward_wall);

  /// Lists the particles within `skin` of each wall; carries friction springs over.
  /// Throws RunError when a particle's centre is beyond a wall.
  void rebuild(const Particles&, double skin);

  /// Adds the wall forces to the particles and sums them per wall; with `step_stiffness` given, adds to its sums too
  /// and makes stiffness() and step_stiffness() those of this pass.
  void compute(Particles&, const PairTable&, const ContactModel&, const std::vector<double>& expansion_step, PassTime,
               std::vector<WallRecord>* record, StepStiffness* step_stiffness);

  /// Throws RunError when the centre of a listed particle is beyond its wall.
  void require_inside(const Particles&) const;

  /// Stored in the springs of all wall contacts, normal and tangential [J].
  double elastic_energy(const Particles&, const PairTable&, const ContactModel&) const;

  /// Share of the skin that wall motion since the last rebuild has used up, on its own.
  double age(double skin) const;

  /// Resultant of all particles on each wall [N].
  const std::vector<Vec3>& force() const { return force_; }
  /// Sum of the normal force components on each wall, pushing outward positive [N].
  const std::vector<double>& normal_force() const { return normal_force_; }
  /// Sum of tangent stiffness over each wall's contacts in the last call of `add_stiffness` or such a pass [N/m].
  const std::vector<double>& stiffness() const { return stiffness_; }
  const std::vector<double>& damping() const { return damping_; }
  /// Sum of the contacts' share in StepStiffness over each wall [N/m].
  const std::vector<double>& step_stiffness() const { return step_stiffness_; }

  /// Adds stiffness and damping of the wall contacts to the particles' sums, for the time step limit.
  void add_stiffness(const Particles&, const PairTable&, const ContactModel&, std::vector<NodeSums>&);

  /// (4/3) E* of a particle of a material against the walls, stiffness factor included [Pa].
  double modulus(const PairTable&, const ContactModel&, std::uint8_t material) const;

  std::vector<WallContact>& contacts() { return contacts_; }
  const std::vector<WallContact>& contacts() const { return contacts_; }
  std::vector<Wall>& reference() { return reference_; }
  const std::vector<Wall>& reference() const { return reference_; }

 private:
  /// Calls visit(contact, normal, input, law) for every particle that touches a wall, at rest.
  template <class Visit>
  void each_touching(const Particles&, const PairTable&, const ContactModel&, Visit&&) const;

  WallMaterial material_;
  std::vector<WallContact> contacts_;
  std::vector<Wall> reference_;  // walls when the contacts were listed
  std::vector<Vec3> force_;
  std::vector<double> normal_force_, stiffness_, damping_, step_stiffness_;
  // Of each material against the walls, of the last pass [Pa, 1/s]:
  std::vector<double> moduli_, growth_rates_;
};

/// Calls visit(law) with the law of a wall contact; `modulus` as of Walls::modulus [Pa].
template <class Visit>
void with_wall_law(const ContactModel& model, double modulus, Visit&& visit) {
  if (model.elasticity == Elasticity::linear)
    visit(KelvinVoigt<LinearSpring>{{model.normal_stiffness}, model.damping_ratio});
  else
    visit(KelvinVoigt<HertzSpring>{{modulus, 0.0}, model.damping_ratio});
}

/// The input of a wall contact's law; `gap` from the centre to the wall's surface [m], `rate` of it less growth [m/s].
inline NormalInput wall_input(const Body& b, double gap, double rate, PassTime clock) {
  NormalInput in;
  in.overlap = gap - b.radius;
  in.rate = rate;
  in.elastic_radius = b.radius;
  in.sintering_radius = 0;
  in.reduced_mass = 1 / b.inverse_mass;
  in.step = clock.step;
  in.time = clock.time;
  return in;
}

}  // namespace densify::dem
