#include "ground/ground_pipeline.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "ground/initial_pose.h"
#include "ground/tracker/analytic_views_for_test.h"

namespace isotherm {
namespace {

using namespace std::chrono_literals;

TEST(ParsePoseTest, ReadsSevenNumbersAndRefusesTheRest) {
  const auto pose = ParsePose(" 0.1 -0.2 3e-1 0 0 0 1 ");
  ASSERT_TRUE(pose.has_value());
  EXPECT_TRUE(pose->translation().isApprox(Eigen::Vector3d(0.1, -0.2, 0.3)));
  for (const char* bad : {"", "1 2 3", "1 2 3 0 0 0 1 9", "1 2 3 0 0 0 0", "a b c d e f g",
                          "1 2 nan 0 0 0 1", "0 0 0 0 0 0 2"}) {
    EXPECT_EQ(ParsePose(bad).error().code(), StatusCode::kInvalidArgument) << bad;
  }
}

class GroundPipelineTest : public ::testing::Test {
 protected:
  static constexpr double kStep = 0.003;  // Metres per frame.

  GroundPipelineTest() {
    rig_.depth = testing::SmallDepthCamera();
    rig_.thermal = rig_.depth;
    rig_.T_thermal_depth = MakeTransform({0.02, 0.0, 0.0}, Eigen::Quaterniond::Identity());
    VolumeOptions& volume = *options_.mutable_volume();
    volume.set_size_x_m(0.64);
    volume.set_size_y_m(0.64);
    volume.set_size_z_m(0.64);
    volume.set_voxel_size_m(0.004);
    options_.mutable_tsdf()->set_truncation_distance_m(0.016);
    options_.set_threads(2);
    Start();
  }
  void Start() {
    auto created = GroundPipeline::Create(options_, rig_, testing::FirstPose());
    ASSERT_TRUE(created.has_value()) << created.error().message();
    pipeline_ = std::move(*created);
  }

  static RigidTransform TruePose(int i) {
    const double turn = 0.3 * i * std::numbers::pi / 180.0;
    return testing::FirstPose() *
           MakeTransform({kStep * i, 0.5 * kStep * i, 0.0},
                         Eigen::Quaterniond(Eigen::AngleAxisd(-turn, Eigen::Vector3d::UnitY())));
  }
  static CaptureTime Time(double frame) { return CaptureTime(FromSeconds(100.0 + frame / 30.0)); }

