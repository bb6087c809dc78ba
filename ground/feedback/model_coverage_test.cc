#include "ground/feedback/model_coverage.h"

#include <gtest/gtest.h>

#include <numbers>

#include "common/testing/volume_shapes.h"

namespace isotherm {
namespace {

using enum ConditionClass;

/// A surface's area is counted on the voxel grid: right to a few percent for any orientation.
constexpr double kAreaTolerance = 0.04;

const auto kNothingSpilled = [](std::int32_t) { return false; };

class ModelCoverageTest : public ::testing::Test {
 protected:
  static constexpr float kMinWeight = 1.0F;
  static constexpr double kRadius_m = 0.12;
  static constexpr double kSphere_m2 = 4.0 * std::numbers::pi * kRadius_m * kRadius_m;
  const Eigen::Vector3d centre_{0.20, 0.205, 0.21};

  static VoxelGrid Grid() {
    return {.min_m = Eigen::Vector3d::Zero(), .voxel_size_m = 0.005, .blocks = {10, 10, 10}};
  }
  /// Good above the sphere's centre, acceptable below it in front, never measured below behind.
  ThermalVoxel VoxelAt(const Eigen::Vector3d& p) const {
    if (p.z() < centre_.z()) return ThermalVoxel::Make(20.0F, kGood, kGood);
    if (p.x() < centre_.x()) return ThermalVoxel::Make(20.0F, kAcceptable, kGood);
    return {};
  }
  void UpdateAll() {
    coverage_.Update(tsdf_, thermal_, kNothingSpilled, tsdf_.block_count() + 1, pool_);
  }

