// [contact]: elasticity, friction, sintering.

#include "dem/io/scene_parts.h"

namespace densify::dem {
namespace {

void read_friction(Section& section, FrictionModel& friction) {
  section.quantity("coefficient", friction.coefficient, dim::none, Range::non_negative(), Need::required,
                   "mu between particles (4.27)");
  friction.wall_coefficient = friction.coefficient;
  section.quantity("wall_coefficient", friction.wall_coefficient, dim::none, Range::non_negative(), Need::optional,
                   "mu between particle and wall; that between particles if absent");
  section.quantity("tangential_stiffness_ratio", friction.tangential_stiffness_ratio, dim::none, Range::positive(),
                   Need::optional, "k_t over k_n of the regularised law (4.28, Fig. 4.6)");
  section.quantity("tangential_damping_ratio", friction.tangential_damping_ratio, dim::none, Range::non_negative(),
                   Need::optional, "of the critical damping of the tangential spring");
}

void read_sintering(Section& section, SinteringSettings& s) {
  section.choice("model", s.model,
                 {{"viscoelastic", SinteringModel::viscoelastic}, {"viscous", SinteringModel::viscous}}, Need::optional,
                 "Maxwell element (4.37-4.46) or dashpot (4.29-4.36)");
  section.choice("radius", s.radius,
                 {{"equivalent", SinteringRadius::equivalent}, {"smaller", SinteringRadius::smaller}}, Need::optional,
                 "radius of neck and sintering force: 2 r_i r_j / (r_i + r_j) (4.33), or the smaller of the two");
  section.choice("neck", s.neck, {{"integrated", NeckGrowth::integrated}, {"overlap", NeckGrowth::overlap}},
                 Need::optional, "neck growth (4.31), or 1.43 sqrt(r^2 - (r - u/2)^2) of the present overlap");
  section.choice("update", s.update,
                 {{"backward_euler", MaxwellUpdate::backward_euler}, {"trapezoidal", MaxwellUpdate::trapezoidal}},
                 Need::optional, "step of the Maxwell element: L-stable, or (4.67)");
  section.choice("at_equilibrium", s.at_equilibrium,
                 {{"elastic_bond", AtEquilibrium::elastic_bond}, {"viscous", AtEquilibrium::viscous}}, Need::optional,
                 "a neck at a_max (4.32) bonds elastically, or keeps flowing with viscosity_before");
  section.quantity("relaxation_time", s.relaxation_time, dim::time, Range::non_negative(), Need::optional,
                   "t_rel of the smooth transitions (4.47-4.54)");
  section.quantity("viscosity_before", s.viscosity_before, dim::viscosity_contact, Range::positive(), Need::optional,
                   "eta_inf from which a transition starts and to which it returns (4.47, 4.51)");
  section.quantity("damping_ratio", s.damping_ratio, dim::none, Range::non_negative(), Need::optional,
                   "of the critical damping (4.25); acts on the elastic part of the rate, adds no viscosity");
  section.quantity("starting_neck", s.starting_neck, dim::none, Range::inside(0.0, 1.0), Need::optional,
                   "smallest neck radius over particle radius");
  section.quantity("tension_floor", s.tension_floor, dim::none, Range::inside(0.0, 1.0), Need::optional,
                   "Hertz (4.46) in tension is linear, with the tangent at this overlap over radius");
  section.section("pore_closure", Need::optional, "the last pores resist; they never do if absent",
                  [&](Section& below) {
                    s.closing_porosity = 0.1;
                    below.quantity("porosity", s.closing_porosity, dim::none, Range::inside(0.0, 1.0), Need::optional,
                                   "local porosity below which a contact's viscosity grows as 1/porosity");
                  });
}

}  // namespace

void read_contact(Section& root, Scene& scene, ScenePlaces& places) {
  ContactModel& model = scene.contact;
  root.section("contact", Need::defaulted, "forces between particles", [&](Section& section) {
    places.contact = section;
    section.choice("elasticity", model.elasticity, {{"hertz", Elasticity::hertz}, {"linear", Elasticity::linear}},
                   Need::optional, "Hertz (4.18), or a spring of one stiffness (4.15)");
    const bool documenting = section.documenting();
    if (documenting || model.elasticity == Elasticity::linear) {
      section.quantity("normal_stiffness", model.normal_stiffness, dim::stiffness, Range::positive(), Need::required,
                       "k_n of linear elasticity (4.15)");
      refuse_keys(section, {"hertz_radius", "stiffness_factor"}, "belongs to elasticity = \"hertz\"; remove it");
    }
    if (documenting || model.elasticity == Elasticity::hertz) {
      section.choice("hertz_radius", model.hertz_radius,
                     {{"reduced", HertzRadius::reduced}, {"equivalent", HertzRadius::equivalent}}, Need::optional,
                     "R of (4.19): r_i r_j / (r_i + r_j), or twice that as (4.21) prints it, sqrt(2) stiffer");
      section.quantity("stiffness_factor", model.stiffness_factor, dim::none, Range::positive(), Need::optional,
                       "multiplies the Hertz stiffness; below 1 it stands in for plastic yielding");
      refuse_keys(section, {"normal_stiffness"}, "belongs to elasticity = \"linear\"; remove it, or set elasticity");
    }
    section.quantity("damping_ratio", model.damping_ratio, dim::none, Range::non_negative(), Need::optional,
                     "xi of the contacts before sintering (4.24)");
    section.section("friction", Need::optional, "Coulomb friction and rotation (4.27, 4.28); none if absent",
                    [&](Section& below) { read_friction(below, model.friction.emplace()); });
    section.section("sintering", Need::optional, "sintering contacts; none if absent",
                    [&](Section& below) { read_sintering(below, model.sintering.emplace()); });
  });
}

}  // namespace densify::dem
