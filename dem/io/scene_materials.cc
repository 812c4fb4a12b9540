// [materials.NAME] and [[interface]].

#include <algorithm>
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

}  // namespace

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
