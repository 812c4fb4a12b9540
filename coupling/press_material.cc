#include "coupling/press_material.h"

#include "base/check.h"
#include "fem/press/viscous_solid.h"

namespace densify::coupling {

PressMaterial press_material(const PressScene& scene) {
  switch (scene.coupling) {
    case Coupling::closed_form:
      break;
    case Coupling::table:
      throw InputError("press.coupling: \"table\" is not there yet; take \"closed_form\"");
    case Coupling::live:
      throw InputError("press.coupling: \"live\" is not there yet; take \"closed_form\"");
  }
  return {std::make_shared<fem::ViscousSolid>(std::make_shared<fem::SkorohodOlevsky>(scene.material)),
          scene.material.youngs_modulus};
}

}  // namespace densify::coupling
