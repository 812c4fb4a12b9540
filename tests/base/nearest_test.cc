#include "base/nearest.h"

#include <gtest/gtest.h>

using namespace densify;

// One edit for about three letters: a slip is mended, another word is not.
TEST(Nearest, MendsSlipsOnly) {
  const std::vector<std::string> keys{"duration", "end", "rate", "temperature", "pressure"};
  EXPECT_EQ(nearest("presure", keys), "pressure");
  EXPECT_EQ(nearest("temprature", keys), "temperature");
  EXPECT_EQ(nearest("druation", keys), "duration");
  EXPECT_EQ(nearest("Rate", keys), "rate");
  EXPECT_EQ(nearest("humidity", keys), std::nullopt);
  EXPECT_EQ(nearest("x", keys), std::nullopt);
}

// A change of case is nearer than a change of letter.
TEST(Nearest, CaseCountsHalf) {
  EXPECT_EQ(nearest("Mpa", {"mPa", "GPa", "MPa"}), "MPa");
}
