#pragma once
// Reads small scenes from texts and catches their messages.

#include <string>
#include <string_view>
#include <vector>

#include "base/check.h"
#include "base/scene_document.h"

namespace densify::test {

/// The message of reading `text` as scene.toml with `visitor(Section&)`, unknown keys included; "accepted" if none.
template <class Visitor>
std::string message_of(std::string_view text, Visitor visitor, const std::vector<std::string>& overrides = {}) {
  try {
    SceneDocument document = SceneDocument::from_text(text, "scene.toml", overrides);
    Section root = document.root();
    visitor(root);
    document.reject_unknown();
  } catch (const InputError& e) {
    return e.what();
  }
  return "accepted";
}

/// The effective text of the same.
template <class Visitor>
std::string effective_of(std::string_view text, Visitor visitor, const std::vector<std::string>& overrides = {}) {
  SceneDocument document = SceneDocument::from_text(text, "scene.toml", overrides);
  Section root = document.root();
  visitor(root);
  document.reject_unknown();
  return document.effective_text();
}

}  // namespace densify::test
