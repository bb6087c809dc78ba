#include "ground/atlas/atlas.h"

#include <gtest/gtest.h>

#include <numeric>

#include "common/simulation/options.h"
#include "ground/atlas/testing/volumes.h"

namespace isotherm {
namespace {

using testing::SmallGrid;
using testing::SphereDistance;

const Eigen::Vector3d kCentre(0.08, 0.08, 0.08);

RigidTransform Rotated(double angle_deg, const Eigen::Vector3d& translation = {0, 0, 0}) {
  return MakeTransform(translation, Eigen::Quaterniond(Eigen::AngleAxisd(
                                        angle_deg * M_PI / 180.0, Eigen::Vector3d::UnitY())));
}

class AtlasTest : public ::testing::Test {
 protected:
  AtlasTest() {
    options_.mutable_tsdf()->mutable_expert()->set_truncation_distance_m(testing::kTruncation_m);
    options_.mutable_submaps()->mutable_expert()->set_max_rotation_deg(60.0);
    options_.mutable_submaps()->mutable_expert()->set_max_travel_m(1.0);
  }
  Atlas Make() const {
    return Atlas(options_, DefaultSimulatedRig().depth->WithoutDistortion(), SmallGrid());
  }
  static void Fill(SubMap& map, const Eigen::Vector3d& centre) {
    testing::FillVolume(
        *map.tsdf, [&](const auto& p) { return SphereDistance(p, centre); }, 1.0F);
  }
  static std::vector<std::int32_t> AllBlocks(const SubMap& map) {
    std::vector<std::int32_t> blocks(static_cast<std::size_t>(map.tsdf->block_count()));
    std::iota(blocks.begin(), blocks.end(), 0);
    return blocks;
  }

