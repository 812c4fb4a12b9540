#pragma once
// A volume element along a path of densification, probed on the way: what response tables are made of.

#include <functional>

#include "base/tensor.h"
#include "dem/io/scene.h"

namespace densify::coupling {

/// How a cell is led.
enum class PathKind : std::uint8_t {
  die,          ///< pressed along z, its sides at rest
  hydrostatic,  ///< pressed from all sides
  free          ///< pressed from all sides until necks hold it, then free of stress
};

struct ElementPath {
  PathKind kind = PathKind::die;
  double pressure_factor = 1;   ///< of the pressures of the process
  double heating_factor = 1;    ///< of its heating rates
  double end_density = 0.99;    ///< relative, where the path ends
  double longest_hold = 36000;  ///< that the last stage at the highest temperature is prolonged for it [s]
};

/// What an element is at one point of its path.
struct PathPoint {
  double time;                    ///< [s]
  double temperature;             ///< [K]
  double density;                 ///< relative, by the cell
  double unloaded;                ///< relative, without its elastic strain
  Vec6 stress;                    ///< mean since the point before, tension positive [Pa]
  Mat6 stiffness;                 ///< bonded necks, over Young's modulus of the dense solid
  bool flows = false;             ///< has necks; the rest is of that only
  Mat6 viscosity = Mat6::Zero();  ///< times the share that diffusion has of that at the highest temperature [Pa s]
  Vec6 sintering_stress = Vec6::Zero();  ///< relaxed [Pa]
  double neck_state = 0;                 ///< mean of (a/a_max)^2 over the necks
  double at_equilibrium = 0;             ///< share of the necks
};

struct PathRecord {
  Schedule schedule;  ///< as it was led
  std::vector<PathPoint> points;
};

/// The process up to the end of its highest temperature, as the path changes it.  `activation` of sintering [K].
Schedule path_schedule(const Schedule& process, const ElementPath&, double activation);

/// Temperature at which necks begin to grow, of an element of one material [K].  Throws InputError when it has several
/// materials or no sintering: temperature factors out of one only.
double activation_of(const dem::Scene& element);

/// Leads one realisation along the path.  `watch` hears the share of the process that is done, and may throw.  Throws
/// InputError, RunError.
PathRecord run_path(const dem::Scene& element, const ElementPath&, const std::function<void(double)>& watch);

}  // namespace densify::coupling
