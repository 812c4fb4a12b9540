#pragma once
// What result files and pictures show of one moment, in the user's numbering; plain data, taken once for all of them.

#include <string>

#include "dem/measure/stress.h"
#include "dem/simulation.h"

namespace densify::dem {

/// What the run knows of the moment and the state does not.
struct Moment {
  double time = unset;              ///< process time [s]
  double temperature = unset;       ///< [K]
  double pressure = unset;          ///< [Pa]
  double relative_density = unset;  ///< by envelope (5.5)
  std::string stage;
};

/// Arrays of features that a scene leaves out are empty.
struct Snapshot {
  Moment moment;
  std::vector<std::string> materials;  ///< names, by index
  bool has_friction = false, has_necks = false;

  // Particles, sorted by id.
  std::vector<std::uint32_t> id;
  std::vector<std::uint8_t> material;
  std::vector<Vec3> position;               ///< [m]
  std::vector<double> radius;               ///< [m]
  std::vector<Vec3> velocity;               ///< [m/s]
  std::vector<Vec3> angular_velocity;       ///< only with friction [rad/s]
  std::vector<Stress> stress;               ///< total particle stress (6.5, 6.6) [Pa]
  std::vector<std::uint32_t> coordination;  ///< contacts with other particles
  std::vector<double> local_density;        ///< only with pore closure and necks

  // Contacts that transmit force now: touching, or joined by a neck.
  std::vector<std::uint32_t> first_id, second_id;
  std::vector<std::uint8_t> image;           ///< ImageCode of the second particle; only in a periodic cell
  std::vector<Vec3> start, branch;           ///< centre of the first particle, and from there to the second [m]
  std::vector<double> overlap;               ///< u (4.16), negative when pressed together [m]
  std::vector<double> normal_force;          ///< tension positive [N]
  std::vector<Vec3> tangential_force;        ///< on the first particle; only with friction [N]
  std::vector<double> sintering_force;       ///< part of the normal force; only with necks [N]
  std::vector<double> neck_radius;           ///< only with necks [m]
  std::vector<double> elastic_displacement;  ///< u_e; only with necks [m]
  std::vector<double> since;                 ///< begin of the neck's last transition; only with necks [s]
  std::vector<std::uint8_t> phase;           ///< NeckPhase; only with necks
  std::vector<double> flow_share;            ///< that closing pores leave; only with pore closure and necks

  std::vector<Wall> wall;
  std::vector<Vec3> wall_force;  ///< of the powder on each wall [N]

  // Particles that touch walls.
  std::vector<std::uint32_t> wall_contact_id;
  std::vector<std::uint8_t> wall_contact_wall;
  std::vector<Vec3> wall_contact_force;  ///< on the particle [N]
  std::vector<Vec3> wall_contact_arm;    ///< from its centre to the contact point [m]

  Cell cell;
};

/// The state and the forces recorded in it.  To be called right after Simulation::evaluate(&recording), so that
/// positions and forces are of the same time.
Snapshot take_snapshot(const Simulation&, const Recording&, Moment);

/// Place of each id in the lists of particles, by id; the number of particles for an id that there is not.
std::vector<std::uint32_t> places_of_ids(const Snapshot&);

/// A number as it stands in names of files and groups, 000000 and on.
std::string six_digits(std::uint64_t);

}  // namespace densify::dem
