#include "base/check.h"

#include <gtest/gtest.h>

// A breach of contract names the condition and the place.
TEST(Check, BrokenContractNamesConditionAndPlace) {
  try {
    densify::detail::broken_contract("n > 0", "x.cc", 7);
    FAIL();
  } catch (const std::logic_error& e) {
    EXPECT_NE(std::string(e.what()).find("n > 0 at x.cc:7"), std::string::npos);
  }
}
