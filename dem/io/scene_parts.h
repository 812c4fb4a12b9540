#pragma once
// How read_scene is put together: one function a part of the scene, and the places that checks across parts name.

#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/section.h"
#include "dem/io/scene.h"

namespace densify::dem {

/// The sections of a scene, so that a check across several of them can name the line to mend.
struct ScenePlaces {
  std::vector<Section> materials;   ///< in the order of Scene::materials
  std::vector<Section> interfaces;  ///< in the order of Scene::interfaces
  std::vector<Section> powders;     ///< in the order of the components
  std::optional<Section> specimen, packing, import, perturbation, cell, walls, contact, process, integration, output;
};

// Each declares and reads its part; a document for help is visited once with defaults.  All throw InputError.
void read_materials(Section& root, Scene&, ScenePlaces&);  // before all parts that name materials
void read_interfaces(Section& root, Scene&, ScenePlaces&);
void read_powder(Section& root, Scene&, ScenePlaces&);
void read_specimen(Section& root, Scene&, ScenePlaces&);  // after the powder
void read_walls(Section& root, Scene&, ScenePlaces&);     // after the specimen
void read_contact(Section& root, Scene&, ScenePlaces&);
void read_process(Section& root, Scene&, ScenePlaces&);
void read_loads(Section& root, Scene&);
void read_integration(Section& root, Scene&, ScenePlaces&);
void read_guards(Section& root, Scene&);
void read_output(Section& root, Scene&, ScenePlaces&);

/// What no single part can see: properties the contact model lacks, pressure without a punch, sintering that never
/// starts, and the like.  Throws InputError at the key to mend.
void check_scene(const Scene&, const ScenePlaces&);

/// Index of a material; InputError at `key` with the nearest name when the scene has none of that name.
std::uint8_t material_index(const Section&, std::string_view key, const std::string& name, const Scene&);

/// InputError with the reason at the first of `keys` that the scene gives.
void refuse_keys(const Section&, std::initializer_list<std::string_view> keys, std::string_view reason);

/// InputError at the table unless exactly one of `keys` is given; returns the one given, the first for help.
std::string_view require_one(const Section&, std::initializer_list<std::string_view> keys);

}  // namespace densify::dem
