#include "ground/pipeline/thermal_stage.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <memory>
#include <utility>

#include "common/testing/volume_shapes.h"
#include "ground/surface/testing/analytic_views.h"
#include "ground/surface/testing/small_volume.h"
#include "ground/tsdf/raycaster.h"

namespace isotherm {
namespace {

using namespace std::chrono_literals;
using LeftOut = EnumArray<LeftOutReason, std::uint64_t>;

/// A stage between thermal frames and depth frames whose pose is given.
class ThermalStageTest : public ::testing::Test {
 protected:
  ThermalStageTest() {
    rig_.depth = testing::SmallDepthCamera();
    rig_.thermal = rig_.depth;
    rig_.T_thermal_depth = MakeTransform({0.02, 0.0, 0.0}, Eigen::Quaterniond::Identity());
    const VolumeOptions volume = testing::SmallVolume();
    const VoxelGrid grid = MakeVoxelGrid(volume).value();
    const std::int32_t max_blocks = MaxBlocks(volume, grid);
    tsdf_ = std::make_unique<TsdfVolume>(grid, testing::kSmallTruncation_m, max_blocks);
    testing::FillVolume(*tsdf_, testing::BallInCorner);
    thermal_ = std::make_unique<ThermalVolume>(max_blocks);
    EXPECT_TRUE(thermal_->Commit(tsdf_->block_count()));
    view_.camera = rig_.depth->Downscaled(1);
    view_.T_map_depth = testing::FirstPose();
    Raycaster().Cast(*tsdf_, view_.camera, view_.T_map_depth, 0.0F, pool_, view_.maps);
    depth_m_ = Image<float>(rig_.depth->width, rig_.depth->height, 0.5F);
    stage_ = std::make_unique<ThermalStage>(options_, rig_, 0.0F, counts_);
  }

  static CaptureTime Time(double frame) { return CaptureTime(FromSeconds(100.0 + frame / 30.0)); }

