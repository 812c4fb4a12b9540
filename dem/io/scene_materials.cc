// [materials.NAME] and [[interface]].

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <numbers>

#include "base/nearest.h"
#include "base/scene_node.h"
#include "dem/io/material_library.h"
#include "dem/io/scene_parts.h"

namespace densify::dem {
namespace {

MaterialCard from_library(const Section& section, const std::string& library) {
  const std::vector<std::string> shipped = library_names();
  if (std::find(shipped.begin(), shipped.end(), library) == shipped.end()) {
    std::string all;
    for (const std::string& name : shipped) all.append(all.empty() ? "" : ", ").append(toml_text(name));
    section.fail("library", toml_text(library) + " is not among the shipped " + all + did_you_mean(library, shipped));
  }
  return library_material(library);
}

std::string micrometres(double length) {
  char text[32];
  std::snprintf(text, sizeof text, "%.4g um", 1e6 * length);
  return text;
}

const char* name_of(ContainerShape shape) {
  switch (shape) {
    case ContainerShape::cylinder:
      return "cylinder";
    case ContainerShape::box:
      return "box";
    case ContainerShape::periodic:
      return "periodic";
    default:
      return "free";
  }
}

}  // namespace

std::vector<std::string> calibration_warnings(const Scene& scene, double size) {
  constexpr double alike = 1.5;  // ratio of sizes up to which a wall layer counts the same
  std::vector<std::string> lines;
  if (!scene.contact.sintering) return lines;
  for (std::size_t m = 0; m < scene.calibrations.size(); ++m) {
    const Calibration& c = scene.calibrations[m];
    if (!c.shape) continue;
    const bool sizes = *c.shape != ContainerShape::free && std::isfinite(c.size) && size > 0;
    const bool same_size = !sizes || (size <= alike * c.size && c.size <= alike * size);
    if (*c.shape == scene.container.shape && same_size) continue;
    const auto specimen = [&](ContainerShape shape, double of) {
      const bool sized = shape != ContainerShape::free && std::isfinite(of) && of > 0;
      return std::string("shape \"") + name_of(shape) + "\"" + (sized ? " of " + micrometres(of) : "");
    };
    lines.push_back("the diffusion of " + scene.materials[m].name + " was fitted to densities of a specimen of " +
                    specimen(*c.shape, c.size) + ", and this is one of " + specimen(scene.container.shape, size) +
                    ": its densities may be off (doc/theory.md, 14); fit it to a specimen of this kind");
  }
  return lines;
}

void read_materials(Section& root, Scene& scene, ScenePlaces& places) {
  root.named_list("materials", Need::required, "materials of the powder", [&](Section& section, std::string name) {
    std::string library;
    section.text("library", library, Need::optional,
                 "shipped material whose properties hold where the scene gives none");
    MaterialCard card;
    if (section.has("library")) card = from_library(section, library);
    card.material.name = name;
    read_material_keys(section, card);
    constexpr std::size_t most = std::numeric_limits<std::uint8_t>::max();
    if (scene.materials.size() == most) section.fail("", "too many materials; at most 255 are possible");
    scene.materials.push_back(card.material);
    scene.calibrations.push_back(card.calibration);
    places.materials.push_back(section);
  });
}

void read_interfaces(Section& root, Scene& scene, ScenePlaces& places) {
  const auto visit = [&](Section& section, std::size_t) {
    Interface face;
    std::vector<std::string> between;
    section.text_list("between", between, Need::required, "the two materials that meet here");
    section.quantity("effective_modulus", face.effective_modulus, dim::pressure, Range::positive(), Need::optional,
                     "E* of the pair; from the two materials by (4.20) if absent");
    read_diffusion_keys(section, face.diffusion);
    section.quantity("surface_energy", face.surface_energy, dim::surface_energy, Range::non_negative(), Need::optional,
                     "gamma_s of the pair; \"0 J/m^2\" means no sintering force (thesis 5.4)");
    section.quantity("dihedral_angle", face.dihedral_angle, dim::angle, Range::inside(0.0, std::numbers::pi),
                     Need::optional, "Psi of the pair (4.32)");
    section.quantity("activation_temperature", face.activation_temperature, dim::temperature, Range::positive(),
                     Need::optional, "sintering of the pair starts here; the higher of the two materials' if absent");
    if (section.documenting()) return;
    if (between.size() != 2) {
      section.fail("between", "expected two materials, found " + std::to_string(between.size()));
    }
    face.a = material_index(section, "between", between[0], scene);
    face.b = material_index(section, "between", between[1], scene);
    if (face.a > face.b) std::swap(face.a, face.b);
    for (std::size_t k = 0; k < scene.interfaces.size(); ++k) {
      if (scene.interfaces[k].a == face.a && scene.interfaces[k].b == face.b) {
        section.fail("between", "these two already have an interface at " + places.interfaces[k].where("between") +
                                    "; merge the two sections");
      }
    }
    scene.interfaces.push_back(face);
    places.interfaces.push_back(section);
  };
  root.list("interface", Need::optional,
            "contacts of two materials; pairs of one material take its own properties where nothing is given here",
            visit);
}

}  // namespace densify::dem
