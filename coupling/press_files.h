#pragma once
// The files of a pressing.

#include <filesystem>
#include <string>
#include <vector>

#include "coupling/live_material.h"
#include "fem/press/press_run.h"

namespace densify::coupling {

/// Columns of history.csv and one row of it.
std::string press_history_header();
std::string press_history_row(const fem::PressRow&);

/// What is needed to go on, for a body of either dimension.
struct PressCheckpoint {
  std::string scene;  ///< effective text, without [output]
  fem::PressState body;
  fem::PressMemory run;
  double fields_at;      ///< when fields were written last [s]
  std::string fields;    ///< lines of the .pvd
  LiveMemory live = {};  ///< of the volume elements, where they live
};

void write_press_checkpoint(const std::filesystem::path&, const PressCheckpoint&);
/// Throws FileError when the file is not whole.
PressCheckpoint read_press_checkpoint(const std::filesystem::path&);

/// Fields of the accepted state: fields/NAME.vtu, of several ranks .pvtu with a piece each.  Collective.
template <int dim>
std::string write_press_fields(const std::filesystem::path& folder, const std::string& name,
                               const fem::PressBody<dim>&);

/// fields.pvd of `lines` "time file".
void write_press_collection(const std::filesystem::path& folder, const std::string& lines);

}  // namespace densify::coupling
