#include "ground/model/block_spiller.h"

#include <gtest/gtest.h>

#include <initializer_list>
#include <optional>
#include <vector>

#include "common/testing/temporary_directory.h"
#include "ground/options/ground_options.pb.h"

namespace isotherm {
namespace {

/// Blocks are given back in parts of 64, so block 64 * i stands for part i.
constexpr std::int32_t kPart = 64;
constexpr std::int32_t kParts = 4;

class BlockSpillerTest : public ::testing::Test {
 protected:
  /// One frame that sees these blocks.
  void See(std::initializer_list<std::int32_t> blocks) {
    spiller_->Touch(std::vector<std::int32_t>(blocks));
    spiller_->Trim(tsdf_, thermal_);
    ++frame_;
  }
  void SeeNothingUntilFrame(int frame) {
    while (frame_ < frame) See({});
  }
  /// A part that was given back comes back into memory when it is touched.
  bool WasGivenBack(std::int32_t part) {
    const std::int64_t before = spiller_->resident_blocks();
    spiller_->Touch(std::vector<std::int32_t>{part * kPart});
    return spiller_->resident_blocks() != before;
  }
  static VoxelGrid SmallGrid() {
    VolumeOptions options;
    options.set_size_x_m(0.32);
    options.set_size_y_m(0.32);
    options.set_size_z_m(0.32);
    options.set_voxel_size_m(0.004);
    return MakeVoxelGrid(options).value();
  }

  testing::TemporaryDirectory directory_;
  TsdfVolume tsdf_{SmallGrid(), 0.016, kParts* kPart, directory_.path()};
  ThermalVolume thermal_{kParts * kPart, directory_.path()};
  std::optional<BlockSpiller> spiller_{2 * kPart};
  int frame_ = 0;
};

TEST_F(BlockSpillerTest, NothingIsGivenBackUpToTheLimit) {
  See({0, kPart});
  SeeNothingUntilFrame(100);
  EXPECT_EQ(spiller_->resident_blocks(), 2 * kPart);
  EXPECT_EQ(spiller_->spilled(), 0U);
}

TEST_F(BlockSpillerTest, OnlyWhatIsTooMuchIsGivenBackOldestFirst) {
  See({2 * kPart});
  See({0});
  See({3 * kPart});
  See({kPart});
  SeeNothingUntilFrame(100);
  EXPECT_EQ(spiller_->resident_blocks(), 2 * kPart);
  EXPECT_EQ(spiller_->spilled(), 2U * kPart);
  EXPECT_FALSE(WasGivenBack(3));
  EXPECT_FALSE(WasGivenBack(1));
  EXPECT_TRUE(WasGivenBack(2));
  EXPECT_TRUE(WasGivenBack(0));
}

TEST_F(BlockSpillerTest, PartsSeenWithinTheLastFramesAreKept) {
  spiller_.emplace(0);
  SeeNothingUntilFrame(3);
  See({0});      // Frame 4,
  See({kPart});  // and 5: 15 frames before the 20th, in which parts are given back.
  SeeNothingUntilFrame(20);
  EXPECT_EQ(spiller_->resident_blocks(), kPart);
  EXPECT_FALSE(WasGivenBack(1));
  EXPECT_TRUE(WasGivenBack(0));
}

TEST_F(BlockSpillerTest, WhatIsInViewStaysHoweverMuchItIs) {
  for (int i = 0; i < 100; ++i) See({0, kPart, 2 * kPart, 3 * kPart});
  EXPECT_EQ(spiller_->resident_blocks(), kParts * kPart);
  EXPECT_EQ(spiller_->spilled(), 0U);
}

TEST_F(BlockSpillerTest, APartIsNotGivenBackTwice) {
  spiller_.emplace(0);
  See({0});
  for (int i = 0; i < 100; ++i) See({kPart});
  EXPECT_EQ(spiller_->resident_blocks(), kPart);
  EXPECT_EQ(spiller_->spilled(), 1U * kPart);
}

TEST_F(BlockSpillerTest, PartsAreCountedOnceAndOnlyIfTheyWereSeen) {
  EXPECT_EQ(spiller_->resident_blocks(), 0);
  See({3 * kPart, 3 * kPart + 1, 4 * kPart - 1});
  See({3 * kPart});
  EXPECT_EQ(spiller_->resident_blocks(), kPart);
}

TEST_F(BlockSpillerTest, APartThatComesBackIsCountedAgain) {
  spiller_.emplace(0);
  for (const std::uint64_t times : {1U, 2U, 3U}) {
    See({0});
    EXPECT_EQ(spiller_->resident_blocks(), kPart);
    SeeNothingUntilFrame(frame_ + 50);
    EXPECT_EQ(spiller_->resident_blocks(), 0);
    EXPECT_EQ(spiller_->spilled(), times * kPart);
  }
}

TEST_F(BlockSpillerTest, OnlyWhatWasGivenBackIsReadAheadAndOnce) {
  spiller_.emplace(kPart);
  See({0});
  See({kPart});
  SeeNothingUntilFrame(50);
  ASSERT_EQ(spiller_->resident_blocks(), kPart);  // Part 1; part 0 was given back.
  const std::vector<std::int32_t> near = {0, 1, kPart, 3 * kPart};
  spiller_->Expect(near, tsdf_, thermal_);
  EXPECT_EQ(spiller_->fetched(), 1U * kPart);
  spiller_->Expect(near, tsdf_, thermal_);
  EXPECT_EQ(spiller_->fetched(), 1U * kPart);
  See({0});
  See({kPart});
  SeeNothingUntilFrame(100);
  spiller_->Expect(near, tsdf_, thermal_);
  EXPECT_EQ(spiller_->fetched(), 2U * kPart);
}

TEST_F(BlockSpillerTest, ValuesOutliveBeingGivenBack) {
  spiller_.emplace(0);
  ASSERT_TRUE(thermal_.Commit(kPart));
  for (std::int32_t i = 0; i < kPart; ++i) {
    const std::int32_t block = tsdf_.FindOrAllocate({i % 8, i / 8, 0});
    ASSERT_EQ(block, i);
    for (TsdfVoxel& voxel : tsdf_.voxels(block)) voxel.bits = 1000U + static_cast<unsigned>(i);
    for (ThermalVoxel& voxel : thermal_.voxels(block))
      voxel.bits = 2000U + static_cast<unsigned>(i);
  }
  See({0});
  SeeNothingUntilFrame(50);
  ASSERT_EQ(spiller_->spilled(), 1U * kPart);
  for (std::int32_t i = 0; i < kPart; ++i) {
    for (const TsdfVoxel& voxel : tsdf_.voxels(i))
      ASSERT_EQ(voxel.bits, 1000U + static_cast<unsigned>(i));
    for (const ThermalVoxel& voxel : thermal_.voxels(i))
      ASSERT_EQ(voxel.bits, 2000U + static_cast<unsigned>(i));
  }
}

}  // namespace
}  // namespace isotherm
