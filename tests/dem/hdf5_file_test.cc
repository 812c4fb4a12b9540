#include "dem/io/hdf5_file.h"

#include <sys/resource.h>

#include <csignal>
#include <limits>

#include "base/check.h"
#include "tests/dem/scratch_folder.h"

using namespace densify;
using namespace densify::dem;
using namespace densify::dem::testing;

namespace {

void fill(Hdf5Writer& file) {
  file.list<double>("/a/deep/numbers", {1.5, -0.0, std::numeric_limits<double>::denorm_min()}, "m");
  file.list<std::uint8_t>("/a/bytes", {0, 255}, "");
  file.list<std::uint32_t>("/a/words", {4000000000u}, "");
  file.list<std::uint64_t>("/a/longs", {18000000000000000000u}, "");
  file.list<double>("/a/none", {}, "s");
  file.table("/a/vectors", {Vec3(1, 2, 3), Vec3(4, 5, 6)}, "m/s");
  file.text("/a/text", "temperature = \"20 °C\"\n");
  file.texts("/a/texts", {"die", "", "punch"});
  file.attribute("/a", "time", 0.1);
  file.attribute("/a", "count", std::uint64_t(7));
  file.attribute("/", "version", "0.1.0");
}

}  // namespace

TEST(Hdf5File, RoundTrip) {
  const ScratchFolder folder;
  {
    Hdf5Writer file(folder / "f.h5");
    fill(file);
    EXPECT_FALSE(std::filesystem::exists(folder / "f.h5"));
    file.commit(Durability::power_loss);
  }
  EXPECT_EQ(folder.entries(), 1u);
  const Hdf5Reader file(folder / "f.h5");
  const auto numbers = file.read<double>("/a/deep/numbers");
  EXPECT_EQ(numbers, (std::vector<double>{1.5, 0, std::numeric_limits<double>::denorm_min()}));
  EXPECT_TRUE(std::signbit(numbers[1]));
  EXPECT_EQ(file.read<std::uint8_t>("/a/bytes"), (std::vector<std::uint8_t>{0, 255}));
  EXPECT_EQ(file.read<std::uint32_t>("/a/words"), std::vector<std::uint32_t>{4000000000u});
  EXPECT_EQ(file.read<std::uint64_t>("/a/longs"), std::vector<std::uint64_t>{18000000000000000000u});
  EXPECT_TRUE(file.read<double>("/a/none").empty());
  EXPECT_EQ(file.shape("/a/vectors").rows, 2u);
  EXPECT_EQ(file.shape("/a/vectors").columns, 3u);
  EXPECT_EQ(file.read<double>("/a/vectors"), (std::vector<double>{1, 2, 3, 4, 5, 6}));
  EXPECT_EQ(file.attribute<std::string>("/a/vectors", "unit"), "m/s");
  EXPECT_EQ(file.text("/a/text"), "temperature = \"20 °C\"\n");
  EXPECT_EQ(file.texts("/a/texts"), (std::vector<std::string>{"die", "", "punch"}));
  EXPECT_EQ(file.attribute<double>("/a", "time"), 0.1);
  EXPECT_EQ(file.attribute<std::uint64_t>("/a", "count"), 7u);
  EXPECT_EQ(file.attribute<std::string>("/", "version"), "0.1.0");
  EXPECT_TRUE(file.has("/a/deep"));
  EXPECT_FALSE(file.has("/a/shallow/numbers"));
}

TEST(Hdf5File, WithoutCommitNothingChanges) {
  const ScratchFolder folder;
  write_plainly(folder / "f.h5", "old");
  {
    Hdf5Writer file(folder / "f.h5");
    fill(file);
  }
  EXPECT_EQ(content_of(folder / "f.h5"), "old");
  EXPECT_EQ(folder.entries(), 1u);
}

TEST(Hdf5File, MissingFolderNamed) {
  const ScratchFolder folder;
  const auto message = message_of<FileError>([&] {
    Hdf5Writer file(folder / "nowhere/f.h5");
    file.commit(Durability::power_loss);
  });
  EXPECT_NE(message.find("nowhere/f.h5"), std::string::npos) << message;
  EXPECT_NE(message.find("No such file"), std::string::npos) << message;
}

// The same content gives the same bytes: no time of writing in the file.
TEST(Hdf5File, Reproducible) {
  const ScratchFolder folder;
  for (const char* name : {"f.h5", "g.h5"}) {
    Hdf5Writer file(folder / name);
    fill(file);
    file.commit(Durability::power_loss);
  }
  EXPECT_EQ(content_of(folder / "f.h5"), content_of(folder / "g.h5"));
}

// /dev/full fails every write with ENOSPC.
TEST(Hdf5File, FullDiskKeepsOldFile) {
  const ScratchFolder folder;
  write_plainly(folder / "f.h5", "old");
  std::filesystem::create_symlink("/dev/full", temporary_beside(folder / "f.h5"));
  const auto message = message_of<FileError>([&] {
    Hdf5Writer file(folder / "f.h5");
    fill(file);
    file.commit(Durability::power_loss);
  });
  EXPECT_NE(message.find("No space left"), std::string::npos) << message;
  EXPECT_EQ(content_of(folder / "f.h5"), "old");
  EXPECT_EQ(folder.entries(), 1u);
}

// The disk fills up halfway, here by a limit on the size of a file; afterwards the library still works.
TEST(Hdf5File, DiskFullHalfwayKeepsOldFile) {
  const ScratchFolder folder;
  write_plainly(folder / "f.h5", "old");
  const auto old_handler = std::signal(SIGXFSZ, SIG_IGN);
  rlimit limit;
  ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &limit), 0);
  const rlimit tight{100000, limit.rlim_max};
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &tight), 0);
  const auto message = message_of<FileError>([&] {
    Hdf5Writer file(folder / "f.h5");
    for (const char* name : {"/a", "/b", "/c"}) file.list(name, std::vector<double>(100000, 1.0), "m");
    file.commit(Durability::power_loss);
  });
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &limit), 0);
  std::signal(SIGXFSZ, old_handler);
  EXPECT_NE(message.find("File too large"), std::string::npos) << message;
  EXPECT_EQ(content_of(folder / "f.h5"), "old");
  EXPECT_EQ(folder.entries(), 1u);
  Hdf5Writer file(folder / "f.h5");
  fill(file);
  file.commit(Durability::power_loss);
  EXPECT_EQ(Hdf5Reader(folder / "f.h5").attribute<double>("/a", "time"), 0.1);
}

TEST(Hdf5File, ReadingMistakesNamed) {
  const ScratchFolder folder;
  EXPECT_THROW(Hdf5Reader(folder / "missing.h5"), FileError);
  write_plainly(folder / "text.h5", "not HDF5 at all");
  EXPECT_THROW(Hdf5Reader(folder / "text.h5"), FileError);
  Hdf5Writer writer(folder / "f.h5");
  fill(writer);
  const Hdf5Reader file(folder / "f.h5", writer.image());
  EXPECT_NE(message_of<FileError>([&] { file.read<double>("/a/absent"); }).find("/a/absent"), std::string::npos);
  EXPECT_THROW(file.read<double>("/a/words"), FileError);
  EXPECT_THROW(file.attribute<double>("/a", "absent"), FileError);
  EXPECT_THROW(writer.group("/a/text/below"), FileError);
}
