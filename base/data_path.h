#pragma once
// Where the shipped data files lie: the same call serves a build tree, an installation and a program of someone else.

#include <filesystem>
#include <string_view>

namespace densify {

/// Path of a shipped file or folder such as "materials/NiAl.toml", `relative` to the data folder.  Looks in the folder
/// that the environment variable DENSIFY_DATA names, then in ../share/densify seen from the running program, then in
/// the build tree of this binary; the first that holds it wins.  Throws FileError naming the folders it searched.
std::filesystem::path data_path(std::string_view relative);

}  // namespace densify