  GroundOptions options_;
  ThreadPool pool_{1};
};

TEST_F(AtlasTest, ASubMapEndsFarFromAllItsAnchors) {
  Atlas atlas = Make();
  atlas.active().anchors = {Rotated(0.0)};
  EXPECT_FALSE(atlas.IsFar(0, Rotated(59.0)));
  EXPECT_TRUE(atlas.IsFar(0, Rotated(61.0)));
  EXPECT_FALSE(atlas.IsFar(0, Rotated(0.0, {0.99, 0, 0})));
  EXPECT_TRUE(atlas.IsFar(0, Rotated(0.0, {1.01, 0, 0})));
  atlas.active().anchors.push_back(Rotated(100.0));
  EXPECT_FALSE(atlas.IsFar(0, Rotated(61.0)));
}

TEST_F(AtlasTest, ZeroTurnsALimitOff) {
  options_.mutable_submaps()->mutable_expert()->set_max_rotation_deg(0.0);
  options_.mutable_submaps()->mutable_expert()->set_max_travel_m(0.0);
  Atlas atlas = Make();
  atlas.active().anchors = {Rotated(0.0)};
  EXPECT_FALSE(atlas.IsFar(0, Rotated(179.0, {100.0, 0, 0})));
}

TEST_F(AtlasTest, ASplitTakesOverWhatIsInView) {
  Atlas atlas = Make();
  Fill(atlas.active(), kCentre);
  const SubMap& before = atlas.active();
  before.thermal->voxels(1)[7] =
      ThermalVoxel::Make(40.0F, ConditionClass::kGood, ConditionClass::kGood);
  const std::vector<std::int32_t> in_view = {1, 3};
  ASSERT_TRUE(atlas.Split(Rotated(60.0), in_view));
  EXPECT_EQ(atlas.active_index(), 1);
  EXPECT_TRUE(atlas.active().joined);
  EXPECT_TRUE(atlas.IsLinked(0, 1));
  ASSERT_EQ(atlas.active().tsdf->block_count(), 2);
  for (int i = 0; i < 2; ++i) {
    EXPECT_EQ(atlas.active().tsdf->block_coordinates(i),
              before.tsdf->block_coordinates(in_view[i]));
    for (int v = 0; v < kBlockVoxels; ++v) {
      ASSERT_EQ(atlas.active().tsdf->voxels(i)[v].bits, before.tsdf->voxels(in_view[i])[v].bits);
    }
  }
  EXPECT_FLOAT_EQ(atlas.active().thermal->voxels(0)[7].celsius(), 40.0F);
}

TEST_F(AtlasTest, AllSubMapsShareOneMemoryLimit) {
  const double table_bytes = 125 * sizeof(std::int32_t);
  options_.mutable_volume()->mutable_expert()->set_max_memory_bytes(
      static_cast<std::uint64_t>(table_bytes + 30.5 * kBlockVoxels * 8));
  Atlas atlas = Make();
  Fill(atlas.active(), kCentre);
  ASSERT_EQ(atlas.active().tsdf->block_count(), 30);
  ASSERT_GT(atlas.active().tsdf->refused_blocks(), 0U);
  EXPECT_FALSE(atlas.Split(Rotated(60.0), AllBlocks(atlas.active())));
  EXPECT_EQ(atlas.size(), 1);
}

TEST_F(AtlasTest, NoMoreSubMapsThanTheOptionAllows) {
  options_.mutable_submaps()->mutable_expert()->set_max_maps(2);
  Atlas atlas = Make();
  EXPECT_TRUE(atlas.BeginElsewhere());
  EXPECT_FALSE(atlas.BeginElsewhere());
  EXPECT_FALSE(atlas.Split(Rotated(60.0), {}));
  EXPECT_EQ(atlas.active_index(), 1);
}

TEST_F(AtlasTest, AClosureIsMeasuredAndSpread) {
  Atlas atlas = Make();
  for (int i = 1; i <= 3; ++i) ASSERT_TRUE(atlas.Split(Rotated(60.0 * i), {}));
  const RigidTransform drifted = Rotated(180.0, {0.012, 0.0, 0.0});
  atlas.Link(0, drifted, Rotated(180.0));
  EXPECT_EQ(atlas.drift().closures, 1U);
  EXPECT_NEAR(atlas.drift().last_gap_m, 0.012, 1e-9);
  // The last sub-map has followed nearly all of the gap, the others by parts.
  EXPECT_NEAR(atlas.active().T_world_map.translation().x(), -0.012, 0.0006);
  EXPECT_LT(atlas.map(1).T_world_map.translation().norm(), 0.006);
  EXPECT_LT(TranslationDistance(atlas.map(0).T_world_map, RigidTransform::Identity()), 1e-15);
}

TEST_F(AtlasTest, WhatWasBegunElsewhereIsJoinedByOneLinkAndMerged) {
  Atlas atlas = Make();
  Fill(atlas.active(), kCentre);
  const RigidTransform T_world_map = Rotated(0.0, {0.02, 0.0, 0.0});
  ASSERT_TRUE(atlas.BeginElsewhere());
  EXPECT_FALSE(atlas.active().joined);
  EXPECT_FALSE(atlas.PoseIn(0, Rotated(0.0)).has_value());
  Fill(atlas.active(), T_world_map.inverse() * kCentre);
  const RigidTransform T_map_depth = Rotated(10.0, {0.1, 0.2, -0.3});
  EXPECT_EQ(atlas.ToVerify(T_map_depth), std::vector<int>{0});
  atlas.Link(0, T_map_depth, T_world_map * T_map_depth);
  EXPECT_TRUE(atlas.active().joined);
  EXPECT_EQ(atlas.drift().closures, 0U);  // There was nothing to miss.
  EXPECT_LT(TranslationDistance(atlas.active().T_world_map, T_world_map), 1e-6);
  EXPECT_TRUE(atlas.Merge(255.0, pool_, {}));
  EXPECT_EQ(atlas.size(), 1);
  // Both saw the same sphere, so it weighs twice as much now.
  const GridIndex on_surface(20, 20, 10);
  EXPECT_FLOAT_EQ(atlas.active().tsdf->VoxelAt(on_surface).weight(), 2.0F);
}

TEST_F(AtlasTest, WhatWasNeverJoinedStaysApart) {
  Atlas atlas = Make();
  Fill(atlas.active(), kCentre);
  const std::int32_t blocks = atlas.active().tsdf->block_count();
  ASSERT_TRUE(atlas.BeginElsewhere());
  Fill(atlas.active(), kCentre);
  EXPECT_TRUE(atlas.Merge(255.0, pool_, {}));
  EXPECT_EQ(atlas.size(), 2);
  EXPECT_EQ(atlas.active_index(), 0);
  EXPECT_EQ(atlas.active().tsdf->block_count(), blocks);
  EXPECT_FLOAT_EQ(atlas.active().tsdf->VoxelAt({20, 20, 10}).weight(), 1.0F);
}

}  // namespace
}  // namespace isotherm
