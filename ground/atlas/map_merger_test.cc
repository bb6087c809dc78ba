#include "ground/atlas/map_merger.h"

#include <gtest/gtest.h>

#include <cmath>

#include "ground/atlas/testing/volumes.h"

namespace isotherm {
namespace {

using testing::FillVolume;
using testing::kTruncation_m;
using testing::SmallGrid;
using testing::SphereDistance;

constexpr float kMaxWeight = 255.0F;
const Eigen::Vector3d kCentre(0.08, 0.08, 0.08);

struct Volumes {
  explicit Volumes(std::int32_t max_blocks = 125)
      : tsdf(SmallGrid(), kTruncation_m, max_blocks), thermal(max_blocks) {}
  TsdfVolume tsdf;
  ThermalVolume thermal;
};

class MapMergerTest : public ::testing::Test {
 protected:
  bool Merge(const RigidTransform& T_target_source) {
    return MergeVolume({source_.tsdf, source_.thermal, T_target_source}, kMaxWeight, pool_,
                       target_.tsdf, target_.thermal);
  }

  ThreadPool pool_{2};
  Volumes source_;
  Volumes target_;
};

TEST_F(MapMergerTest, AnUnmovedMapIsCopiedExactly) {
  FillVolume(
      source_.tsdf, [](const auto& p) { return SphereDistance(p, kCentre); }, 7.0F);
  EXPECT_TRUE(Merge(RigidTransform::Identity()));
  for (std::int32_t block = 0; block < source_.tsdf.block_count(); ++block) {
    const std::int32_t copy = target_.tsdf.Find(source_.tsdf.block_coordinates(block));
    ASSERT_NE(copy, TsdfVolume::kNoBlock);
    for (int i = 0; i < kBlockVoxels; ++i) {
      ASSERT_EQ(source_.tsdf.voxels(block)[i].observed(), target_.tsdf.voxels(copy)[i].observed());
      if (source_.tsdf.voxels(block)[i].observed()) {
        ASSERT_EQ(source_.tsdf.voxels(block)[i].bits, target_.tsdf.voxels(copy)[i].bits);
      }
    }
  }
  // Not a block more than there is something to put into.
  EXPECT_EQ(target_.tsdf.block_count(), source_.tsdf.block_count());
}

/// The distance to a sphere bends little over a voxel: at most h^2 / (4 r) between voxels.
TEST_F(MapMergerTest, AMovedMapKeepsItsShape) {
  FillVolume(
      source_.tsdf, [](const auto& p) { return SphereDistance(p, kCentre); }, 7.0F);
  const RigidTransform T_target_source = MakeTransform(
      {0.0123, -0.0051, 0.0087},
      Eigen::Quaterniond(Eigen::AngleAxisd(0.1, Eigen::Vector3d(1, 2, 3).normalized())));
  Merge(T_target_source);
  constexpr double kCurvature_m = 0.004 * 0.004 / (2.0 * 0.03);
  int compared = 0;
  for (std::int32_t block = 0; block < target_.tsdf.block_count(); ++block) {
    for (int i = 0; i < kBlockVoxels; ++i) {
      const TsdfVoxel voxel = target_.tsdf.voxels(block)[i];
      if (!voxel.observed()) continue;
      const Eigen::Vector3d p =
          target_.tsdf.grid().VoxelCentre(testing::VoxelOfBlock(target_.tsdf, block, i));
      EXPECT_NEAR(voxel.tsdf() * kTruncation_m, SphereDistance(p, T_target_source * kCentre),
                  kCurvature_m);
      ++compared;
    }
  }
  // Nearly all of the shell of 2 x 12 mm has its eight neighbours.
  const double shell_voxels = 4.0 * M_PI * 0.04 * 0.04 * 0.024 / std::pow(0.004, 3);
  EXPECT_GT(compared, 0.7 * shell_voxels);
}

TEST_F(MapMergerTest, DistancesAreAveragedByTheirWeights) {
  const auto plane = [](double z) { return [z](const Eigen::Vector3d& p) { return z - p.z(); }; };
  FillVolume(source_.tsdf, plane(0.080), 3.0F);
  FillVolume(target_.tsdf, plane(0.084), 1.0F);
  Merge(RigidTransform::Identity());
  const TsdfVoxel voxel = target_.tsdf.VoxelAt({20, 20, 20});  // Centre at z = 0.082.
  EXPECT_NEAR(voxel.tsdf() * kTruncation_m, (3.0 * -0.002 + 1.0 * 0.002) / 4.0, 1e-6);
  EXPECT_FLOAT_EQ(voxel.weight(), 4.0F);
}

TEST_F(MapMergerTest, BetterMeasuredTemperaturesWinAndAreNeverAveraged) {
  for (Volumes* volumes : {&source_, &target_})
    FillVolume(
        volumes->tsdf, [](const auto& p) { return SphereDistance(p, kCentre); }, 1.0F);
  constexpr auto kGood = ConditionClass::kGood;
  constexpr auto kAcceptable = ConditionClass::kAcceptable;
  const auto better = ThermalVoxel::Make(50.0F, kGood, kGood);
  const auto worse = ThermalVoxel::Make(70.0F, kAcceptable, kGood);
  source_.thermal.voxels(0)[1] = better;
  target_.thermal.voxels(0)[1] = worse;
  source_.thermal.voxels(0)[2] = worse;
  target_.thermal.voxels(0)[2] = better;
  source_.thermal.voxels(0)[3] = worse;
  Merge(RigidTransform::Identity());
  EXPECT_EQ(target_.thermal.voxels(0)[1].bits, better.bits);
  EXPECT_EQ(target_.thermal.voxels(0)[2].bits, better.bits);
  EXPECT_EQ(target_.thermal.voxels(0)[3].bits, worse.bits);
  EXPECT_FALSE(target_.thermal.voxels(0)[4].measured());
}

TEST_F(MapMergerTest, WhatLiesOutsideIsLeftOut) {
  FillVolume(
      source_.tsdf, [](const auto& p) { return SphereDistance(p, kCentre); }, 1.0F);
  Merge(MakeTransform({-0.09, 0.0, 0.0}, Eigen::Quaterniond::Identity()));
  EXPECT_GT(target_.tsdf.block_count(), 0);
  EXPECT_LT(target_.tsdf.block_count(), source_.tsdf.block_count());
  Merge(MakeTransform({-5.0, 0.0, 0.0}, Eigen::Quaterniond::Identity()));
}

TEST(MapMergerLimitTest, WhatExceedsTheMemoryIsCounted) {
  ThreadPool pool(1);
  Volumes source;
  Volumes target(3);
  FillVolume(
      source.tsdf, [](const auto& p) { return SphereDistance(p, kCentre); }, 1.0F);
  MergeVolume({source.tsdf, source.thermal, RigidTransform::Identity()}, kMaxWeight, pool,
              target.tsdf, target.thermal);
  EXPECT_EQ(target.tsdf.block_count(), 3);
  EXPECT_EQ(target.tsdf.refused_blocks(),
            static_cast<std::uint64_t>(source.tsdf.block_count() - 3));
}

}  // namespace
}  // namespace isotherm
