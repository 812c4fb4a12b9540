#pragma once
// Stress from the contacts of a snapshot: in each neck (thesis 6.1-6.4), and of the whole specimen (6.10) by kinds of
// contact.

#include "dem/io/snapshot.h"

namespace densify::dem {

/// What a force is made of: total = sintering + viscoelastic (6.1).  The viscoelastic part is that of spring, dashpot,
/// damper and friction.
enum class StressPart : std::uint8_t { sintering, viscoelastic, total };

/// Force of contact `c` on its first particle [N].
Vec3 contact_force(const Snapshot&, std::size_t c, StressPart);

/// The kinds of contact of a specimen: every pair of materials, and the walls.
class ContactKinds {
 public:
  explicit ContactKinds(const std::vector<std::string>& materials);

  std::size_t size() const { return name_.size(); }
  /// "NiAl - Al2O3", or "walls" for the last.
  const std::string& name(std::size_t kind) const { return name_[kind]; }
  std::size_t of(std::uint8_t material_a, std::uint8_t material_b) const;
  std::size_t walls() const { return size() - 1; }

 private:
  std::size_t materials_;
  std::vector<std::string> name_;
};

/// Kind of every contact between particles.
std::vector<std::size_t> kinds_of_contacts(const Snapshot&, const ContactKinds&);

/// Volume that the stress of the specimen refers to: the envelope (5.5), or the periodic cell [m^3].
double specimen_volume(const Snapshot&);

/// Macroscopic stress (1/V) sum of L (x) F (6.10), one for each kind of contact, symmetrised; they add up to that of
/// the specimen.  L from the first to the second centre, or from the centre to the contact point at a wall.
std::vector<Stress> stress_by_contacts(const Snapshot&, const ContactKinds&, StressPart);

/// Mean normal stress over the cross-section pi a^2 of one neck (6.4), tension positive [Pa].
struct NeckStress {
  std::size_t contact;  ///< among the contacts of the snapshot
  bool at_equilibrium;  ///< a_max has been reached: the thesis leaves such necks out
  double sintering;     ///< (6.2)
  double viscoelastic;  ///< (6.3)
  double total() const { return sintering + viscoelastic; }  ///< (6.1)
};
std::vector<NeckStress> neck_stresses(const Snapshot&);

}  // namespace densify::dem
