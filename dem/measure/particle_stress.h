#pragma once
// Stress in each particle (thesis 6.5-6.8), and the stress of the specimen and of its phases from them (6.9).

#include "dem/measure/contact_stress.h"

namespace densify::dem {

/// Particle stress sigma_p = (1/V_p) sum of s (x) F over all contacts, walls included, with s from the centre to the
/// contact point and V_p the sphere's volume (6.5), symmetrised (6.6) [Pa]; in the snapshot's order.
std::vector<Stress> particle_stresses(const Snapshot&, StressPart);

/// What each material adds to the macroscopic stress, (1/V) sum of V_p sigma_p over its particles (6.9) [Pa]; they add
/// up to that of the specimen.  Over the share V_m/V of the material's spheres it is the mean stress in the phase.
std::vector<Stress> stress_by_materials(const Snapshot&, const std::vector<Stress>& of_particles);

/// Volume of each material's spheres [m^3].
std::vector<double> material_volumes(const Snapshot&);

}  // namespace densify::dem
