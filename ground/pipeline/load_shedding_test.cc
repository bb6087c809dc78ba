// What the pipeline leaves out when there is not enough time for all frames.

#include <gtest/gtest.h>

#include "ground/pipeline/ground_pipeline.h"
#include "ground/pipeline/testing/pipeline_fixture.h"

namespace isotherm {
namespace {

using LoadSheddingTest = testing::PipelineFixture;

TEST_F(LoadSheddingTest, WithHardlyAnyTimeThermalFramesStayAtATenthOfASecond) {
  Depth(0);
  pipeline_->set_load_shedding(LoadShedding::kSparseThermal);
  for (int i = 1; i <= 9; ++i) {  // At 30 per second.
    Thermal(i - 0.5);
    Depth(i);
    EXPECT_EQ(pipeline_->model().counts.thermal_fused, static_cast<std::uint64_t>((i + 2) / 3));
  }
  EXPECT_EQ(LeftOut(LeftOutReason::kBehind), 6U);
  EXPECT_EQ(pipeline_->model().counts.depth_integrated, 10U);
  EXPECT_EQ(pipeline_->model().counts.depth_behind, 0U);
  EXPECT_NEAR(pipeline_->model().counts.longest_thermal_pause_s, 0.1, 1e-6);
  pipeline_->set_load_shedding(LoadShedding::kNone);
  for (int i = 10; i <= 12; ++i) {
    Thermal(i - 0.5);
    Depth(i);
  }
  EXPECT_EQ(pipeline_->model().counts.thermal_fused, 6U);
  EXPECT_EQ(LeftOut(LeftOutReason::kBehind), 6U);
}

TEST_F(LoadSheddingTest, WithHalfTheTimeForThermalEverySecondFrameIsLeftOut) {
  constexpr int kFrames = 6;
  Depth(0);
  pipeline_->set_load_shedding(LoadShedding::kHalfThermal);
  for (int i = 1; i <= kFrames; ++i) {
    Thermal(i - 0.5);
    Depth(i);
    EXPECT_EQ(pipeline_->model().counts.thermal_fused, static_cast<std::uint64_t>((i + 1) / 2));
  }
  EXPECT_EQ(LeftOut(LeftOutReason::kBehind), 0U + kFrames / 2);
  EXPECT_EQ(pipeline_->model().counts.depth_integrated, 1U + kFrames);
}

TEST_F(LoadSheddingTest, WithTimeForEverySecondFrameAllAreTracked) {
  constexpr double kMaxError = 0.002;  // Metres: half a voxel.
  constexpr int kFrames = 8;
  Depth(0);
  pipeline_->set_load_shedding(LoadShedding::kEverySecond);
  for (int i = 1; i <= kFrames; ++i) {
    Thermal(i - 0.5);
    const DepthReport report = Depth(i);
    ASSERT_TRUE(report.tracked) << i;
    EXPECT_EQ(report.integrated, i % 2 == 1) << i;
    EXPECT_LT(TranslationDistance(report.pose.T_map_depth, TruePose(i)), kMaxError) << i;
  }
  const ScanCounts& counts = pipeline_->model().counts;
  EXPECT_EQ(counts.depth_tracked, 1U + kFrames);
  EXPECT_EQ(counts.depth_integrated, 1U + kFrames / 2);
  EXPECT_EQ(counts.depth_behind, 0U + kFrames / 2);
  EXPECT_EQ(LeftOut(LeftOutReason::kBehind), 5U) << "frames 0, 3 and 6 are fused";
  pipeline_->set_load_shedding(LoadShedding::kNone);
  for (int i = kFrames + 1; i <= kFrames + 3; ++i) {
    Thermal(i - 0.5);
    EXPECT_TRUE(Depth(i).integrated) << i;
  }
  EXPECT_EQ(counts.depth_behind, 0U + kFrames / 2);
  EXPECT_EQ(counts.thermal_fused, 6U);
}

TEST_F(LoadSheddingTest, WithEvenLessTimeThreeOfFourAreOnlyTracked) {
  constexpr double kMaxError = 0.002;  // Metres: half a voxel.
  constexpr int kFrames = 16;
  Depth(0);
  pipeline_->set_load_shedding(LoadShedding::kEveryFourth);
  for (int i = 1; i <= kFrames; ++i) {
    Thermal(i - 0.5);
    const DepthReport report = Depth(i);
    ASSERT_TRUE(report.tracked) << i;
    EXPECT_EQ(report.integrated, i % 4 == 1) << i;
    EXPECT_LT(TranslationDistance(report.pose.T_map_depth, TruePose(i)), kMaxError) << i;
  }
  const ScanCounts& counts = pipeline_->model().counts;
  EXPECT_EQ(counts.depth_behind, 0U + kFrames * 3 / 4);
  EXPECT_EQ(counts.thermal_fused, 3U) << "of 30 per second one in 230 ms";
  EXPECT_NEAR(counts.longest_thermal_pause_s, 7.0 / 30.0, 1e-6);
}

TEST_F(LoadSheddingTest, OnlyThinningMakesAPauseThatCounts) {
  Depth(0);
  Thermal(0.5);
  Depth(1);
  for (int i = 2; i <= 5; ++i) Depth(i);  // The thermal camera is silent.
  Thermal(5.5);
  Depth(6);
  pipeline_->set_load_shedding(LoadShedding::kSparseThermal);
  for (int i = 7; i <= 12; ++i) {  // A correction begins while frames are left out.
    Thermal(i - 0.5, /*valid=*/i < 9);
    Depth(i);
  }
  pipeline_->set_load_shedding(LoadShedding::kNone);
  Thermal(12.5);
  Depth(13);
  EXPECT_EQ(pipeline_->model().counts.thermal_fused, 3U);
  EXPECT_EQ(LeftOut(LeftOutReason::kBehind), 2U);
  EXPECT_EQ(LeftOut(LeftOutReason::kNuc), 4U);
  EXPECT_EQ(pipeline_->model().counts.longest_thermal_pause_s, 0.0);
}

}  // namespace
}  // namespace isotherm
