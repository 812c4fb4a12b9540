#include "coupling/press_material.h"

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

}  // namespace

PressMaterial press_material(const PressScene& scene) {
  switch (scene.coupling) {
    case Coupling::closed_form:
      break;
    case Coupling::table: {
      const ResponseTable table = read_table(scene.table);
      require_same_material(scene, table);
      return {std::make_shared<fem::ViscousSolid>(std::make_shared<TableLaw>(table, scene.clamp)),
              table.youngs_modulus(scene.schedule->temperature(0))};
    }
    case Coupling::live:
      throw InputError("press.coupling: \"live\" is not there yet; take \"closed_form\"");
  }
  return {std::make_shared<fem::ViscousSolid>(std::make_shared<fem::SkorohodOlevsky>(scene.material)),
          scene.material.youngs_modulus};
}

}  // namespace densify::coupling
