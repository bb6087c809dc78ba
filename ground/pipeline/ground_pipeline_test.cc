#include "ground/pipeline/ground_pipeline.h"

#include <gtest/gtest.h>

#include "ground/pipeline/testing/pipeline_fixture.h"

namespace isotherm {
namespace {

using GroundPipelineTest = testing::PipelineFixture;

TEST_F(GroundPipelineTest, FollowsAKnownPath) {
  constexpr double kMaxError = 0.001;  // Metres after ten frames: a quarter of a voxel.
  for (int i = 0; i < 10; ++i) {
    const DepthReport report = Depth(i);
    ASSERT_TRUE(report.tracked) << i;
    EXPECT_LT(TranslationDistance(pipeline_->model().trajectory.poses().back().T_world_depth,
                                  TruePose(i)),
              kMaxError)
        << i;
  }
  EXPECT_EQ(pipeline_->model().counts.depth_tracked, 10U);
}

TEST_F(GroundPipelineTest, ResultDoesNotDependOnTheNumberOfThreads) {
  for (int i = 0; i < 4; ++i) Depth(i);
  const RigidTransform two = pipeline_->model().trajectory.poses().back().T_world_depth;
  const std::int32_t blocks = pipeline_->model().tsdf().block_count();
  options_.set_threads(3);
  Start();
  for (int i = 0; i < 4; ++i) Depth(i);
  EXPECT_EQ(pipeline_->model().trajectory.poses().back().T_world_depth.matrix(), two.matrix());
  EXPECT_EQ(pipeline_->model().tsdf().block_count(), blocks);
}

TEST_F(GroundPipelineTest, ThermalFramesWaitForTheDepthFrameBehindThem) {
  Depth(0);
  Thermal(0.5);
  EXPECT_EQ(pipeline_->model().counts.thermal_fused, 0U);
  Depth(1);
  EXPECT_EQ(pipeline_->model().counts.thermal_fused, 1U);
  int measured = 0;
  for (std::int32_t block = 0; block < pipeline_->model().tsdf().block_count(); ++block) {
    for (const ThermalVoxel& voxel : pipeline_->model().thermal().voxels(block)) {
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
  for (int i = 3; i < 6; ++i) Depth(i);  // Found again; the motion around 1.5 is not known.
  Thermal(5.5);
  pipeline_->Finish();
  const ScanCounts& counts = pipeline_->model().counts;
  EXPECT_EQ(counts.thermal_in, 5U);
  EXPECT_EQ(counts.thermal_fused, 1U);
  EXPECT_EQ(LeftOut(LeftOutReason::kNuc), 1U);
  EXPECT_EQ(LeftOut(LeftOutReason::kPoseUnknown), 2U);
  EXPECT_EQ(LeftOut(LeftOutReason::kNoDepthAfter), 1U);
}

}  // namespace
}  // namespace isotherm
