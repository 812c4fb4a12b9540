#include "base/scene_document.h"

#include <fstream>
#include <sstream>
#include <utility>

#include "base/check.h"
#include "base/section_record.h"

namespace densify {

SceneDocument::SceneDocument(std::unique_ptr<SceneState> state) : state_(std::move(state)) {
  state_->record.table = &state_->root;
}

SceneDocument::SceneDocument(SceneDocument&&) noexcept = default;
SceneDocument& SceneDocument::operator=(SceneDocument&&) noexcept = default;
SceneDocument::~SceneDocument() = default;

SceneDocument SceneDocument::from_file(const std::filesystem::path& file, const std::vector<std::string>& overrides) {
  if (!std::filesystem::exists(file)) throw InputError(file.string() + ": there is no such scene file");
  if (std::filesystem::is_directory(file)) throw InputError(file.string() + ": is a folder; name the scene file in it");
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream text;
  text << stream.rdbuf();
  if (!stream) throw FileError(file.string() + ": cannot be read (missing permission?)");
  return from_text(text.str(), file.string(), overrides);
}

SceneDocument SceneDocument::from_text(std::string_view text, std::string_view source_name,
                                       const std::vector<std::string>& overrides) {
  auto state = std::make_unique<SceneState>();
  state->source_name = source_name;
  state->root = parse_toml(text, source_name);
  for (const std::string& assignment : overrides) apply_override(state->root, assignment);
  return SceneDocument(std::move(state));
}

SceneDocument SceneDocument::for_help() {
  auto state = std::make_unique<SceneState>();
  state->mode = SceneState::Mode::documenting;
  state->source_name = "help";
  return SceneDocument(std::move(state));
}

Section SceneDocument::root() {
  return Section(*state_, state_->record);
}

std::string SceneDocument::help_text() const {
  return render_help(state_->record);
}

std::string SceneDocument::effective_text() const {
  return render_effective(state_->record);
}

std::vector<std::string> SceneDocument::declared_keys() const {
  return densify::declared_keys(state_->record);
}

void SceneDocument::reject_unknown() const {
  reject_unknown_keys(*state_);
}

}  // namespace densify
