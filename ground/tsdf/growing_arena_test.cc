#include "ground/tsdf/growing_arena.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <string>

#include "common/testing/temporary_directory.h"

namespace isotherm {
namespace {

using ::testing::HasSubstr;

constexpr std::size_t kMiB = std::size_t{1} << 20;
/// Address space only: more than the computer has memory.
constexpr std::size_t kReserve = std::size_t{1} << 37;
constexpr auto kMark = std::byte{0xA5};

void Mark(const GrowingArena& arena, std::size_t bytes) {
  std::memset(arena.data(), static_cast<int>(kMark), bytes);
}

std::size_t CountMarks(const GrowingArena& arena, std::size_t bytes) {
  return static_cast<std::size_t>(std::count(arena.data(), arena.data() + bytes, kMark));
}

/// Memory that the mapping which contains `address` takes of this process, bytes, as the kernel
/// tells it.
std::size_t ResidentBytes(const std::byte* address) {
  std::ifstream mappings("/proc/self/smaps");
  bool inside = false;
  for (std::string line; std::getline(mappings, line);) {
    const std::size_t dash = line.find('-');
    const bool is_range = dash != std::string::npos && dash < line.find(' ');
    if (is_range) {
      const auto value = reinterpret_cast<std::uintptr_t>(address);
      inside = value >= std::stoull(line, nullptr, 16) &&
               value < std::stoull(line.substr(dash + 1), nullptr, 16);
    } else if (inside && line.starts_with("Rss:")) {
      return 1024 * std::stoull(line.substr(line.find_first_of("0123456789")));
    }
  }
  ADD_FAILURE() << "no mapping contains the arena";
  return 0;
}

TEST(GrowingArenaTest, GrowsWithoutMovingAndBeginsWithZeros) {
  GrowingArena arena(kReserve);
  const std::byte* const begin = arena.data();
  ASSERT_TRUE(arena.Commit(kMiB));
  Mark(arena, kMiB);
  ASSERT_TRUE(arena.Commit(64 * kMiB));
  EXPECT_EQ(arena.data(), begin);
  EXPECT_EQ(CountMarks(arena, kMiB), kMiB);
  EXPECT_EQ(arena.data()[kMiB], std::byte{0});
  EXPECT_EQ(arena.data()[64 * kMiB - 1], std::byte{0});
}

TEST(GrowingArenaTest, MemoryIsTakenWhereItIsUsedOnly) {
  GrowingArena arena(kReserve);
  ASSERT_TRUE(arena.Commit(kReserve));
  Mark(arena, kMiB);
  EXPECT_GE(ResidentBytes(arena.data()), kMiB);
  EXPECT_LE(ResidentBytes(arena.data()), 4 * kMiB) << "whole large pages";
}

TEST(GrowingArenaTest, WithoutAFileNothingIsGivenBackAndNothingLost) {
  GrowingArena arena(8 * kMiB);
  Mark(arena, 8 * kMiB);
  arena.Decommit(0, 8 * kMiB);
  arena.Fetch(0, 8 * kMiB);
  EXPECT_EQ(ResidentBytes(arena.data()), 8 * kMiB);
  EXPECT_EQ(CountMarks(arena, 8 * kMiB), 8 * kMiB);
}

TEST(GrowingArenaTest, WithAFileWholePagesAreGivenBackAndComeBackAsTheyWere) {
  const testing::TemporaryDirectory folder;
  GrowingArena arena(kReserve, folder.path());
  ASSERT_TRUE(arena.Commit(8 * kMiB));
  Mark(arena, 8 * kMiB);
  ASSERT_GE(ResidentBytes(arena.data()), 8 * kMiB);
  // The first and the last page do not belong to the part as a whole.
  arena.Decommit(100, 8 * kMiB - 200);
  EXPECT_LE(ResidentBytes(arena.data()), kMiB);
  arena.Fetch(0, 8 * kMiB);
  EXPECT_EQ(CountMarks(arena, 8 * kMiB), 8 * kMiB);
}

TEST(GrowingArenaTest, TheFileHasNoNameAndGrowsAsItIsUsed) {
  const testing::TemporaryDirectory folder;
  GrowingArena arena(kReserve, folder.path());
  ASSERT_TRUE(arena.Commit(kMiB));
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(GrowingArenaTest, AFolderThatTakesNoFilesIsNamed) {
  EXPECT_TRUE(CheckSpillDir("").ok());
  const testing::TemporaryDirectory folder;
  EXPECT_TRUE(CheckSpillDir(folder.path()).ok());
  const Status status = CheckSpillDir(folder.path() / "absent");
  EXPECT_EQ(status.code(), StatusCode::kIoError);
  EXPECT_THAT(status.message(), HasSubstr("volume.spill_dir: no file can be made in"));
  EXPECT_THAT(status.message(), HasSubstr("absent"));
}

}  // namespace
}  // namespace isotherm
