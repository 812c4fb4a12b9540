#include "coupling/press_material.h"

#include <fmt/core.h>

#include <cmath>

#include "base/check.h"
#include "coupling/table_law.h"
#include "fem/press/viscous_solid.h"

namespace densify::coupling {

namespace {

/// A table of another powder than that of the scene's own volume element.
void require_same_material(const PressScene& scene, const ResponseTable& table) {
  if (scene.element && scene.element->materials[0].name != table.material)
    throw InputError(scene.table.string() + ": is a table of " + table.material + ", and [rve] is of " +
                     scene.element->materials[0].name + "; make one with densify tabulate");
}

PressMaterial live(const PressScene& scene, MPI_Comm comm) {
  const int dim = scene.geometry == PressGeometry::axisymmetric ? 2 : 3;
  const auto elements = std::size_t(fem::element_count(scene.size, dim));
  const auto points = std::size_t(std::lround(std::pow(scene.settings.degree + 1, dim)));
  const auto material = std::make_shared<LiveMaterial>(*scene.element, scene.live, elements, points, comm);
  double stiffest = 0;
  for (const dem::Material& m : scene.element->materials)
    stiffest = std::max(stiffest, m.youngs_modulus(scene.schedule->temperature(0)));
  return {material, stiffest, material->mean_density(), material};
}

}  // namespace

PressMaterial press_material(const PressScene& scene, MPI_Comm comm) {
  switch (scene.coupling) {
    case Coupling::closed_form:
      break;
    case Coupling::table: {
      const ResponseTable table = read_table(scene.table);
      require_same_material(scene, table);
      const auto law = std::make_shared<TableLaw>(table, scene.clamp);
      const double pressure = scene.schedule->pressure(0);
      if (std::isnan(scene.density) && !law->presses_to(pressure))
        throw InputError(fmt::format(
            "process.start_pressure: {} says nothing of loose powder under {:.3g} MPa, only of {:.3g} to {:.3g} MPa",
            scene.table.string(), 1e-6 * pressure, 1e-6 * law->loose_pressures().first,
            1e-6 * law->loose_pressures().second));
      return {std::make_shared<fem::ViscousSolid>(law), table.youngs_modulus(scene.schedule->temperature(0)),
              std::isnan(scene.density) ? *law->presses_to(pressure) : scene.density};
    }
    case Coupling::live:
      return live(scene, comm);
  }
  return {std::make_shared<fem::ViscousSolid>(std::make_shared<fem::SkorohodOlevsky>(scene.material)),
          scene.material.youngs_modulus, scene.density};
}

}  // namespace densify::coupling
