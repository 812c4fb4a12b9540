#pragma once
// How stiff a contact between two spheres is: candidates for the elastic moduli of a bonded packing.  Each body is a
// half of the contact, from its centre to the neck's plane, and compliances of halves in series add.

#include "dem/network/probes.h"
#include "dem/network/specimen_network.h"

namespace densify::dem {

enum class NeckModel : std::uint8_t {
  normal_spring,  ///< the contact law's own spring, nothing across it
  bonded_neck,    ///< half-spaces bonded over the circle of the neck
  neck_beam,      ///< a beam of the neck's cross-section from centre to centre
  series          ///< constriction to the neck and column of the sphere's cross-section, one after the other
};
inline constexpr NeckModel all_neck_models[] = {NeckModel::normal_spring, NeckModel::bonded_neck, NeckModel::neck_beam,
                                                NeckModel::series};

std::string name_of(NeckModel);
/// Throws InputError with the names there are.
NeckModel neck_model(const std::string& name);

/// Particles turn unless contacts resist nothing but their own normal.
Rotation rotation_of(NeckModel);

/// A body's half of a contact.
struct NeckHalf {
  double youngs, poisson;  ///< E [Pa], nu
  double radius;           ///< of the sphere [m]
  double length;           ///< from its centre to the neck's plane [m]
};

/// Stiffness of a contact over a circle of radius `a` [m]; `joined` by a neck, or only pressed together: that resists
/// no moments.  All but normal_spring.
EdgeLaw neck_stiffness(NeckModel, const NeckHalf& i, const NeckHalf& j, double a, bool joined);
/// The same of one half, up to a neck's plane that moves on its own.
EdgeLaw half_stiffness(NeckModel, const NeckHalf&, double a, bool joined);

/// Stiffness of every edge.  The circle is the neck; without one that of Hertz, sqrt(R* |u|) with R* = r_i r_j/(r_i +
/// r_j), where 2 E* a is his tangent.  A finite `tangential` replaces the model's lateral stiffness by this share of
/// the normal one.
std::vector<EdgeLaw> elastic_laws(const SpecimenNetwork&, const std::vector<Material>&, NeckModel, double tangential);

}  // namespace densify::dem
