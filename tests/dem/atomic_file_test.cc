#include "dem/io/atomic_file.h"

#include <sys/stat.h>
#include <unistd.h>

#include "base/check.h"
#include "tests/dem/scratch_folder.h"

using namespace densify;
using namespace densify::dem;
using namespace densify::dem::testing;

TEST(AtomicFile, ReplacesAndLeavesNothingBeside) {
  const ScratchFolder folder;
  write_atomically(folder / "a", {"first"}, Durability::power_loss);
  write_atomically(folder / "a", {"sec", "", "ond"}, Durability::power_loss);
  EXPECT_EQ(read_whole_file(folder / "a"), "second");
  EXPECT_EQ(folder.entries(), 1u);
}

// A temporary file that a killed run left behind is no obstacle.
TEST(AtomicFile, OverwritesForgottenTemporary) {
  const ScratchFolder folder;
  write_plainly(temporary_beside(folder / "a"), std::string(1000, 'x'));
  write_atomically(folder / "a", {"new"}, Durability::power_loss);
  EXPECT_EQ(content_of(folder / "a"), "new");
  EXPECT_EQ(folder.entries(), 1u);
}

// /dev/full fails every write with ENOSPC: put in the place of the temporary file it stands for a full disk.
TEST(AtomicFile, FullDiskKeepsOldFileAndSaysSo) {
  const ScratchFolder folder;
  write_atomically(folder / "a", {"old"}, Durability::power_loss);
  std::filesystem::create_symlink("/dev/full", temporary_beside(folder / "a"));
  const auto message = message_of<FileError>([&] { write_atomically(folder / "a", {"new"}, Durability::power_loss); });
  EXPECT_NE(message.find((folder / "a").string()), std::string::npos);
  EXPECT_NE(message.find("No space left on device"), std::string::npos);
  EXPECT_EQ(content_of(folder / "a"), "old");
  EXPECT_EQ(folder.entries(), 1u);
}

TEST(AtomicFile, MissingFolderNamed) {
  const ScratchFolder folder;
  const auto path = folder / "nowhere/a";
  const auto message = message_of<FileError>([&] { write_atomically(path, {"new"}, Durability::power_loss); });
  EXPECT_NE(message.find(path.string()), std::string::npos);
  EXPECT_NE(message.find("No such file"), std::string::npos);
}

// The superuser may write anywhere, so the test gives that up for its duration.
TEST(AtomicFile, MissingPermissionNamed) {
  const ScratchFolder folder;
  write_atomically(folder / "a", {"old"}, Durability::power_loss);
  ASSERT_EQ(::chmod(folder.path().c_str(), 0555), 0);
  constexpr uid_t nobody = 65534;
  const bool superuser = ::geteuid() == 0;
  if (superuser && ::seteuid(nobody) != 0) GTEST_SKIP() << "cannot give up the superuser's rights";
  const auto message = message_of<FileError>([&] { write_atomically(folder / "a", {"new"}, Durability::power_loss); });
  if (superuser) {
    ASSERT_EQ(::seteuid(0), 0);
  }
  ASSERT_EQ(::chmod(folder.path().c_str(), 0755), 0);
  EXPECT_NE(message.find("Permission denied"), std::string::npos) << message;
  EXPECT_EQ(content_of(folder / "a"), "old");
}
