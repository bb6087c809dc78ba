#include "ground/feedback/scan_coverage.h"

#include <gtest/gtest.h>

#include <numbers>

#include "common/simulation/options.h"
#include "common/testing/volume_shapes.h"

namespace isotherm {
namespace {

using enum ConditionClass;

constexpr double kRadius_m = 0.1;
constexpr double kSphere_m2 = 4.0 * std::numbers::pi * kRadius_m * kRadius_m;
/// A surface's area is counted on the voxel grid: right to a few percent for any orientation.
constexpr double kAreaTolerance_m2 = 0.04 * kSphere_m2;

const ThermalVoxel kMeasuredWell = ThermalVoxel::Make(20.0F, kGood, kGood);

bool NothingSpilled(const TsdfVolume&, std::int32_t) { return false; }

/// Two sub-maps, each with a surface of its own; the second is active.
class ScanCoverageTest : public ::testing::Test {
 protected:
  ScanCoverageTest() {
    options_.mutable_tsdf()->mutable_expert()->set_truncation_distance_m(0.016);
    atlas_ = std::make_unique<Atlas>(options_, DefaultSimulatedRig().depth->WithoutDistortion(),
                                     VoxelGrid{Eigen::Vector3d::Zero(), 0.004, {10, 10, 10}});
  }
  /// The blocks of the second do not coincide with those of the first, nor do their axes.
  void BeginSecond(bool is_joined) {
    ASSERT_TRUE(atlas_->BeginElsewhere());
    const Eigen::Quaterniond turn(
        Eigen::AngleAxisd(0.6, Eigen::Vector3d(0.3, -0.5, 0.8).normalized()));
    // About the volume's centre, so that both hold the surface.
    atlas_->map(1).T_world_map =
        MakeTransform(centre_ + Eigen::Vector3d(0.003, 0.001, -0.002) - turn * centre_, turn);
    atlas_->map(1).joined = is_joined;
  }
  template <typename VoxelAt>
  void FillSphere(int map, const VoxelAt& voxel_at) {
    const RigidTransform T_world_map = atlas_->map(map).T_world_map;
    testing::FillSphere(*atlas_->map(map).tsdf, T_world_map.inverse() * centre_, kRadius_m);
    Measure(map, [&](const Eigen::Vector3d& p_map) { return voxel_at(T_world_map * p_map); });
  }
  template <typename VoxelAt>
  void Measure(int map, const VoxelAt& voxel_at) {
    SubMap& sub_map = atlas_->map(map);
    ASSERT_TRUE(sub_map.thermal->Commit(sub_map.tsdf->block_count()));
    testing::FillThermal(*sub_map.tsdf, *sub_map.thermal, voxel_at);
  }
  /// Long enough that each sub-map had its turn with what the others know by then.
  void UpdateAll() {
    for (int i = 0; i < 6; ++i) coverage_.Update(*atlas_, NothingSpilled, 100'000, pool_);
  }

  const Eigen::Vector3d centre_{0.16, 0.161, 0.159};
  GroundOptions options_;
  ThreadPool pool_{2};
  std::unique_ptr<Atlas> atlas_;
  ScanCoverage coverage_{1.0F};
};

TEST_F(ScanCoverageTest, SurfaceOfTwoSubMapsCountsOnceAsWellMeasuredAsInEither) {
  FillSphere(0, [&](const Eigen::Vector3d& p) {
    return p.z() < centre_.z() ? kMeasuredWell : ThermalVoxel();
  });
  UpdateAll();
  BeginSecond(true);
  FillSphere(1, [&](const Eigen::Vector3d& p) {
    return p.x() < centre_.x() ? kMeasuredWell : ThermalVoxel();
  });
  UpdateAll();
  const SurfaceAreas areas = coverage_.areas();
  EXPECT_TRUE(coverage_.complete());
  EXPECT_NEAR(areas.total_m2(), kSphere_m2, kAreaTolerance_m2);
  EXPECT_NEAR(areas.good_m2, 0.75 * kSphere_m2, kAreaTolerance_m2);
  EXPECT_NEAR(areas.never_m2, 0.25 * kSphere_m2, kAreaTolerance_m2);
  // The active one knows what is left to measure, wherever the rest was measured.
  double lacking_m2 = 0.0;
  coverage_.Find(1)->ForEachPiece([&](std::uint64_t, double area_m2) { lacking_m2 += area_m2; });
  EXPECT_NEAR(lacking_m2, areas.never_m2, 1e-9);
  // The rig goes back to the first.
  atlas_->Activate(0);
  coverage_.Update(*atlas_, NothingSpilled, 10, pool_);
  EXPECT_FALSE(coverage_.complete()) << "some blocks may count in both, or in neither";
  UpdateAll();
  EXPECT_TRUE(coverage_.complete());
  EXPECT_NEAR(coverage_.areas().total_m2(), kSphere_m2, kAreaTolerance_m2);
  EXPECT_NEAR(coverage_.areas().good_m2, 0.75 * kSphere_m2, kAreaTolerance_m2);
  EXPECT_NEAR(coverage_.Find(1)->areas().total_m2(), 0.0, 1e-9);
}

TEST_F(ScanCoverageTest, WhatIsNotJoinedIsOtherSurfaceAndCountsWhileTheRigIsThere) {
  FillSphere(0, [](const auto&) { return kMeasuredWell; });
  UpdateAll();
  BeginSecond(false);
  FillSphere(1, [](const auto&) { return ThermalVoxel(); });
  UpdateAll();
  EXPECT_NEAR(coverage_.areas().total_m2(), 2.0 * kSphere_m2, 2.0 * kAreaTolerance_m2);
  EXPECT_NEAR(coverage_.areas().good_m2, kSphere_m2, kAreaTolerance_m2);
  atlas_->Activate(0);
  UpdateAll();
  EXPECT_NEAR(coverage_.areas().total_m2(), kSphere_m2, kAreaTolerance_m2);
}

/// As when a scan is rebuilt from its recording: nobody looked while the rig was there.
TEST_F(ScanCoverageTest, SurfaceThatWasNeverActiveWhenItWasAskedForCounts) {
  FillSphere(0, [](const auto&) { return ThermalVoxel(); });
  BeginSecond(true);
  UpdateAll();
  EXPECT_TRUE(coverage_.complete());
  EXPECT_NEAR(coverage_.areas().never_m2, kSphere_m2, kAreaTolerance_m2);
}

TEST_F(ScanCoverageTest, WhatWasMeasuredJustBeforeTheRigLeftCounts) {
  FillSphere(0, [](const auto&) { return ThermalVoxel(); });
  UpdateAll();
  Measure(0, [](const auto&) { return kMeasuredWell; });
  BeginSecond(true);
  UpdateAll();
  EXPECT_NEAR(coverage_.areas().good_m2, kSphere_m2, kAreaTolerance_m2);
}

TEST_F(ScanCoverageTest, TheOtherSideOfASheetIsAnotherSurface) {
  const auto sheet = [&](int map, double z_m, double facing) {
    const RigidTransform T_map_world = atlas_->map(map).T_world_map.inverse();
    testing::FillPlane(*atlas_->map(map).tsdf, T_map_world * Eigen::Vector3d(0.16, 0.16, z_m),
                       T_map_world.linear() * Eigen::Vector3d(0.0, 0.0, facing));
    Measure(map, [&](const auto&) { return map == 0 ? kMeasuredWell : ThermalVoxel(); });
  };
  sheet(0, 0.160, -1.0);
  UpdateAll();
  BeginSecond(true);
  sheet(1, 0.164, 1.0);
  UpdateAll();
  ModelCoverage alone(1.0F);
  alone.Update(
      *atlas_->map(1).tsdf, *atlas_->map(1).thermal, [](std::int32_t) { return false; }, 100'000,
      pool_);
  const double back_m2 = alone.areas().total_m2();
  ASSERT_GT(back_m2, 0.08);
  EXPECT_NEAR(coverage_.areas().never_m2, back_m2, 1e-9);
  EXPECT_NEAR(coverage_.areas().good_m2, 0.32 * 0.32, 0.04 * 0.32 * 0.32);
}

}  // namespace
}  // namespace isotherm
