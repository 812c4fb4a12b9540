// Of what solids a packing consists.

#include "base/check.h"
#include "dem/network/moduli.h"
#include "tests/support/lattice_network.h"

namespace densify::dem {
namespace {

// A crystal with every eighth sphere twice as large and of another material: 8 of 15 of the volume are that material;
// one without moduli says which key to set.
TEST(SolidPhases, OfAComposite) {
  SpecimenNetwork s = test::lattice_network({});
  std::vector<Material> two{test::copper(), test::copper()};
  two[1].name = "stiff";
  two[1].youngs_modulus = PiecewiseLinear(4e11);
  constexpr double radius = 5e-6;
  s.radius.assign(8, radius), s.material.assign(8, 0);
  s.radius[3] = 2 * radius, s.material[3] = 1;
  const auto phases = solid_phases(s, two);
  ASSERT_EQ(phases.size(), 2u);
  EXPECT_NEAR(phases[0].fraction, 7.0 / 15, 1e-14);
  EXPECT_NEAR(phases[1].fraction, 8.0 / 15, 1e-14);
  EXPECT_NEAR(phases[1].moduli.youngs(), 4e11, 1);
  two[1].youngs_modulus = PiecewiseLinear();
  try {
    solid_phases(s, two);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("[materials.stiff]"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace densify::dem
