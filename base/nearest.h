#pragma once
// "Did you mean": the nearest known word to a misspelt one.

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace densify {

/// The candidate with the fewest insertions, deletions, substitutions and swaps of neighbours away from `word` (a
/// change of case counts half), or nothing when none is close: about one edit for three letters.
std::optional<std::string> nearest(std::string_view word, const std::vector<std::string>& candidates);

/// "; did you mean \"x\"?", or nothing when no candidate is close.
std::string did_you_mean(std::string_view word, const std::vector<std::string>& candidates);

}  // namespace densify
