#include "base/nearest.h"
#include "base/scene_document.h"
#include "base/scene_node.h"
#include "dem/io/scene_element.h"
#include "dem/io/scene_parts.h"

namespace densify::dem {
namespace {

/// What the particles are made of, and where they stand.
void read_particles(Section& table, Scene& scene, ScenePlaces& places) {
  table.quantity("reference_temperature", scene.reference_temperature, dim::temperature, Range::positive(),
                 Need::optional, "at which sizes and densities are given");
  read_materials(table, scene, places);
  read_interfaces(table, scene, places);
  read_powder(table, scene, places);
  read_specimen(table, scene, places);
}

void visit(Section root, Scene& scene, ScenePlaces& places) {
  root.text("title", scene.title, Need::optional, "a line for results and reports");
  root.integer(
      "realisations", scene.realisations, 1, 100000, Need::optional,
      "runs side by side, one a core: seeds of the packing counted up, or with specimen.perturbation its seeds; "
      "the history is their mean");
  read_particles(root, scene, places);
  read_walls(root, scene, places);
  read_contact(root, scene, places);
  read_process(root, scene, places);
  read_loads(root, scene);
  read_integration(root, scene, places);
  read_guards(root, scene);
  read_output(root, scene, places);
}

/// A document in which every key of a scene is declared.
SceneDocument all_keys() {
  SceneDocument document = SceneDocument::for_help();
  Scene scene;
  ScenePlaces places;
  visit(document.root(), scene, places);
  return document;
}

Scene read(SceneDocument document) {
  Scene scene;
  ScenePlaces places;
  try {
    visit(document.root(), scene, places);
  } catch (const MissingKey& missing) {
    throw InputError(missing.what() + missing.misspelling(all_keys().declared_keys()));
  }
  document.reject_unknown();
  check_scene(scene, places);
  scene.effective_text = document.effective_text();
  if (places.packing)
    scene.places.emplace_back("specimen.packing.green_density", places.packing->where("green_density"));
  if (places.import) scene.places.emplace_back("specimen.import.file", places.import->where("file"));
  if (places.integration) scene.places.emplace_back("integration.fixed_step", places.integration->where("fixed_step"));
  if (places.integration)
    scene.places.emplace_back("integration.mass_scaling", places.integration->where("mass_scaling"));
  return scene;
}

}  // namespace

std::string Scene::placed(const std::string& message) const {
  for (const auto& [key, place] : places)
    if (message.starts_with(key + ":")) return place + message.substr(key.size());
  return message;
}

Scene read_scene(const std::filesystem::path& path, const std::vector<std::string>& overrides) {
  const auto file = std::filesystem::is_directory(path) ? path / "scene.toml" : path;
  Scene scene = read(SceneDocument::from_file(file, overrides));
  scene.file = file;
  return scene;
}

Scene read_scene_text(std::string_view text, const std::vector<std::string>& overrides) {
  return read(SceneDocument::from_text(text, "scene.toml", overrides));
}

Scene read_element(Section& element, const Section& process, const Schedule& schedule) {
  Scene scene;
  ScenePlaces places;
  scene.schedule = schedule;
  places.process = process;
  read_particles(element, scene, places);
  read_contact(element, scene, places);
  read_integration(element, scene, places);
  read_guards(element, scene);
  if (element.documenting()) return scene;
  if (scene.container.shape != ContainerShape::periodic)
    places.specimen->fail("shape", "a volume element is a periodic cell; set shape = \"periodic\"");
  if (!scene.velocity_gradient.isZero(0))
    places.cell->fail("velocity_gradient", "the specimen moves the cell of a volume element; remove it");
  check_scene(scene, places);
  return scene;
}

Scene with_overrides(const Scene& scene, const std::vector<std::string>& overrides) {
  // The effective input reads back to the same scene bit for bit; the name of the file keeps relative paths right.
  Scene changed = read(SceneDocument::from_text(scene.effective_text, scene.file.string(), overrides));
  changed.file = scene.file;
  changed.places = scene.places;
  return changed;
}

std::string scene_help() {
  return all_keys().help_text();
}

std::uint8_t material_index(const Section& section, std::string_view key, const std::string& name, const Scene& scene) {
  std::vector<std::string> names;
  std::string all;
  for (const Material& material : scene.materials) {
    if (material.name == name) return std::uint8_t(names.size());
    names.push_back(material.name);
    all.append(all.empty() ? "" : ", ").append(toml_text(material.name));
  }
  section.fail(key, toml_text(name) + " is not among the materials " + all + did_you_mean(name, names));
}

void refuse_keys(const Section& section, std::initializer_list<std::string_view> keys, std::string_view reason) {
  for (const std::string_view key : keys) {
    if (section.has(key)) section.fail(key, reason);
  }
}

std::string_view require_one(const Section& section, std::initializer_list<std::string_view> keys) {
  std::string all;
  std::string found;
  std::string_view given = *keys.begin();
  for (const std::string_view key : keys) {
    all.append(all.empty() ? "" : ", ").append(key);
    if (!section.has(key)) continue;
    found.append(found.empty() ? "" : " and ").append(key);
    given = key;
  }
  if (section.documenting() || found == given) return given;
  const std::string problem = "needs exactly one of " + all + ", found ";
  if (found.empty()) section.fail_missing(keys, problem + "none");
  section.fail("", problem + found);
}

}  // namespace densify::dem