  ThreadPool pool_{2};
  TsdfVolume tsdf_{Grid(), 0.02, 2000};
  ThermalVolume thermal_{2000};
  ModelCoverage coverage_{kMinWeight};
};

TEST_F(ModelCoverageTest, AreasAreThoseOfTheSphere) {
  testing::FillSphere(tsdf_, centre_, kRadius_m);
  testing::FillThermal(tsdf_, thermal_, [&](const auto& p) { return VoxelAt(p); });
  UpdateAll();
  const SurfaceAreas& areas = coverage_.areas();
  EXPECT_NEAR(areas.total_m2(), kSphere_m2, kAreaTolerance * kSphere_m2);
  EXPECT_NEAR(areas.good_m2, kSphere_m2 / 2, kAreaTolerance * kSphere_m2);
  EXPECT_NEAR(areas.acceptable_m2, kSphere_m2 / 4, kAreaTolerance * kSphere_m2);
  EXPECT_NEAR(areas.never_m2, kSphere_m2 / 4, kAreaTolerance * kSphere_m2);
  EXPECT_EQ(areas.bad_m2, 0.0);
  EXPECT_EQ(coverage_.turns(), 1U);
}

TEST_F(ModelCoverageTest, APlaneBetweenTwoLayersOfBlocksIsNotMissed) {
  // Halfway between the last voxel of one block and the first of the next.
  testing::FillPlane(tsdf_, {0, 0, 0.16}, {0, 0, -1});
  UpdateAll();
  constexpr double kSide = 0.4;
  EXPECT_NEAR(coverage_.areas().total_m2(), kSide * kSide, kAreaTolerance * kSide * kSide);
}

TEST_F(ModelCoverageTest, TheEdgeOfWhatWasSeenIsNoSurface) {
  testing::FillPlane(tsdf_, {0, 0, 0.16}, {0, 0, -1});
  UpdateAll();
  const double plane_m2 = coverage_.areas().total_m2();
  // Free space that ends at what lies unseen behind a silhouette: full distances side by side.
  const std::int32_t block = tsdf_.FindOrAllocate({2, 2, 8});
  for (int i = 0; i < kBlockVoxels; ++i) {
    tsdf_.voxels(block)[static_cast<std::size_t>(i)].Update(i % kBlockSide < 4 ? 1.0F : -1.0F,
                                                            10.0F, 10.0F);
  }
  UpdateAll();
  EXPECT_EQ(coverage_.areas().total_m2(), plane_m2);
}

TEST_F(ModelCoverageTest, APartAtATimeComesToTheSame) {
  testing::FillSphere(tsdf_, centre_, kRadius_m);
  testing::FillThermal(tsdf_, thermal_, [&](const auto& p) { return VoxelAt(p); });
  ModelCoverage whole(kMinWeight);
  whole.Update(tsdf_, thermal_, kNothingSpilled, tsdf_.block_count() + 1, pool_);
  int steps = 0;
  for (; coverage_.turns() == 0; ++steps) {
    coverage_.Update(tsdf_, thermal_, kNothingSpilled, 10, pool_);
  }
  EXPECT_GE(steps, tsdf_.block_count() / 160);
  EXPECT_LE(steps, (tsdf_.block_count() + 9) / 10);
  EXPECT_NEAR(coverage_.areas().total_m2(), whole.areas().total_m2(), 1e-12);
  EXPECT_NEAR(coverage_.areas().good_m2, whole.areas().good_m2, 1e-12);
}

TEST_F(ModelCoverageTest, WhatIsMeasuredLaterReplacesWhatWasCounted) {
  testing::FillSphere(tsdf_, centre_, kRadius_m);
  UpdateAll();
  EXPECT_NEAR(coverage_.areas().never_m2, kSphere_m2, kAreaTolerance * kSphere_m2);
  testing::FillThermal(tsdf_, thermal_,
                       [](const auto&) { return ThermalVoxel::Make(20.0F, kGood, kGood); });
  UpdateAll();
  EXPECT_NEAR(coverage_.areas().never_m2, 0.0, 1e-12);
  EXPECT_NEAR(coverage_.areas().good_m2, kSphere_m2, kAreaTolerance * kSphere_m2);
  EXPECT_TRUE(coverage_.Lacking(10).empty());
}

TEST_F(ModelCoverageTest, SpilledBlocksAreNotTouchedAndKeepWhatTheyHad) {
  testing::FillSphere(tsdf_, centre_, kRadius_m);
  UpdateAll();
  testing::FillThermal(tsdf_, thermal_,
                       [](const auto&) { return ThermalVoxel::Make(20.0F, kGood, kGood); });
  coverage_.Update(
      tsdf_, thermal_, [](std::int32_t) { return true; }, tsdf_.block_count(), pool_);
  EXPECT_NEAR(coverage_.areas().never_m2, kSphere_m2, kAreaTolerance * kSphere_m2);
}

TEST_F(ModelCoverageTest, WhatIsLackingIsFoundWithTheSideItFaces) {
  testing::FillSphere(tsdf_, centre_, kRadius_m);
  // A cap around +x is missing.
  testing::FillThermal(tsdf_, thermal_, [&](const Eigen::Vector3d& p) {
    return (p - centre_).normalized().x() > 0.9 ? ThermalVoxel()
                                                : ThermalVoxel::Make(20.0F, kGood, kGood);
  });
  UpdateAll();
  const std::vector<LackingSurface> lacking = coverage_.Lacking(20);
  ASSERT_FALSE(lacking.empty());
  double area_m2 = 0.0;
  for (const LackingSurface& surface : lacking) {
    EXPECT_GT(surface.normal_map.x(), 0.85);
    EXPECT_GT((surface.position_map - centre_).normalized().x(), 0.85);
    area_m2 += surface.area_m2;
  }
  constexpr double kCap_m2 = 2.0 * std::numbers::pi * kRadius_m * kRadius_m * 0.1;
  EXPECT_NEAR(area_m2, kCap_m2, 0.15 * kCap_m2);
  for (std::size_t i = 1; i < lacking.size(); ++i) {
    EXPECT_GE(lacking[i - 1].area_m2, lacking[i].area_m2);
  }
}

}  // namespace
}  // namespace isotherm
