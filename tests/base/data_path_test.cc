#include "base/data_path.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <string>

#include "base/check.h"

namespace fs = std::filesystem;

// A data folder of the test's own that DENSIFY_DATA names while the test runs.
struct DataPath : testing::Test {
  fs::path folder = fs::temp_directory_path() / ("densify_data_path_" + std::to_string(getpid()));

  void SetUp() override {
    fs::create_directories(folder / "materials");
    std::ofstream(folder / "materials" / "Fe.toml") << "name = \"Fe\"\n";
    setenv("DENSIFY_DATA", folder.c_str(), 1);
  }
  void TearDown() override {
    unsetenv("DENSIFY_DATA");
    fs::remove_all(folder);
  }
};

// The folder that DENSIFY_DATA names is the first to be searched, for files and for folders.
TEST_F(DataPath, NamedFolderComesFirst) {
  EXPECT_EQ(densify::data_path("materials/Fe.toml"), folder / "materials/Fe.toml");
  EXPECT_EQ(densify::data_path("materials"), folder / "materials");
}

// Without DENSIFY_DATA the folder is not searched.
TEST_F(DataPath, NamedFolderIsSearchedOnlyWhenNamed) {
  unsetenv("DENSIFY_DATA");
  EXPECT_THROW(densify::data_path("materials/Fe.toml"), densify::FileError);
}

// A missing file names itself, every folder that was searched, and the way out.
TEST_F(DataPath, MissingFileNamesWhatWasSearched) {
  try {
    densify::data_path("materials/Unobtainium.toml");
    FAIL();
  } catch (const densify::FileError& e) {
    const std::string message = e.what();
    EXPECT_NE(message.find("materials/Unobtainium.toml"), std::string::npos) << message;
    EXPECT_NE(message.find(folder.string() + ", "), std::string::npos) << message;
    EXPECT_NE(message.find("share/densify"), std::string::npos) << message;
    EXPECT_NE(message.find("DENSIFY_DATA"), std::string::npos) << message;
  }
}
