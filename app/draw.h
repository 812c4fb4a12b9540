#pragma once
// Pictures of results, by the shipped Python scripts.

#include <filesystem>
#include <string>
#include <vector>

namespace densify::app {

/// Runs tools/SCRIPT of the shipped data with these arguments.  False, with a word on how to draw later, when Python or
/// matplotlib is missing.
bool draw(const std::string& script, const std::vector<std::filesystem::path>& arguments);

}  // namespace densify::app
