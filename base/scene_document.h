#pragma once
// A scene file between its text and the declarations that read it.

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "base/section.h"

namespace densify {

/// Owns a parsed scene.  Visit root() once with everything that declares keys; then the same declarations answer for
/// unknown keys, help and effective input.
class SceneDocument {
 public:
  /// Reads a TOML file and applies overrides "path.to.key=value".  Throws InputError on a missing file, a mistake in
  /// TOML ("file:line:column: ...") or an override that does not fit; FileError on an unreadable file.
  static SceneDocument from_file(const std::filesystem::path& file, const std::vector<std::string>& overrides);

  /// The same from a text; `source_name` stands for the file in messages and for its folder in directory().
  static SceneDocument from_text(std::string_view text, std::string_view source_name,
                                 const std::vector<std::string>& overrides);

  /// A document whose visit records declarations instead of reading values.
  static SceneDocument for_help();

  SceneDocument(SceneDocument&&) noexcept;
  SceneDocument& operator=(SceneDocument&&) noexcept;
  ~SceneDocument();

  Section root();

  /// After the visit: every declared key with kind, range, default and meaning, one a line.
  std::string help_text() const;

  /// After the visit: TOML with every value in use in SI units; read again it gives the same values bit for bit.
  std::string effective_text() const;

  /// After the visit: the names of all declared keys, wherever they stand; for MissingKey::misspelling.
  std::vector<std::string> declared_keys() const;

  /// After the visit: throws InputError for a key nobody declared, with the nearest declared one.
  void reject_unknown() const;

 private:
  explicit SceneDocument(std::unique_ptr<SceneState> state);

  std::unique_ptr<SceneState> state_;
};

}  // namespace densify
