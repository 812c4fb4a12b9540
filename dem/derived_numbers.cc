#include "dem/derived_numbers.h"

#include <sstream>

#include "base/version.h"

namespace densify::dem {

std::string derived_numbers(const Scene& scene, Simulation& sim, const SpecimenReport& specimen) {
  std::ostringstream out;
  out.precision(9);
  const double real = [&] {
    double m = 0;
    for (std::size_t p = 0; p < sim.state().particles.size(); ++p) m += sim.real_mass(p);
    return m;
  }();
  out << "\n# Derived numbers\n";
  out << "# particles = " << sim.state().particles.size() << "\n";
  out << "# solid volume = " << sim.solid_volume() << " m^3\n";
  out << "# powder mass = " << real << " kg";
  if (!sim.equalised())
    out << ", as integrated (mass scaling " << scene.integration.mass_scaling
        << ") = " << real * scene.integration.mass_scaling << " kg";
  out << "\n";
  const Vec3& size = sim.setup().container.size;
  out << "# container = " << size[0] << " x " << size[1] << " x " << size[2] << " m\n";
  if (sim.state().punch.mass > 0)
    out << "# punch: fictitious mass = " << sim.state().punch.mass << " kg, area = " << sim.state().punch.area
        << " m^2\n";
  out << "# neighbour list skin = " << sim.state().contacts.skin << " m\n";
  for (std::size_t a = 0; a < scene.materials.size(); ++a)
    for (std::size_t b = a; b < scene.materials.size() && scene.contact.sintering; ++b) {
      const Interface& f = sim.table().interface(std::uint8_t(a), std::uint8_t(b));
      const double peak = scene.schedule.peak_temperature();
      out << "# " << scene.materials[a].name << " - " << scene.materials[b].name << ": activation at "
          << f.activation_temperature << " K; D_eff(" << peak << " K) = " << f.diffusion.effective(peak)
          << " m^5/(N s)\n";
    }
  if (!sim.equalised()) out << "# critical step at the start = " << sim.step_limit().critical << " s\n";
  for (const auto& line : specimen.lines) out << "# specimen: " << line << "\n";
  out << "# densify " << version() << " (" << git_revision() << ")\n";
  return out.str();
}

}  // namespace densify::dem
