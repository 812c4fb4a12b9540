#include "base/version.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

// major.minor.patch, the number that find_package(Densify) compares.
TEST(Version, IsThreeNumbers) {
  const std::string version(densify::version());
  EXPECT_EQ(std::count(version.begin(), version.end(), '.'), 2);
  EXPECT_EQ(version.find_first_not_of("0123456789."), std::string::npos) << version;
}

// A result must name its program: never empty, one word.
TEST(Version, RevisionIsOneWord) {
  const std::string revision(densify::git_revision());
  EXPECT_FALSE(revision.empty());
  EXPECT_EQ(revision.find_first_of(" \n@"), std::string::npos) << revision;
}
