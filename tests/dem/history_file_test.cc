#include "dem/io/history_file.h"

#include <array>
#include <bit>
#include <cmath>
#include <limits>

#include "base/check.h"
#include "tests/dem/scratch_folder.h"

using namespace densify;
using namespace densify::dem;
using namespace densify::dem::testing;

namespace {

const std::vector<HistoryColumn> columns{{"time_s", "s"}, {"stage", ""}, {"temperature_K", "K"}};

std::uint64_t add(HistoryFile& file, double time, double temperature, std::string_view stage = "heating") {
  return file.add_row(std::array{time, temperature}, stage);
}

}  // namespace

// A row is in the file as soon as it is added, in few digits.
TEST(HistoryFile, RowsAppearAtOnce) {
  const ScratchFolder folder;
  auto file = HistoryFile::create(folder / "h.csv", columns);
  EXPECT_EQ(content_of(folder / "h.csv"), "time_s,stage,temperature_K\n");
  const auto bytes = add(file, 0.1, 293.15);
  EXPECT_EQ(bytes, content_of(folder / "h.csv").size());
  EXPECT_EQ(content_of(folder / "h.csv"), "time_s,stage,temperature_K\n0.1,heating,293.15\n");
}

// Every bit of a number survives; names with commas and quotes too.
TEST(HistoryFile, ReadsBackBitForBit) {
  const ScratchFolder folder;
  const double odd[] = {1.0 / 3, -0.0, 5e-324, 1.7976931348623157e308, 123456789.12345679};
  {
    auto file = HistoryFile::create(folder / "h.csv", columns);
    for (double v : odd) add(file, v, -v, "cool, \"slowly\"");
    add(file, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity());
  }
  const History h = read_history(folder / "h.csv");
  EXPECT_EQ(h.columns, (std::vector<std::string>{"time_s", "temperature_K"}));
  ASSERT_EQ(h.values[0].size(), 6u);
  for (std::size_t r = 0; r < 5; ++r) {
    EXPECT_EQ(std::bit_cast<std::uint64_t>(h.values[0][r]), std::bit_cast<std::uint64_t>(odd[r]));
    EXPECT_EQ(h.stage[r], "cool, \"slowly\"");
  }
  EXPECT_TRUE(std::isnan(h.values[0][5]));
  EXPECT_EQ(h.values[1][5], std::numeric_limits<double>::infinity());
}

// A run killed after its checkpoint leaves later rows, perhaps a torn one: they go, and the file ends as uninterrupted.
TEST(HistoryFile, ResumeDropsRowsAfterTheCheckpoint) {
  const ScratchFolder folder;
  std::uint64_t checkpoint;
  {
    auto file = HistoryFile::create(folder / "h.csv", columns);
    checkpoint = add(file, 0, 300);
    file.sync();
    add(file, 1, 310);
    add(file, 2, 320);
  }
  const std::string whole = content_of(folder / "h.csv");
  write_plainly(folder / "h.csv", whole + "3,hea");
  auto file = HistoryFile::resume(folder / "h.csv", columns, checkpoint);
  EXPECT_EQ(file.bytes(), checkpoint);
  add(file, 1, 310);
  EXPECT_EQ(add(file, 2, 320), whole.size());
  EXPECT_EQ(content_of(folder / "h.csv"), whole);
}

TEST(HistoryFile, ResumeRefusesWhatDoesNotFit) {
  const ScratchFolder folder;
  const auto path = folder / "h.csv";
  EXPECT_NE(message_of<InputError>([&] { HistoryFile::resume(path, columns, 30); }).find("missing"), std::string::npos);
  const auto bytes = HistoryFile::create(path, columns).bytes();
  EXPECT_NE(message_of<InputError>([&] { HistoryFile::resume(path, columns, bytes + 1); }).find("shorter"),
            std::string::npos);
  const std::vector<HistoryColumn> others{{"time_s", "s"}, {"stage", ""}};
  EXPECT_NE(message_of<InputError>([&] { HistoryFile::resume(path, others, bytes); }).find("other columns"),
            std::string::npos);
  EXPECT_EQ(content_of(path).size(), bytes);
}

TEST(HistoryFile, FullDiskNamed) {
  const ScratchFolder folder;
  std::filesystem::create_symlink("/dev/full", folder / "h.csv");
  const auto message = message_of<FileError>([&] { HistoryFile::create(folder / "h.csv", columns); });
  EXPECT_NE(message.find("h.csv"), std::string::npos);
  EXPECT_NE(message.find("No space left"), std::string::npos);
}

TEST(HistoryFile, ReadingNamesTheBadLine) {
  const ScratchFolder folder;
  write_plainly(folder / "h.csv", "time_s,stage\n0,a\n1\n");
  EXPECT_NE(message_of<InputError>([&] { read_history(folder / "h.csv"); }).find("h.csv:3:"), std::string::npos);
  write_plainly(folder / "h.csv", "time_s,stage\nzero,a\n");
  EXPECT_NE(message_of<InputError>([&] { read_history(folder / "h.csv"); }).find("h.csv:2: time_s"), std::string::npos);
}

// A last row without its end of line is no row yet.
TEST(HistoryFile, TornRowPassedOver) {
  const ScratchFolder folder;
  write_plainly(folder / "h.csv", "time_s,stage\n0,a\n1,");
  EXPECT_EQ(read_history(folder / "h.csv").stage.size(), 1u);
}