  DepthReport Depth(int i) {
    DepthFrame frame = testing::RenderDepth(testing::BallInCorner, *rig_.depth, TruePose(i));
    frame.header.capture_time = Time(i);
    return pipeline_->ProcessDepth(frame);
  }
  DepthReport Covered(int i) {
    DepthFrame frame;
    frame.depth_raw =
        Image<std::uint16_t>(rig_.depth->width, rig_.depth->height, kNoDepthSaturated);
    frame.header.capture_time = Time(i);
    return pipeline_->ProcessDepth(frame);
  }
  void Thermal(double at, bool valid = true) {
    auto frame = std::make_shared<ThermalFrame>();
    frame->header.capture_time = Time(at);
    frame->centikelvin =
        Image<std::uint16_t>(rig_.thermal->width, rig_.thermal->height, 32'315);  // 50 °C
    frame->valid = valid;
    pipeline_->ProcessThermal(frame);
  }
  std::uint64_t LeftOut(const std::string& reason) const {
    const auto found = pipeline_->counts().thermal_left_out.find(reason);
    return found == pipeline_->counts().thermal_left_out.end() ? 0 : found->second;
  }

  Rig rig_;
  GroundOptions options_;
  std::unique_ptr<GroundPipeline> pipeline_;
};

TEST_F(GroundPipelineTest, FollowsAKnownPath) {
  constexpr double kMaxError = 0.001;  // Metres after ten frames: a quarter of a voxel.
  for (int i = 0; i < 10; ++i) {
    const DepthReport report = Depth(i);
    ASSERT_TRUE(report.tracked) << i;
    EXPECT_LT(TranslationDistance(pipeline_->trajectory().back().T_world_depth, TruePose(i)),
              kMaxError)
        << i;
  }
  EXPECT_EQ(pipeline_->counts().depth_tracked, 10U);
}

TEST_F(GroundPipelineTest, ResultDoesNotDependOnTheNumberOfThreads) {
  for (int i = 0; i < 4; ++i) Depth(i);
  const RigidTransform two = pipeline_->trajectory().back().T_world_depth;
  const std::int32_t blocks = pipeline_->tsdf().block_count();
  options_.set_threads(3);
  Start();
  for (int i = 0; i < 4; ++i) Depth(i);
  EXPECT_EQ(pipeline_->trajectory().back().T_world_depth.matrix(), two.matrix());
  EXPECT_EQ(pipeline_->tsdf().block_count(), blocks);
}

TEST_F(GroundPipelineTest, ACoveredCameraLeavesTheModelAloneAndTrackingComesBack) {
  for (int i = 0; i < 4; ++i) Depth(i);
  const std::uint64_t integrated = pipeline_->counts().depth_integrated;
  for (int i = 4; i < 7; ++i) EXPECT_FALSE(Covered(i).tracked);
  EXPECT_EQ(pipeline_->counts().depth_integrated, integrated);
  EXPECT_EQ(pipeline_->counts().depth_lost.at("too_few_pixels"), 3U);
  EXPECT_TRUE(Depth(4).tracked);
  EXPECT_EQ(pipeline_->trajectory().size(), 5U);
}

TEST_F(GroundPipelineTest, ThermalFramesWaitForTheDepthFrameBehindThem) {
  Depth(0);
  Thermal(0.5);
  EXPECT_EQ(pipeline_->counts().thermal_fused, 0U);
  Depth(1);
  EXPECT_EQ(pipeline_->counts().thermal_fused, 1U);
  int measured = 0;
  for (std::int32_t block = 0; block < pipeline_->tsdf().block_count(); ++block) {
    for (const ThermalVoxel& voxel : pipeline_->thermal().voxels(block)) {
      if (!voxel.measured()) continue;
      ++measured;
      ASSERT_NEAR(voxel.celsius(), 50.0, 0.03);
    }
  }
  EXPECT_GT(measured, 1000);
}

TEST_F(GroundPipelineTest, EachThermalFrameIsAccountedFor) {
  Thermal(-0.5);  // Before the first pose.
  Depth(0);
  Thermal(0.5);
  Thermal(0.7, /*valid=*/false);  // Shutter closed.
  Depth(1);
  Thermal(1.5);
  Covered(2);
  Depth(3);  // The motion between the frames around 1.5 is not known.
  Thermal(3.5);
  pipeline_->Finish();
  const PipelineCounts& counts = pipeline_->counts();
  EXPECT_EQ(counts.thermal_in, 5U);
  EXPECT_EQ(counts.thermal_fused, 1U);
  EXPECT_EQ(LeftOut("nuc"), 1U);
  EXPECT_EQ(LeftOut("pose_unknown"), 2U);
  EXPECT_EQ(LeftOut("no_depth_after"), 1U);
}

TEST_F(GroundPipelineTest, F56WithoutExtrinsicsGeometryGoesOnAndThermalIsRefused) {
  rig_.T_thermal_depth.reset();
  Start();
  EXPECT_EQ(pipeline_->thermal_status().code(), StatusCode::kFailedPrecondition);
  Depth(0);
  Thermal(0.5);
  EXPECT_TRUE(Depth(1).tracked);
  EXPECT_EQ(LeftOut("no_calibration"), 1U);
}

TEST_F(GroundPipelineTest, F11AFrameOfAnotherSizeIsRefusedAndCounted) {
  Depth(0);
  DepthFrame frame;
  frame.depth_raw = Image<std::uint16_t>(17, 3, 500);
  EXPECT_FALSE(pipeline_->ProcessDepth(frame).tracked);
  EXPECT_EQ(pipeline_->counts().depth_refused, 1U);
  EXPECT_TRUE(Depth(1).tracked);
}

TEST_F(GroundPipelineTest, WithoutAPoseTheVolumesCentreLiesOnTheFirstAxis) {
  auto created = GroundPipeline::Create(options_, rig_, std::nullopt);
  ASSERT_TRUE(created.has_value());
  pipeline_ = std::move(*created);
  Depth(0);
  const RigidTransform& pose = pipeline_->trajectory().front().T_world_depth;
  EXPECT_NEAR(pose.translation().x(), 0.32, 1e-9);
  EXPECT_NEAR(pose.translation().y(), 0.32, 1e-9);
  EXPECT_LT(pose.translation().z(), 0.0);
}

TEST_F(GroundPipelineTest, OptionsOutOfRangeAreNamed) {
  options_.mutable_tsdf()->set_truncation_distance_m(0.001);
  const auto created = GroundPipeline::Create(options_, rig_, std::nullopt);
  ASSERT_FALSE(created.has_value());
  EXPECT_NE(created.error().message().find("tsdf.truncation_distance_m"), std::string::npos);
  rig_.depth.reset();
  options_.clear_tsdf();
  EXPECT_FALSE(GroundPipeline::Create(options_, rig_, std::nullopt).has_value());
}

}  // namespace
}  // namespace isotherm
