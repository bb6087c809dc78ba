// What the pipeline does when cameras fail, frames are spoilt, or it is set up with what cannot be.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <utility>
#include <vector>

#include "ground/mesh/surface.h"
#include "ground/pipeline/ground_pipeline.h"
#include "ground/pipeline/testing/pipeline_fixture.h"

namespace isotherm {
namespace {

constexpr unsigned kSeed = 12;

using PipelineFailuresTest = testing::PipelineFixture;

TEST_F(PipelineFailuresTest, F13ACoveredCameraLeavesTheModelAloneAndTrackingComesBack) {
  for (int i = 0; i < 4; ++i) Depth(i);
  const std::uint64_t integrated = pipeline_->model().counts.depth_integrated;
  for (int i = 4; i < 7; ++i) EXPECT_FALSE(Covered(i).tracked);
  EXPECT_EQ(pipeline_->model().counts.depth_integrated, integrated);
  EXPECT_EQ(pipeline_->model().counts.depth_lost[LostReason::kTooFewPixels], 3U);
  // Found again, but believed and fused only when two more frames agree.
  EXPECT_TRUE(Depth(4).unconfirmed);
  EXPECT_TRUE(Depth(5).unconfirmed);
  EXPECT_EQ(pipeline_->model().trajectory.poses().size(), 4U);
  EXPECT_EQ(pipeline_->model().counts.depth_integrated, integrated);
  EXPECT_TRUE(Depth(6).tracked);
  EXPECT_EQ(pipeline_->model().trajectory.poses().size(), 7U);
}

TEST_F(PipelineFailuresTest, F10FramesOfAnUncertainTimeAreNotFused) {
  Depth(0);
  Thermal(0.3, true, std::chrono::milliseconds(2));
  Thermal(0.6, true, std::chrono::milliseconds(25));  // As the edge marks what is unsynchronised.
  Depth(1);
  EXPECT_EQ(pipeline_->model().counts.thermal_fused, 1U);
  EXPECT_EQ(LeftOut(LeftOutReason::kTimeUncertain), 1U);
}

TEST_F(PipelineFailuresTest, F56WithoutExtrinsicsGeometryGoesOnAndThermalIsRefused) {
  rig_.T_thermal_depth.reset();
  Start();
  EXPECT_EQ(pipeline_->model().thermal_status.code(), StatusCode::kFailedPrecondition);
  Depth(0);
  Thermal(0.5);
  EXPECT_TRUE(Depth(1).tracked);
  EXPECT_EQ(LeftOut(LeftOutReason::kNoCalibration), 1U);
}

TEST_F(PipelineFailuresTest, F11AFrameOfAnotherSizeIsRefusedAndCounted) {
  Depth(0);
  DepthFrame frame;
  frame.depth_raw = Image<std::uint16_t>(17, 3, 500);
  ::testing::internal::CaptureStderr();
  for (int i = 0; i < 100; ++i) EXPECT_FALSE(pipeline_->ProcessDepth(frame).tracked);
  EXPECT_EQ(pipeline_->model().counts.depth_refused, 100U);
  EXPECT_TRUE(Depth(1).tracked);
  const std::string log = ::testing::internal::GetCapturedStderr();
  EXPECT_EQ(std::ranges::count(log, '\n'), 2) << log;  // When it began, and when it was over.
  EXPECT_NE(log.find("refused=100"), std::string::npos) << log;
}

TEST_F(PipelineFailuresTest, OptionsOutOfRangeAreNamed) {
  options_.mutable_tsdf()->mutable_expert()->set_truncation_distance_m(0.001);
  const auto created = GroundPipeline::Create(options_, rig_, std::nullopt);
  ASSERT_FALSE(created.has_value());
  EXPECT_NE(created.error().message().find("tsdf.expert.truncation_distance_m"), std::string::npos);
  rig_.depth.reset();
  options_.clear_tsdf();
  EXPECT_FALSE(GroundPipeline::Create(options_, rig_, std::nullopt).has_value());
}

TEST_F(PipelineFailuresTest, F12EmptyFramesAreLostAndLeaveNothing) {
  DepthFrame empty;
  empty.depth_raw = Image<std::uint16_t>(rig_.depth->width, rig_.depth->height, kNoDepth);
  for (int i = 0; i < 3; ++i) {
    empty.header.capture_time = Time(i);
    EXPECT_FALSE(pipeline_->ProcessDepth(empty).tracked);
  }
  Thermal(0.5);
  EXPECT_EQ(pipeline_->model().tsdf().block_count(), 0);
  EXPECT_TRUE(pipeline_->model().trajectory.poses().empty());
  EXPECT_EQ(pipeline_->model().counts.depth_lost[LostReason::kTooFewPixels], 3U);
  EXPECT_TRUE(Depth(3).tracked) << "the scan begins with the first frame that shows something";
  EXPECT_EQ(LeftOut(LeftOutReason::kPoseUnknown), 1U);
}

TEST_F(PipelineFailuresTest, F11FramesWithoutPixelsAreRefusedAndCounted) {
  DepthFrame none;
  EXPECT_FALSE(pipeline_->ProcessDepth(none).tracked);
  EXPECT_EQ(pipeline_->model().counts.depth_refused, 1U);
  auto thermal = std::make_shared<ThermalFrame>();
  thermal->valid = true;
  pipeline_->ProcessThermal(thermal);
  EXPECT_EQ(LeftOut(LeftOutReason::kWrongSize), 1U);
  EXPECT_TRUE(Depth(0).tracked);
}

TEST_F(PipelineFailuresTest, CountsAreLeftOutWithASentenceAndGeometryGoesOn) {
  EXPECT_TRUE(pipeline_->model().thermal_status.ok());
  Depth(0);
  for (int i = 0; i < 3; ++i) pipeline_->ProcessThermal(std::make_shared<ThermalFrame>());
  EXPECT_TRUE(Depth(1).tracked);
  EXPECT_EQ(LeftOut(LeftOutReason::kCounts), 3U);
  EXPECT_EQ(pipeline_->model().counts.thermal_fused, 0U);
  EXPECT_NE(pipeline_->model().thermal_status.message().find("sends counts"), std::string::npos);
}

TEST_F(PipelineFailuresTest, F12AScaleThatIsNoneIsLostAndLeavesNothing) {
  DepthFrame frame = testing::RenderDepth(testing::BallInCorner, *rig_.depth, TruePose(0));
  for (const double bad : {std::nan(""), 0.0, -1000.0, std::numeric_limits<double>::infinity()}) {
    frame.depth_scale = bad;
    EXPECT_FALSE(pipeline_->ProcessDepth(frame).tracked) << bad;
  }
  EXPECT_EQ(pipeline_->model().tsdf().block_count(), 0);
}

TEST_F(PipelineFailuresTest, F01WithoutDepthNothingIsFused) {
  for (int i = 0; i < 3; ++i) Depth(i);
  const std::int32_t blocks = pipeline_->model().tsdf().block_count();
  for (int i = 3; i < 33; ++i) Thermal(i);
  pipeline_->Finish();
  EXPECT_EQ(pipeline_->model().counts.thermal_fused, 0U);
  EXPECT_EQ(LeftOut(LeftOutReason::kNoDepthAfter), 30U);
  EXPECT_EQ(pipeline_->model().tsdf().block_count(), blocks);
}

TEST_F(PipelineFailuresTest, F04WithoutThermalGeometryGoesOnAndHasNoTemperature) {
  for (int i = 0; i < 5; ++i) EXPECT_TRUE(Depth(i).tracked);
  EXPECT_EQ(pipeline_->model().counts.depth_integrated, 5U);
  const Surface surface = ExtractSurface(pipeline_->model().tsdf(), pipeline_->model().thermal(),
                                         {}, pipeline_->model().pool);
  ASSERT_GT(surface.points.size(), 500U);
  for (const CloudPoint& point : surface.points) ASSERT_TRUE(std::isnan(point.celsius));
}

TEST_F(PipelineFailuresTest, F07WhileTheShutterIsClosedGeometryGoesOnAndNoTemperatureIsTaken) {
  Depth(0);
  for (int i = 1; i < 5; ++i) {
    Thermal(i - 0.5, /*valid=*/false);
    EXPECT_TRUE(Depth(i).tracked) << "no loss of tracking";
  }
  EXPECT_EQ(LeftOut(LeftOutReason::kNuc), 4U);
  EXPECT_EQ(pipeline_->model().counts.thermal_fused, 0U);
}

TEST_F(PipelineFailuresTest, F12TheMapHoldsNoValueThatIsNone) {
  std::mt19937 random(kSeed);
  const auto spoil = [&random](Image<std::uint16_t>& image, std::vector<std::uint16_t> with) {
    for (std::uint16_t& pixel : image.pixels())
      if (random() % 5 == 0) pixel = with[random() % with.size()];
  };
  for (int i = 0; i < 6; ++i) {
    DepthFrame depth = testing::RenderDepth(testing::BallInCorner, *rig_.depth, TruePose(i));
    depth.header.capture_time = Time(i);
    spoil(depth.depth_raw, {kNoDepth, kNoDepthSaturated, 1, 65'534});
    auto thermal = std::make_shared<ThermalFrame>();
    thermal->header.capture_time = Time(i - 0.5);
    thermal->temperature_raw =
        Image<std::uint16_t>(rig_.thermal->width, rig_.thermal->height, 32'315);
    spoil(thermal->temperature_raw, {0});  // As the edge leaves what is out of range.
    thermal->valid = true;
    if (i > 0) pipeline_->ProcessThermal(thermal);
    EXPECT_TRUE(pipeline_->ProcessDepth(depth).tracked) << i;
  }
  for (const StampedPose& pose : pipeline_->model().trajectory.poses())
    EXPECT_TRUE(pose.T_world_depth.matrix().allFinite());
  const Surface surface = ExtractSurface(pipeline_->model().tsdf(), pipeline_->model().thermal(),
                                         {}, pipeline_->model().pool);
  ASSERT_GT(surface.points.size(), 500U);
  int measured = 0;
  for (const CloudPoint& point : surface.points) {
    ASSERT_TRUE(point.position_m.allFinite());
    ASSERT_TRUE(point.normal.allFinite());
    if (std::isnan(point.celsius)) continue;  // Never measured.
    ++measured;
    ASSERT_NEAR(point.celsius, 50.0, 0.03) << "of 20 % nothing";
  }
  EXPECT_GT(measured, 300);
}

TEST_F(PipelineFailuresTest, F56ACameraWithoutPixelsIsNamed) {
  for (const auto& [width, height] : {std::pair{0, 240}, std::pair{320, 0}, std::pair{0, 0}}) {
    Rig rig = rig_;
    rig.depth->width = width;
    rig.depth->height = height;
    const auto created = GroundPipeline::Create(options_, rig, std::nullopt);
    ASSERT_FALSE(created.has_value());
    EXPECT_EQ(created.error().code(), StatusCode::kInvalidArgument);
    EXPECT_NE(created.error().message().find("depth: width and height"), std::string::npos);
    rig = rig_;
    rig.thermal->width = width;
    rig.thermal->height = height;
    EXPECT_NE(GroundPipeline::Create(options_, rig, std::nullopt)
                  .error()
                  .message()
                  .find("thermal: width and height"),
              std::string::npos);
  }
}

TEST_F(PipelineFailuresTest, F71AVolumeThatIsNoneOrTooLargeIsRefusedWithTheReason) {
  options_.mutable_volume()->set_size_z_m(0.0);
  const auto none = GroundPipeline::Create(options_, rig_, std::nullopt);
  ASSERT_FALSE(none.has_value());
  EXPECT_NE(none.error().message().find("must be positive, got 0.64 x 0.64 x 0 m"),
            std::string::npos)
      << none.error().message();
  VolumeOptions& volume = *options_.mutable_volume();
  volume.set_size_x_m(100.0);
  volume.set_size_y_m(100.0);
  volume.set_size_z_m(100.0);
  volume.set_voxel_size_m(0.001);
  const auto huge = GroundPipeline::Create(options_, rig_, std::nullopt);
  ASSERT_FALSE(huge.has_value());
  EXPECT_EQ(huge.error().code(), StatusCode::kResourceExhausted);
  // 12502^3 blocks of 4 bytes; 1 GiB holds 645^3, of 8 voxels each.
  EXPECT_NE(huge.error().message().find("needs 7279.5 GiB"), std::string::npos)
      << huge.error().message();
  EXPECT_NE(huge.error().message().find("use voxels of 0.019"), std::string::npos)
      << huge.error().message();
}

}  // namespace
}  // namespace isotherm
