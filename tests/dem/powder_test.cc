#include "dem/powder/powder.h"

#include <gtest/gtest.h>

#include <numbers>

#include "base/check.h"

using namespace densify;
using namespace densify::dem;

namespace {

const TruncatedLognormal nial{3.97, 2.50, 1.50, 18.61};
const TruncatedLognormal alumina{2.48, 0.89, 1.25, 5.88};

double volume_fraction(const PowderSample& s, std::uint8_t material) {
  return solid_volume(diameters_of(s, material)) / solid_volume(s.diameter);
}

}  // namespace

// 1751 NiAl particles and 20 % of alumina by volume: the alumina follows from the NiAl.  Half of the largest alumina
// particle in the whole is pi/12 5.88^3 / 1.9e5 = 3e-4.
TEST(Powder, FractionBesideANumber) {
  const PowderSample s = draw(Powder{{{0, nial, ParticleCount{1751}}, {1, alumina, VolumeFraction{0.2}}}, {}, 7});
  EXPECT_EQ(diameters_of(s, 0).size(), 1751u);
  EXPECT_NEAR(volume_fraction(s, 1), 0.2, 3e-4);
  EXPECT_NE(s.material[0] + s.material[1] + s.material[2] + s.material[3], 0);  // mixed, not one after the other
}

// A total number, shared so that the volumes are 80 : 20.
TEST(Powder, FractionsOfATotalNumber) {
  const PowderSample s =
      draw(Powder{{{0, nial, VolumeFraction{0.8}}, {1, alumina, VolumeFraction{0.2}}}, ParticleCount{4952}, 7});
  EXPECT_NEAR(double(s.diameter.size()), 4952, 20);
  EXPECT_NEAR(volume_fraction(s, 1), 0.2, 2e-3);
}

// A total volume of equal spheres: exact to half a sphere.
TEST(Powder, FractionsOfATotalVolume) {
  const double sphere = std::numbers::pi / 6;
  const PowderSample s =
      draw(Powder{{{0, SizeList{{1}}, VolumeFraction{0.25}}, {3, SizeList{{1}}, VolumeFraction{0.75}}},
                  SolidVolume{400 * sphere},
                  1});
  EXPECT_EQ(diameters_of(s, 0).size(), 100u);
  EXPECT_EQ(diameters_of(s, 3).size(), 300u);
}

TEST(Powder, SameSeedSamePowder) {
  const Powder p{{{0, nial, ParticleCount{50}}, {1, alumina, SolidVolume{300}}}, {}, 7};
  EXPECT_EQ(draw(p).diameter, draw(p).diameter);
  EXPECT_EQ(draw(p).material, draw(p).material);
}

TEST(Powder, RefusesAmountsThatDoNotFit) {
  const PowderComponent half{0, nial, VolumeFraction{0.5}}, all{0, nial, VolumeFraction{1.0}},
      wrong{0, nial, VolumeFraction{-0.1}}, none{0, nial, ParticleCount{0}}, ten{0, nial, ParticleCount{10}};
  EXPECT_THROW(draw(Powder{{}, {}, 1}), InputError);
  EXPECT_THROW(draw(Powder{{none}, {}, 1}), InputError);
  EXPECT_THROW(draw(Powder{{half, half}, {}, 1}), InputError);
  EXPECT_THROW(draw(Powder{{all, ten}, {}, 1}), InputError);
  EXPECT_THROW(draw(Powder{{wrong, ten}, {}, 1}), InputError);
  EXPECT_THROW(draw(Powder{{half}, ParticleCount{10}, 1}), InputError);
  EXPECT_THROW(draw(Powder{{half, ten}, ParticleCount{10}, 1}), InputError);
  EXPECT_THROW(draw(Powder{{all}, ParticleCount{0}, 1}), InputError);
}
