// What no single part of a scene can see.

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/quantity.h"
#include "base/scene_node.h"
#include "dem/io/material_library.h"
#include "dem/io/scene_parts.h"

namespace densify::dem {
namespace {

using Missing = std::vector<std::string>;

std::string joined(const Missing& keys) {
  std::string all;
  for (const std::string& key : keys) all.append(all.empty() ? "" : ", ").append(key);
  return all;
}

Missing missing_for_sintering(const Interface& face) {
  const GrainBoundaryDiffusion& d = face.diffusion;
  Missing keys;
  const auto need = [&](double value, const char* key) {
    if (std::isnan(value)) keys.emplace_back(key);
  };
  need(d.atomic_volume, "atomic_volume");
  need(d.prefactor, "diffusion_prefactor");
  need(d.activation_enthalpy, "activation_enthalpy");
  need(d.grain_boundary_width, "grain_boundary_width");
  need(face.surface_energy, "surface_energy");
  need(face.dihedral_angle, "dihedral_angle");
  need(face.activation_temperature, "activation_temperature");
  return keys;
}

void check_materials(const Scene& scene, const ScenePlaces& places) {
  for (std::size_t m = 0; m < scene.materials.size(); ++m) {
    const Material& material = scene.materials[m];
    const Interface own = complete_interface(scene.materials, std::uint8_t(m), std::uint8_t(m), scene.interfaces);
    Missing keys;
    if (std::isnan(material.density)) keys.emplace_back("density");
    if (scene.contact.elasticity == Elasticity::hertz && std::isnan(own.effective_modulus)) {
      if (std::isnan(material.youngs_modulus(scene.reference_temperature))) keys.emplace_back("youngs_modulus");
      if (std::isnan(material.poissons_ratio(scene.reference_temperature))) keys.emplace_back("poissons_ratio");
    }
    if (scene.contact.sintering) {
      for (std::string& key : missing_for_sintering(own)) keys.push_back(std::move(key));
    }
    if (!keys.empty()) {
      places.materials[m].fail("", "lacks " + joined(keys) +
                                       ", which this contact model needs; set it here, or start from a shipped "
                                       "material (" +
                                       joined(library_names()) + ") with the key library");
    }
    const auto uses = [m](const PowderComponent& c) { return c.material == m; };
    if (scene.powder && std::none_of(scene.powder->components.begin(), scene.powder->components.end(), uses)) {
      places.materials[m].fail("", "no [[powder]] is of this material; remove it, or add one");
    }
  }
}

void check_pair(const Scene& scene, const ScenePlaces& places, std::uint8_t a, std::uint8_t b) {
  const Interface face = complete_interface(scene.materials, a, b, scene.interfaces);
  const auto given = std::find_if(scene.interfaces.begin(), scene.interfaces.end(),
                                  [&](const Interface& f) { return f.a == a && f.b == b; });
  const Section& place = given == scene.interfaces.end()
                             ? places.materials[a]
                             : places.interfaces[std::size_t(given - scene.interfaces.begin())];
  const std::string other = a == b ? "" : " and " + toml_text(scene.materials[b].name);
  const std::string pair = toml_text(scene.materials[a].name) + other;
  const auto lacks = [&](const Missing& keys) {
    place.fail("", "the contacts of " + pair + " lack " + joined(keys) + "; set it in " +
                       (given == scene.interfaces.end() ? "an" : "this") + " [[interface]] between them");
  };
  if (a != b && scene.contact.elasticity == Elasticity::hertz &&
      std::isnan(interface_modulus(face, scene.materials, scene.reference_temperature))) {
    lacks({"effective_modulus"});
  }
  if (!scene.contact.sintering) return;
  if (const Missing keys = missing_for_sintering(face); !keys.empty()) lacks(keys);
  if (scene.contact.sintering->starting_neck >= std::sin(0.5 * face.dihedral_angle)) {
    places.contact->fail("sintering", "starting_neck is not below sin(Psi/2) of " + pair +
                                          ", the neck at equilibrium over the radius (4.32); lower it");
  }
}

// Who never sinters beside another who does is no mistake.
void check_activation(const Scene& scene, const ScenePlaces& places) {
  double lowest = std::numeric_limits<double>::infinity();
  const auto n = std::uint8_t(scene.materials.size());
  for (std::uint8_t a = 0; a < n; ++a) {
    for (std::uint8_t b = a; b < n; ++b) {
      const Interface face = complete_interface(scene.materials, a, b, scene.interfaces);
      lowest = std::min(lowest, face.activation_temperature);
    }
  }
  const double peak = scene.schedule.peak_temperature();
  if (lowest <= peak) return;
  places.process->fail("stage", "sintering would never start: its lowest activation temperature is " +
                                    format_quantity(lowest, dim::temperature) + " and the process peaks at " +
                                    format_quantity(peak, dim::temperature) +
                                    "; heat more, lower activation_temperature, or remove [contact.sintering]");
}

void check_pressure(const Scene& scene, const ScenePlaces& places) {
  const bool walled = scene.container.shape == ContainerShape::cylinder || scene.container.shape == ContainerShape::box;
  if ((walled && scene.container.punch) || scene.container.shape == ContainerShape::periodic) return;
  const std::string reason =
      std::string("there is no punch that could apply a pressure; ") +
      (walled ? "set walls.punch.control = \"pressure\"" : "choose shape = \"cylinder\", \"box\" or \"periodic\"") +
      ", or remove the pressure";
  if (scene.schedule.pressure(0.0) > 0) places.process->fail("start_pressure", reason);
  for (const Stage& stage : scene.schedule.stages()) {
    if (stage.end_pressure > 0) places.process->fail("stage", "stage " + toml_text(stage.name) + ": " + reason);
  }
}

void check_container(const Scene& scene, const ScenePlaces& places) {
  const ContainerShape shape = scene.container.shape;
  const bool periodic = shape == ContainerShape::periodic;
  const bool edges = !scene.cell_vectors.isZero(0);
  if (!scene.powder && !scene.import) {
    places.specimen->fail("", "there are no particles; give a [[powder]] or [specimen.import]");
  }
  if (scene.powder && shape == ContainerShape::free) {
    places.specimen->fail("shape",
                          "a powder needs a cylinder, a box or a periodic cell to be packed in; a free "
                          "specimen is imported");
  }
  if (places.cell && !periodic) places.specimen->fail("cell", "belongs to shape = \"periodic\"; remove it");
  if (scene.powder && edges) places.cell->fail("a", "the cell of a powder follows from its packing; remove a, b, c");
  if (periodic && scene.import && !edges && scene.import->format == ImportSettings::Format::csv) {
    places.specimen->fail("shape", "a table has no periodic cell; give its edge vectors a, b, c in [specimen.cell]");
  }
  if (periodic && !scene.integration.gravity.isZero(0)) {
    places.integration->fail("gravity", "a periodic cell has no bottom on which particles could rest; remove it");
  }
  if (scene.realisations > 1 && !scene.powder && scene.perturbation.size == 0) {
    places.perturbation->fail("size",
                              "imported particles are the same in every realisation; give a size such as 1e-3 "
                              "here, or leave realisations out");
  }
  const WallMaterial& wall = scene.container.material;
  if (std::isnan(wall.youngs_modulus) != std::isnan(wall.poissons_ratio)) {
    places.walls->fail(std::isnan(wall.youngs_modulus) ? "youngs_modulus" : "poissons_ratio",
                       "missing; give both youngs_modulus and poissons_ratio of the walls, or neither");
  }
  if (scene.contact.elasticity == Elasticity::linear && !std::isnan(wall.youngs_modulus)) {
    places.walls->fail("youngs_modulus",
                       "has no meaning with linear elasticity, whose stiffness is normal_stiffness; "
                       "remove it with poissons_ratio");
  }
}

void check_cell(const Scene& scene, const ScenePlaces& places) {
  if (scene.output.energies && !scene.cell_path)
    places.output->fail("energies",
                        "adds up the work on a periodic cell that the stages drive, and none is; remove it, or give a "
                        "stage pressure, stress or strain_rate");
  if (!scene.cell_path) return;
  if (!scene.velocity_gradient.isZero(0))
    places.cell->fail("velocity_gradient",
                      "moves the cell through the whole process, which the stages drive by pressure, stress or "
                      "strain_rate; remove one of them");
  if (!scene.loads.empty())
    places.process->fail("stage",
                         "the stages drive the cell, and no stress of a periodic cell balances the forces of "
                         "a [[load]]; remove them");
  if (scene.cell_path->by_stress() && scene.integration.rule == StepRule::thesis)
    places.integration->fail("rule",
                             "\"thesis\" looks at one contact at a time and leaves no room for a cell that a "
                             "stress drives; use rule = \"particle_sum\"");
}

void check_integration(const Scene& scene, const ScenePlaces& places) {
  const IntegrationSettings& s = scene.integration;
  const bool controlled = !std::isnan(s.inertia_measure);
  if (!std::isnan(s.accuracy)) {
    const char* other = s.method == IntegrationMethod::inertia_free            ? "method = \"inertia_free\""
                        : s.inertia == Inertia::uniform                        ? "inertia = \"uniform\""
                        : !std::isnan(s.fixed_step)                            ? "fixed_step"
                        : s.mass_scaling != IntegrationSettings{}.mass_scaling ? "mass_scaling"
                                                                               : nullptr;
    if (other)
      places.integration->fail(
          "accuracy", std::string("chooses masses and steps of equalised inertia itself, and so does ") + other +
                          "; remove one of them");
  }
  if (s.inertia == Inertia::uniform) {
    if (controlled)
      places.integration->fail("inertia_measure", "belongs to inertia = \"equalised\"; set that, or remove this key");
    if (!std::isnan(s.smallest_step))
      places.integration->fail("smallest_step",
                               "belongs to inertia_measure; give that with inertia = \"equalised\", "
                               "or remove this key");
    return;
  }
  if (controlled == !std::isnan(s.fixed_step))
    places.integration->fail(controlled ? "fixed_step" : "inertia",
                             controlled ? "and inertia_measure both choose the step; remove one of them"
                                        : "equalised masses follow from a step; give inertia_measure (3e-3 is a good "
                                          "value) or fixed_step");
  if (s.mass_scaling != IntegrationSettings{}.mass_scaling)
    places.integration->fail("mass_scaling",
                             "has no meaning with inertia = \"equalised\", whose masses follow from "
                             "the step; remove it");
  if (s.smallest_step > s.largest_step) places.integration->fail("smallest_step", "is above largest_step; lower it");
}

}  // namespace

void check_scene(const Scene& scene, const ScenePlaces& places) {
  check_container(scene, places);
  check_integration(scene, places);
  if (scene.integration.method == IntegrationMethod::inertia_free && scene.contact.friction)
    places.integration->fail("method",
                             "\"inertia_free\" has no rotations, which [contact.friction] needs; remove it, or "
                             "use method = \"explicit\"");
  check_materials(scene, places);
  const auto n = std::uint8_t(scene.materials.size());
  for (std::uint8_t a = 0; a < n; ++a) {
    for (std::uint8_t b = a; b < n; ++b) check_pair(scene, places, a, b);
  }
  check_pressure(scene, places);
  check_cell(scene, places);
  if (scene.contact.sintering) {
    check_activation(scene, places);
  } else if (scene.stop_when == StopWhen::all_necks_at_equilibrium) {
    places.process->fail("stop_when", "there are no necks without [contact.sintering]; add it, or remove this key");
  }
}

}  // namespace densify::dem