  std::shared_ptr<ThermalFrame> Frame(double at) const {
    auto frame = std::make_shared<ThermalFrame>();
    frame->header.capture_time = Time(at);
    frame->temperature_raw =
        Image<std::uint16_t>(rig_.thermal->width, rig_.thermal->height, 32'315);  // 50 °C.
    frame->valid = true;
    return frame;
  }
  /// A depth frame at `at` whose predecessor was at `before`; the rig is at rest.
  TrackedDepth Depth(double before, double at) const {
    return {.depth_m = depth_m_,
            .view = view_,
            .earlier = std::nullopt,
            .before = StampedMapPose{Time(before), view_.T_map_depth},
            .now = {Time(at), view_.T_map_depth},
            .mean_depth_m = 0.5,
            .tsdf = *tsdf_};
  }
  /// How many voxels have motion class `motion`.
  int Count(ConditionClass motion) const {
    int count = 0;
    for (std::int32_t block = 0; block < tsdf_->block_count(); ++block) {
      for (const ThermalVoxel& voxel : std::as_const(*thermal_).voxels(block))
        count += voxel.measured() && voxel.motion_class() == motion ? 1 : 0;
    }
    return count;
  }
  void Fuse(const TrackedDepth& depth) { stage_->FuseUpTo(depth, *thermal_, pool_); }
  int Measured() const {
    int measured = 0;
    for (std::int32_t block = 0; block < tsdf_->block_count(); ++block) {
      for (const ThermalVoxel& voxel : std::as_const(*thermal_).voxels(block))
        measured += voxel.measured() ? 1 : 0;
    }
    return measured;
  }

  Rig rig_;
  ThermalOptions options_;
  ThreadPool pool_{2};
  std::unique_ptr<TsdfVolume> tsdf_;
  std::unique_ptr<ThermalVolume> thermal_;
  ModelView view_;
  Image<float> depth_m_;
  ScanCounts counts_;
  std::unique_ptr<ThermalStage> stage_;
};

TEST_F(ThermalStageTest, AFrameBetweenTwoTrackedDepthFramesIsFused) {
  EXPECT_TRUE(stage_->Add(Frame(0.5)));
  EXPECT_EQ(counts_.thermal_fused, 0U) << "where the rig was is not known yet";
  Fuse(Depth(0.0, 1.0));
  EXPECT_EQ(counts_.thermal_fused, 1U);
  EXPECT_EQ(counts_.thermal_left_out, LeftOut());
  EXPECT_GT(Measured(), 1000);
}

TEST_F(ThermalStageTest, AFrameBehindTheDepthFrameWaitsForTheNext) {
  stage_->Add(Frame(1.5));
  Fuse(Depth(0.0, 1.0));
  EXPECT_EQ(counts_.thermal_fused, 0U);
  Fuse(Depth(1.0, 2.0));
  EXPECT_EQ(counts_.thermal_fused, 1U);
}

TEST_F(ThermalStageTest, F07WhileTheShutterIsClosedItIsNuc) {
  auto frame = Frame(0.5);
  frame->valid = false;
  EXPECT_FALSE(stage_->Add(frame));
  EXPECT_EQ(counts_.thermal_left_out, (LeftOut{{LeftOutReason::kNuc, 1}}));
}

TEST_F(ThermalStageTest, OfAnotherSizeThanTheCalibrations) {
  auto frame = Frame(0.5);
  frame->temperature_raw =
      Image<std::uint16_t>(rig_.thermal->width, rig_.thermal->height - 1, 32'315);
  EXPECT_FALSE(stage_->Add(frame));
  EXPECT_EQ(counts_.thermal_left_out, (LeftOut{{LeftOutReason::kWrongSize, 1}}));
}

TEST_F(ThermalStageTest, F10DatedTooUncertainly) {
  auto frame = Frame(0.5);
  frame->header.capture_sigma = FromSeconds(options_.expert().max_time_sigma_s()) + 1us;
  EXPECT_FALSE(stage_->Add(frame));
  EXPECT_EQ(counts_.thermal_left_out, (LeftOut{{LeftOutReason::kTimeUncertain, 1}}));
  frame = Frame(0.5);
  frame->header.capture_sigma = FromSeconds(options_.expert().max_time_sigma_s()) - 1us;
  EXPECT_TRUE(stage_->Add(frame));
}

TEST_F(ThermalStageTest, F01WithoutDepthTheOldestGo) {
  constexpr int kWaiting = 64;
  for (int i = 0; i < kWaiting + 3; ++i) EXPECT_TRUE(stage_->Add(Frame(0.1 * i)));
  EXPECT_EQ(counts_.thermal_left_out, (LeftOut{{LeftOutReason::kDepthStopped, 3}}));
}

TEST_F(ThermalStageTest, WithoutAPoseBeforeIt) {
  stage_->Add(Frame(0.5));
  TrackedDepth depth = Depth(0.0, 1.0);
  depth.before.reset();
  Fuse(depth);
  EXPECT_EQ(counts_.thermal_left_out, (LeftOut{{LeftOutReason::kPoseUnknown, 1}}));
  EXPECT_EQ(Measured(), 0);
}

TEST_F(ThermalStageTest, FromBeforeTheRigWasFoundAgain) {
  stage_->Add(Frame(0.5));
  Fuse(Depth(0.6, 1.0));
  EXPECT_EQ(counts_.thermal_left_out, (LeftOut{{LeftOutReason::kPoseUnknown, 1}}));
}

TEST_F(ThermalStageTest, WhereThePoseMovesTheImageTooFar) {
  const double limit_rad = options_.expert().max_registration_px() / rig_.thermal->fx;
  stage_->Add(Frame(0.5));
  TrackedDepth depth = Depth(0.0, 1.0);
  depth.surface_sigma_rad = 1.01 * limit_rad;
  Fuse(depth);
  EXPECT_EQ(counts_.thermal_left_out, (LeftOut{{LeftOutReason::kPoseUncertain, 1}}));
  stage_->Add(Frame(1.5));
  TrackedDepth better = Depth(1.0, 2.0);
  better.surface_sigma_rad = 0.99 * limit_rad;
  Fuse(better);
  EXPECT_EQ(counts_.thermal_fused, 1U);
}

TEST_F(ThermalStageTest, WhereDepthFramesAreTooFarApart) {
  const double frames = 30.0 * options_.expert().max_depth_gap_s();
  stage_->Add(Frame(0.5));
  Fuse(Depth(0.0, frames + 0.1));
  EXPECT_EQ(counts_.thermal_left_out, (LeftOut{{LeftOutReason::kDepthGap, 1}}));
  stage_->Add(Frame(100.5));
  Fuse(Depth(100.0, 100.0 + frames - 0.1));
  EXPECT_EQ(counts_.thermal_fused, 1U);
}

/// The rig turns at 0.6 rad/s; in a gap of three frames it turns back, so that its mean motion is
/// none.
TEST_F(ThermalStageTest, AReversalInAGapIsNotRest) {
  const RigidTransform turned =
      view_.T_map_depth *
      MakeTransform(Eigen::Vector3d::Zero(),
                    Eigen::Quaterniond(Eigen::AngleAxisd(-0.02, Eigen::Vector3d::UnitY())));
  TrackedDepth depth = Depth(1.0, 3.8);
  stage_->Add(Frame(1.2));
  Fuse(depth);
  const int at_rest = Count(ConditionClass::kGood);
  EXPECT_GT(at_rest, 1000) << "nothing is known of a motion";
  EXPECT_EQ(Count(ConditionClass::kAcceptable), 0);
  // Forgotten, so that the better class of before does not stay.
  thermal_ = std::make_unique<ThermalVolume>(tsdf_->max_blocks());
  ASSERT_TRUE(thermal_->Commit(tsdf_->block_count()));
  depth.earlier = StampedMapPose{Time(0.0), turned};
  stage_->Add(Frame(1.2));
  Fuse(depth);
  EXPECT_EQ(Count(ConditionClass::kGood), 0);
  EXPECT_GT(Count(ConditionClass::kAcceptable), 1000);
}

TEST_F(ThermalStageTest, WhatComesToMoveInAGapIsFastAtItsEnd) {
  // At rest, then 0.011 rad in 2.8 frames: 0.12 rad/s on the mean, 1.7 times that at the end.
  TrackedDepth depth = Depth(1.0, 3.8);
  depth.earlier = StampedMapPose{Time(0.0), view_.T_map_depth};
  depth.before->T_map_depth =
      view_.T_map_depth *
      MakeTransform(Eigen::Vector3d::Zero(),
                    Eigen::Quaterniond(Eigen::AngleAxisd(-0.011, Eigen::Vector3d::UnitY())));
  depth.earlier->T_map_depth = depth.before->T_map_depth;
  stage_->Add(Frame(3.6));
  Fuse(depth);
  EXPECT_EQ(Count(ConditionClass::kGood), 0);
  EXPECT_GT(Count(ConditionClass::kAcceptable), 1000);
}

/// In the middle of a gap the rig may be off by a T^2 / 8, near its ends by little.
TEST_F(ThermalStageTest, UncertaintyGrowsWithTheGapAndTowardsItsMiddle) {
  const auto left_out = [this](double at, double frames) {
    const std::uint64_t before = counts_.thermal_left_out[LeftOutReason::kPoseUncertain];
    stage_->Add(Frame(at));
    Fuse(Depth(0.0, frames));
    return counts_.thermal_left_out[LeftOutReason::kPoseUncertain] > before;
  };
  // Half of hypot(2 / 0.5 m, 3) T^2 / 8 is a pixel of the thermal camera at T = 0.106 s.
  const double pixel_s = std::sqrt(8.0 / (0.5 * 5.0 * rig_.thermal->fx));
  options_.mutable_expert()->set_max_depth_gap_s(1.0);
  stage_ = std::make_unique<ThermalStage>(options_, rig_, 0.0F, counts_);
  const double frames = 30.0 * pixel_s;
  EXPECT_FALSE(left_out(0.49 * frames, 0.98 * frames));
  EXPECT_TRUE(left_out(0.51 * frames, 1.02 * frames));
  EXPECT_FALSE(left_out(0.25 * frames, 1.02 * frames));
  // t (T - t) = pixel_s^2 / 4 at t = 0.146 pixel_s for twice as long a gap.
  EXPECT_FALSE(left_out(0.13 * frames, 2.0 * frames));
  EXPECT_TRUE(left_out(0.16 * frames, 2.0 * frames));
  EXPECT_FALSE(left_out(1.87 * frames, 2.0 * frames));
}

TEST_F(ThermalStageTest, ByDefaultAStreamOfTenHertzIsBridgedJitterIncluded) {
  EXPECT_EQ(options_.expert().max_depth_gap_s(), 0.12);
  stage_->Add(Frame(0.1));
  Fuse(Depth(0.0, 12.0));
  EXPECT_EQ(counts_.thermal_left_out, (LeftOut{{LeftOutReason::kDepthGap, 1}}));
}

TEST_F(ThermalStageTest, ForThePipelinesReasonBeforeAnyOther) {
  stage_->Add(Frame(0.5));
  TrackedDepth depth = Depth(0.0, 1.0);
  depth.before.reset();
  depth.refusal = LeftOutReason::kDiskFull;
  Fuse(depth);
  EXPECT_EQ(counts_.thermal_left_out, (LeftOut{{LeftOutReason::kDiskFull, 1}}));
}

TEST_F(ThermalStageTest, WhatStillWaitsAtTheEndHasNoDepthBehindIt) {
  for (int i = 0; i < 3; ++i) stage_->Add(Frame(i));
  stage_->Finish(*tsdf_, *thermal_, pool_);
  EXPECT_EQ(counts_.thermal_left_out, (LeftOut{{LeftOutReason::kNoDepthAfter, 3}}));
  stage_->Finish(*tsdf_, *thermal_, pool_);
  EXPECT_EQ(counts_.thermal_left_out, (LeftOut{{LeftOutReason::kNoDepthAfter, 3}}))
      << "counted once";
}

}  // namespace
}  // namespace isotherm
