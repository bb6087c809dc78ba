#include "ground/tsdf/block_versions.h"

#include <gtest/gtest.h>

#include <array>
#include <cstdint>

namespace isotherm {
namespace {

TEST(BlockVersionsTest, ABlockThatWasNeverNotedHasVersionZero) {
  const BlockVersions versions;
  EXPECT_EQ(versions.newest(), 0U);
  EXPECT_EQ(versions.At(7), 0U);
}

TEST(BlockVersionsTest, NotedBlocksAreNewerThanAllOthers) {
  BlockVersions versions;
  versions.Note(std::array<std::int32_t, 3>{0, 1, 5});
  const std::uint32_t seen = versions.newest();
  versions.Note(std::array<std::int32_t, 2>{1, 8});
  EXPECT_LE(versions.At(0), seen);
  EXPECT_LE(versions.At(5), seen);
  EXPECT_GT(versions.At(1), seen);
  EXPECT_GT(versions.At(8), seen);
  EXPECT_EQ(versions.At(2), 0U);
}

TEST(BlockVersionsTest, NothingNotedMakesNoNewVersion) {
  BlockVersions versions;
  versions.Note({});
  versions.NoteAll(0);
  EXPECT_EQ(versions.newest(), 0U);
}

TEST(BlockVersionsTest, AllBlocksAreNewerOnceAllWereNoted) {
  BlockVersions versions;
  versions.Note(std::array<std::int32_t, 1>{2});
  const std::uint32_t seen = versions.newest();
  versions.NoteAll(4);
  for (std::int32_t block = 0; block < 4; ++block) EXPECT_GT(versions.At(block), seen);
  EXPECT_EQ(versions.At(4), 0U);
}

}  // namespace
}  // namespace isotherm
