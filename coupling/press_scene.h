#pragma once
// A scene that presses a whole specimen: the tables [process] and [press].

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/schedule.h"
#include "coupling/live_material.h"
#include "coupling/tabulate.h"
#include "dem/io/scene.h"
#include "fem/press/porous_law.h"
#include "fem/press/press_run.h"

namespace densify::coupling {

enum class PressGeometry { axisymmetric, quarter };

/// What answers for the material at a point.
enum class Coupling {
  closed_form,  ///< Skorohod and Olevsky's solid
  table,        ///< responses of volume elements, tabulated
  live          ///< a volume element in every finite element
};

struct PressScene {
  std::string title;
  std::filesystem::path file;
  std::optional<Schedule> schedule;
  PressGeometry geometry = PressGeometry::axisymmetric;
  fem::CylinderSize size{};
  double density = 0;  ///< relative, before loading; NaN: that of the volume elements or of the table
  fem::PressSettings settings;
  fem::Press press{};
  fem::StepControl control;
  Coupling coupling = Coupling::closed_form;
  fem::SkorohodOlevsky::Parameters material{};
  std::filesystem::path table;        ///< of responses
  TableSettings table_settings;       ///< for densify tabulate
  bool clamp = false;                 ///< beyond the ends of the table its last values stand
  std::optional<dem::Scene> element;  ///< the volume element, where the scene has one
  LiveSettings live;
  double field_interval = 0;        ///< of the process [s]; 0: only ends of stages
  double checkpoint_interval = 60;  ///< of the clock on the wall [s]
  std::vector<std::string> warnings;
  std::string effective_text;  ///< all values in use; read again it is the same scene
};

/// Throws InputError with file, line and key.
PressScene read_press_scene(const std::filesystem::path&, const std::vector<std::string>& overrides);
PressScene read_press_scene_text(std::string_view text, const std::vector<std::string>& overrides);

/// Every key with unit, range, default and meaning.
std::string press_scene_help();

}  // namespace densify::coupling
