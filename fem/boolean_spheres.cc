#include "fem/boolean_spheres.h"

#include <cmath>
#include <cstdio>
#include <numbers>
#include <random>

#include "base/check.h"

namespace densify::fem {

VoxelImage boolean_spheres(BooleanModel model, double solid_fraction, double box, int n, unsigned seed) {
  const double covered = model == BooleanModel::solid_spheres ? solid_fraction : 1 - solid_fraction;
  const double count = -std::log1p(-covered) * box * box * box / (4.0 / 3 * std::numbers::pi);
  constexpr double fewest = 10;
  if (count < fewest) {
    char text[160];
    std::snprintf(text, sizeof text,
                  "a solid fraction of %g takes %.1f spheres in a box of %g radii, too few for a random body; "
                  "take a box of %.1f or more",
                  solid_fraction, count, box, box * std::cbrt(fewest / count));
    throw InputError(text);
  }
  std::mt19937_64 random(seed);
  auto unit = [&] { return double(random() >> 11) * 0x1p-53; };
  LevelSet level(box * Mat3::Identity(), {n, n, n}, 0.5);
  for (long k = 0; k < std::lround(count); ++k) {
    const double x = unit(), y = unit(), z = unit();
    level.add(Ball{box * Vec3(x, y, z), 1.0, 0});
  }
  const double shift = level.shift_for(covered);
  return model == BooleanModel::solid_spheres ? level.body(shift) : level.complement(shift);
}

}  // namespace densify::fem
