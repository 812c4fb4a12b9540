#include "coupling/press_scene.h"

#include <fmt/core.h>

#include <cmath>
#include <limits>

#include "base/scene_document.h"
#include "base/section.h"
#include "dem/io/scene_element.h"

namespace densify::coupling {

namespace {

constexpr double not_set = std::numeric_limits<double>::quiet_NaN();

void read_size(Section& press, PressScene& scene) {
  double diameter = not_set;
  press.quantity("diameter", diameter, dim::length, Range::positive(), Need::required, "of the specimen and the die");
  press.quantity("height", scene.size.height, dim::length, Range::positive(), Need::required,
                 "of the powder before loading");
  scene.size.radius = scene.press.die_radius = 0.5 * diameter;
  scene.density = not_set;
  press.quantity("relative_density", scene.density, dim::none, Range::inside(0.1, 1),
                 scene.coupling == Coupling::closed_form ? Need::required : Need::optional,
                 "of the powder before loading; with a table or live volume elements theirs at process.start_pressure");
  if (!press.documenting() && press.has("relative_density")) {
    if (scene.coupling == Coupling::live)
      press.fail("relative_density", "the volume elements have their own, at process.start_pressure; remove it");
  } else if (!press.documenting() && scene.coupling == Coupling::table && !(scene.schedule->pressure(0) > 0)) {
    press.fail_missing(
        {"relative_density"},
        "relative_density is missing; give it, or a process.start_pressure above 0, for which the table has one");
  }
  press.choice("action", scene.settings.punches, {{"single", fem::Punches::upper}, {"double", fem::Punches::both}},
               Need::optional, "the upper punch alone comes into the die, or both alike");
  press.choice("geometry", scene.geometry,
               {{"axisymmetric", PressGeometry::axisymmetric}, {"quarter", PressGeometry::quarter}}, Need::optional,
               "a body of revolution, or a quarter of it in three dimensions");
  scene.size.radial = 6, scene.size.axial = 8;
  press.integer("elements_radial", scene.size.radial, 1, 1000, Need::optional,
                "over the radius; a quarter has 2, 4, 8, ...");
  press.integer("elements_axial", scene.size.axial, 1, 1000, Need::optional, "over the height");
  press.integer(
      "degree", scene.settings.degree, 1, 2, Need::optional,
      "of the displacements: 2 with pressures of degree 1, or 1 with one pressure an element, which is cheaper");
}

void read_die(Section& die, PressScene& scene) {
  die.quantity("friction", scene.settings.friction, dim::none, Range::non_negative(), Need::optional,
               "Coulomb's coefficient between body and die");
  die.quantity("thermal_expansion", scene.press.die_expansion, dim::thermal_expansion, Range::any(), Need::optional,
               "of the die");
  die.quantity("ejection_time", scene.press.ejection_time, dim::time, Range::non_negative(), Need::optional,
               "after the process the die leaves the body in this time; 0: it stays");
  if (scene.settings.friction > 1 && !die.documenting())
    scene.warnings.push_back("press.die.friction is above 1: few dies hold a body harder than they press it");
}

void read_material(Section& material, PressScene& scene) {
  auto& p = scene.material;
  p.viscosity = p.youngs_modulus = p.poissons_ratio = not_set;
  material.quantity("viscosity", p.viscosity, dim::viscosity, Range::positive(), Need::required,
                    "shear viscosity of the dense solid at reference_temperature");
  material.quantity("activation_enthalpy", p.activation_enthalpy, dim::molar_energy, Range::non_negative(),
                    Need::optional, "of the viscosity, which goes as exp(H/RT)");
  material.quantity("reference_temperature", p.reference_temperature, dim::temperature, Range::positive(),
                    Need::optional, "of the viscosity");
  material.quantity("surface_energy", p.surface_energy, dim::surface_energy, Range::non_negative(), Need::optional,
                    "of the pores: sintering stress 3 gamma/r times the density squared");
  material.quantity("particle_radius", p.particle_radius, dim::length, Range::positive(), Need::optional,
                    "r of the sintering stress");
  material.quantity("youngs_modulus", p.youngs_modulus, dim::pressure, Range::positive(), Need::required,
                    "of the dense solid");
  material.quantity("poissons_ratio", p.poissons_ratio, dim::none, Range::inside(-1, 0.5), Need::required,
                    "of the dense solid");
  material.quantity("thermal_expansion", p.thermal_expansion, dim::thermal_expansion, Range::any(), Need::optional,
                    "of the dense solid");
  if (!material.documenting() && p.surface_energy > 0 && !material.has("particle_radius"))
    material.fail_missing({"particle_radius"}, "surface_energy needs a particle_radius: the stress is 3 gamma/r");
}

void read_table(Section& table, PressScene& scene) {
  std::string file;
  table.text("file", file, Need::required, "that densify tabulate wrote, seen from the folder of the scene");
  scene.table = table.directory() / file;
  enum class Beyond { refuse, clamp } beyond = Beyond::refuse;
  table.choice("extrapolate", beyond, {{"refuse", Beyond::refuse}, {"clamp", Beyond::clamp}}, Need::optional,
               "where a point leaves the densities of the table: the run ends, or the last values stand");
  scene.clamp = beyond == Beyond::clamp;
}

void read_tabulate(Section& tabulate, TableSettings& s) {
  const Range density = Range::inside(0.5, 1);
  tabulate.quantity_list("pressure_factors", s.pressure_factors, dim::none, Range::positive(), Need::optional,
                         "of the process's pressures, growing: a branch of the table each");
  tabulate.integer("elements", s.elements, 1, 1000, Need::optional,
                   "that are averaged: seeds of the packing counted up");
  tabulate.quantity("end_density", s.end_density, dim::none, density, Need::optional,
                    "relative, where the table ends; below 1, where viscosities are infinite");
  tabulate.quantity("longest_hold", s.longest_hold, dim::time, Range::positive(), Need::optional,
                    "the stay at the highest temperature is prolonged by up to this for it");
  if (tabulate.documenting()) return;
  if (s.pressure_factors.empty()) tabulate.fail("pressure_factors", "needs at least one number");
  for (std::size_t k = 1; k < s.pressure_factors.size(); ++k)
    if (!(s.pressure_factors[k] > s.pressure_factors[k - 1]))
      tabulate.fail("pressure_factors", "the numbers do not grow; sort them");
}

/// The process, and its stages as the scene has them.
std::vector<Section> read_process(Section& process, PressScene& scene) {
  std::vector<Section> stages;
  double travel = not_set;
  scene.schedule = read_schedule(process, [&](Section& stage, double, double pressure) {
    double given = not_set;
    stage.quantity("punch_travel", given, dim::length, Range::non_negative(), Need::optional,
                   "how far the punches have come together since the start, at the end of the stage: drives it in "
                   "place of pressure, as those after it until one has a pressure");
    if (!stage.documenting() && !std::isnan(given) && !std::isnan(pressure))
      stage.fail("punch_travel", "and pressure both drive the punches; remove one of them");
    if (!std::isnan(given) || !std::isnan(pressure)) travel = given;
    scene.press.travel.push_back(travel);
    stages.push_back(stage);
  });
  return stages;
}

/// What the punches are to do against what there is to press.
void check_punches(const Section& process, const std::vector<Section>& stages, const Section& die,
                   const PressScene& scene) {
  const auto& travel = scene.press.travel;
  const double solid = std::isnan(scene.density) ? 0 : scene.density * scene.size.height;
  bool any = false;
  for (std::size_t k = 0; k < travel.size(); ++k) {
    any = any || !std::isnan(travel[k]);
    if (travel[k] > scene.size.height - solid)
      stages[k].fail("punch_travel", fmt::format("leaves less room than the solid takes up, {:.4g} mm of a height of "
                                                 "{:.4g} mm; give a shorter one",
                                                 1e3 * solid, 1e3 * scene.size.height));
  }
  const bool loaded = scene.schedule->pressure(0) > 0;
  if (!std::isnan(travel.front()) && loaded && scene.coupling != Coupling::live)
    process.fail("start_pressure",
                 "and the punch_travel of the first stage both drive the punches; remove one of them");
  if (any && scene.element && scene.coupling != Coupling::live)
    process.fail("stage", "has punch_travel, and [rve] is tabulated along pressures; give pressures, or remove [rve]");
  const bool held = !std::isnan(travel.back()) || scene.schedule->pressure(scene.schedule->end()) > 0;
  if (scene.press.ejection_time > 0 && held)
    die.fail("ejection_time",
             "a part that leaves its die has no punch pressure on it, and the process ends with the "
             "punches held; end it with a stage that has pressure = \"0 MPa\"");
}

void visit(Section root, PressScene& scene) {
  root.text("title", scene.title, Need::optional, "a line for results and reports");
  std::optional<Section> process_place, die_place;
  std::vector<Section> stage_places;
  root.section("process", Need::required, "temperature and pressure over time", [&](Section& process) {
    process_place = process;
    stage_places = read_process(process, scene);
  });
  root.section("press", Need::required, "a specimen in a die, by finite elements", [&](Section& press) {
    press.choice("coupling", scene.coupling,
                 {{"closed_form", Coupling::closed_form}, {"table", Coupling::table}, {"live", Coupling::live}},
                 Need::optional,
                 "what the material is: [press.material], [press.table], or a volume element [rve] in every element");
    read_size(press, scene);
    const auto need = [&](Coupling c) { return scene.coupling == c ? Need::required : Need::optional; };
    press.section("die", Need::defaulted, "rigid and round", [&](Section& die) {
      die_place = die;
      read_die(die, scene);
    });
    press.section("material", need(Coupling::closed_form), "Skorohod and Olevsky's porous solid",
                  [&](Section& material) { read_material(material, scene); });
    press.section("table", need(Coupling::table), "responses of volume elements",
                  [&](Section& table) { read_table(table, scene); });
    press.section("live", Need::defaulted, "volume elements", [&](Section& live) {
      live.choice("seeds", scene.live.seeds, {{"one", ElementSeeds::one}, {"each", ElementSeeds::each}}, Need::optional,
                  "one packing in all elements, or each its own, with seeds counted up from rve.specimen.packing.seed");
      live.quantity(
          "tolerance", scene.live.tolerance, dim::none, Range::between(1e-5, 0.1), Need::optional,
          "stress of a volume element off that of its affine law, over the largest stress so far, above which "
          "a step is solved again");
    });
    press.section("steps", Need::defaulted, "of time", [&](Section& steps) {
      steps.quantity("accuracy", scene.control.accuracy, dim::none, Range::inside(0, 0.1), Need::optional,
                     "numerical error that the relative density may have at the end");
      steps.quantity("balance", scene.settings.tolerance, dim::none, Range::between(3e-8, 1e-3), Need::optional,
                     "of forces at the end of a step, relative to the largest within the elements so far; stresses are "
                     "differences of strains of order 1, which leave no less");
    });
  });
  root.section("rve", scene.coupling == Coupling::live ? Need::required : Need::optional,
               "the volume element, with the tables of a scene of particles",
               [&](Section& element) { scene.element = dem::read_element(element, *process_place, *scene.schedule); });
  root.section("tabulate", Need::optional, "how densify tabulate makes a table of the volume element",
               [&](Section& tabulate) { read_tabulate(tabulate, scene.table_settings); });
  if (!root.documenting()) check_punches(*process_place, stage_places, *die_place, scene);
  if (scene.coupling == Coupling::live && !root.documenting() && !(scene.schedule->pressure(0) > 0))
    process_place->fail("start_pressure",
                        "live volume elements need one above 0, to which their powder is pressed before: loose "
                        "particles answer with no stress");
  root.section("output", Need::defaulted, "what is written", [&](Section& output) {
    output.quantity("field_interval", scene.field_interval, dim::time, Range::non_negative(), Need::optional,
                    "of the process, between fields for ParaView; 0: only at the ends of stages");
    output.quantity("checkpoint_interval", scene.checkpoint_interval, dim::time, Range::non_negative(), Need::optional,
                    "of the clock on the wall");
  });
}

PressScene read(SceneDocument document) {
  PressScene scene;
  try {
    visit(document.root(), scene);
  } catch (const MissingKey& missing) {
    SceneDocument all = SceneDocument::for_help();
    PressScene ignored;
    visit(all.root(), ignored);
    throw InputError(missing.what() + missing.misspelling(all.declared_keys()));
  }
  document.reject_unknown();
  constexpr double two_step_share = 2.0 / 9;  // BDF2's error over h^3 times the third derivative
  if (scene.coupling == Coupling::live) scene.control.error_share = two_step_share;
  scene.effective_text = document.effective_text();
  return scene;
}

std::filesystem::path scene_file(const std::filesystem::path& path) {
  return std::filesystem::is_directory(path) ? path / "scene.toml" : path;
}

}  // namespace

PressScene read_press_scene(const std::filesystem::path& path, const std::vector<std::string>& overrides) {
  PressScene scene = read(SceneDocument::from_file(scene_file(path), overrides));
  scene.file = scene_file(path);
  return scene;
}

PressScene read_press_scene_text(std::string_view text, const std::vector<std::string>& overrides) {
  return read(SceneDocument::from_text(text, "scene.toml", overrides));
}

std::string press_scene_help() {
  SceneDocument all = SceneDocument::for_help();
  PressScene ignored;
  visit(all.root(), ignored);
  return all.help_text();
}

}  // namespace densify::coupling
