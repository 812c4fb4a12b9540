// [process], [[load]], [integration], [guards], [output]: what happens, and how it is computed and written.

#include <limits>

#include "dem/io/scene_cell.h"

namespace densify::dem {

void read_process(Section& root, Scene& scene, ScenePlaces& places) {
  root.section("process", Need::required, "temperature and pressure over time, linear through stages",
               [&](Section& section) {
                 places.process = section;
                 CellPathReader cell(scene.container.shape);
                 scene.schedule = read_schedule(section, [&](Section& stage, double before, double given) {
                   cell.start(before);
                   cell.read_stage(stage, given);
                 });
                 scene.cell_path = cell.path();
                 section.choice("stop_when", scene.stop_when,
                                {{"schedule_ends", StopWhen::schedule_ends},
                                 {"all_necks_at_equilibrium", StopWhen::all_necks_at_equilibrium}},
                                Need::optional, "a run may end before its stages do");
               });
}

void read_loads(Section& root, Scene& scene) {
  root.list("load", Need::optional, "constant forces on single particles", [&](Section& section, std::size_t) {
    Load load;
    std::array<double, 3> force{unset, unset, unset};
    section.integer("particle", load.particle, 0, std::numeric_limits<std::uint32_t>::max(), Need::required,
                    "number of the particle in the order of the specimen, from 0");
    section.vector3("force", force, dim::force, Need::required, "the force");
    section.quantity("ramp", load.ramp, dim::time, Range::non_negative(), Need::optional,
                     "the force grows linearly over this time from the start");
    load.force = Vec3(force[0], force[1], force[2]);
    scene.loads.push_back(load);
  });
}

namespace {

void read_inertia_free(Section& section, InertiaFreeSettings& s) {
  constexpr Range share{0.0, 1.0, Bound::exclusive, Bound::inclusive};
  section.choice("from", s.from, {{"activation", InertiaFreeFrom::activation}, {"start", InertiaFreeFrom::start}},
                 Need::optional, "leap-frog until the first necks, or never");
  section.quantity("tangential_share", s.tangential_share, dim::none, share, Need::optional,
                   "f, resistance of a contact across its normal over that along it; results are those of f -> 0");
  section.quantity("mass_share", s.mass_share, dim::none, share, Need::optional,
                   "share of mass_scaling that stays, at least the real mass: holds a particle that no contact holds");
  section.quantity("step_tolerance", s.step_tolerance, dim::none, Range::positive(), Need::optional,
                   "error of a contact's approach in one step over the mean radius");
  section.quantity("force_tolerance", s.force_tolerance, dim::none, share, Need::optional,
                   "unbalanced over contact force at which a step counts as solved");
  section.quantity("fixed_step", s.fixed_step, dim::time, Range::positive(), Need::optional,
                   "one step for the whole run instead of the error control");
}

}  // namespace

void read_integration(Section& root, Scene& scene, ScenePlaces& places) {
  IntegrationSettings& s = scene.integration;
  constexpr Range share{0.0, 1.0, Bound::exclusive, Bound::inclusive};
  root.section("integration", Need::defaulted, "time steps of the leap-frog (4.8-4.13)", [&](Section& section) {
    places.integration = section;
    section.choice("method", s.method,
                   {{"explicit", IntegrationMethod::leapfrog}, {"inertia_free", IntegrationMethod::inertia_free}},
                   Need::optional,
                   "leap-frog with scaled masses, or from activation on velocities that balance all forces");
    if (section.documenting() || s.method == IntegrationMethod::inertia_free)
      section.section("inertia_free", Need::defaulted, "steps without inertia, by their error",
                      [&](Section& below) { read_inertia_free(below, s.inertia_free); });
    else
      refuse_keys(section, {"inertia_free"}, "belongs to method = \"inertia_free\"; remove it, or set method");
    section.named_quantity("accuracy", s.accuracy, {{"draft", 1e-2}, {"standard", 3e-3}, {"reference", 1e-3}},
                           dim::none, Range{0.0, 0.1, Bound::exclusive, Bound::inclusive}, Need::optional,
                           "numerical error of the relative density: equalised inertia whose steps are chosen for it");
    if (!std::isnan(s.accuracy)) choose_settings(s, s.accuracy);  // the defaults of what follows
    section.choice("rule", s.rule, {{"particle_sum", StepRule::particle_sum}, {"thesis", StepRule::thesis}},
                   Need::optional, "limit from the sums over each particle's contacts, or pair by pair (4.71)-(4.75)");
    section.quantity("step_safety", s.step_safety, dim::none, share, Need::optional,
                     "beta, step over the limit (4.76)");
    section.choice("inertia", s.inertia, {{"uniform", Inertia::uniform}, {"equalised", Inertia::equalised}},
                   Need::optional,
                   "real masses times mass_scaling, whose step follows; or for every particle the mass that a chosen "
                   "step needs: fixed_step, or what inertia_measure makes of it");
    section.quantity("fixed_step", s.fixed_step, dim::time, Range::positive(), Need::optional,
                     "one step for the whole run instead of the rule");
    section.quantity("largest_step", s.largest_step, dim::time, Range::positive(), Need::optional,
                     "the rule gives no longer step than this; with inertia_measure 1/1000 of the process if absent");
    section.quantity("smallest_step", s.smallest_step, dim::time, Range::positive(), Need::optional,
                     "inertia_measure starts from this step and gives no shorter one; 1/160 of largest_step if absent");
    section.quantity("inertia_measure", s.inertia_measure, dim::none, share, Need::optional,
                     "with equalised inertia: the inertial number, strain rate x mean diameter x root of (density that "
                     "moves / contact pressure), that the steps keep; the error of the density goes with its square");
    section.quantity(
        "load_steps", s.load_steps, dim::none, Range::positive(), Need::optional,
        "with inertia_measure: steps that a pressure takes from zero to its peak while the powder is loose");
    section.integer("limit_interval", s.limit_interval, 1, 1000000, Need::optional,
                    "steps between two evaluations of the limit");
    section.quantity("mass_scaling", s.mass_scaling, dim::none, Range::positive(), Need::optional,
                     "alpha_m, mass that moves over real mass (4.80)");
    section.quantity("skin", s.skin, dim::none, Range::positive(), Need::optional,
                     "reach of the neighbour list beyond contact, over the mean radius");
    std::array<double, 3> gravity{0.0, 0.0, 0.0};
    section.vector3("gravity", gravity, dim::acceleration, Need::optional, "acceleration of all particles");
    s.gravity = Vec3(gravity[0], gravity[1], gravity[2]);
  });
}

void read_guards(Section& root, Scene& scene) {
  GuardSettings& s = scene.integration.guards;
  root.section(
      "guards", Need::defaulted, "what ends a run that is no longer sound, or warns of it", [&](Section& section) {
        section.quantity("largest_overlap", s.largest_overlap, dim::none,
                         Range{0.0, 2.0, Bound::exclusive, Bound::inclusive}, Need::optional,
                         "over the smaller radius; a run ends when two particles are deeper in each other");
        section.quantity("quasi_static_ratio", s.quasi_static_ratio, dim::none, Range::positive(), Need::optional,
                         "kinetic over elastic energy above which a loaded specimen is not quasi-static, which warns");
      });
}

void read_output(Section& root, Scene& scene, ScenePlaces& places) {
  OutputSettings& s = scene.output;
  root.section("output", Need::defaulted, "what is written, and how often", [&](Section& section) {
    places.output = section;
    section.quantity("history_interval", s.history_interval, dim::time, Range::positive(), Need::optional,
                     "process time between rows of history.csv; 1/400 of the process if absent");
    section.quantity("snapshot_interval", s.snapshot_interval, dim::time, Range::positive(), Need::optional,
                     "process time between snapshots; only at the ends of stages if absent");
    section.quantity("checkpoint_interval", s.checkpoint_interval, dim::time, Range::positive(), Need::optional,
                     "time on the clock between checkpoints");
    section.flag("energies", s.energies,
                 "columns of history.csv with the work on a driven cell, and where it goes; every step is recorded");
    section.flag("visualisation", s.visualisation, "files for ParaView with every snapshot");
    section.flag(
        "stress_fields", s.stress_fields,
        "in these files the stress tensors of particles and the stresses in necks, sintering and viscoelastic");
  });
}

}  // namespace densify::dem
