#include "ground/service/live_scan.h"

#include <gtest/gtest.h>

#include <memory>
#include <nlohmann/json.hpp>

#include "ground/options/option_geometry.h"
#include "ground/surface/testing/analytic_views.h"
#include "ground/surface/testing/small_volume.h"

namespace isotherm {
namespace {

using namespace std::chrono_literals;

/// Frames of a moving rig that wait for their turn as long as the test says.
class LiveScanTest : public ::testing::Test {
 protected:
  LiveScanTest() {
    rig_.session = 7;
    rig_.rig.depth = testing::SmallDepthCamera();
    rig_.rig.thermal = rig_.rig.depth;
    rig_.rig.T_thermal_depth = MakeTransform({0.02, 0.0, 0.0}, Eigen::Quaterniond::Identity());
    VolumeOptions& volume = *options_.mutable_volume();
    volume = testing::SmallVolume();
    *volume.mutable_expert()->mutable_initial_pose() = ToOptions(testing::FirstPose());
    options_.mutable_tsdf()->mutable_expert()->set_truncation_distance_m(
        testing::kSmallTruncation_m);
    options_.mutable_live()->mutable_expert()->set_max_wait_s(0.1);
    options_.set_threads(2);
    rig_.rig.thermal_sensor.time_constant_s = 0.001;  // What is near moves fast.
  }
  void Start() {
    auto created = LiveScan::Create(clock_, options_, rig_);
    ASSERT_TRUE(created.has_value()) << created.error().message();
    scan_ = std::move(*created);
  }

  static CaptureTime Time(double frame) { return CaptureTime(FromSeconds(100.0 + frame / 30.0)); }

  /// A depth frame whose turn comes `wait` after its arrival, stamped `jitter` frames off.
  void Depth(int i, Nanoseconds wait, double jitter = 0.0) {
    constexpr double kStep = 0.003;  // Metres per frame.
    auto frame = std::make_shared<DepthFrame>(testing::RenderDepth(
        testing::BallInCorner, *rig_.rig.depth,
        testing::FirstPose() *
            MakeTransform({kStep * i, 0.5 * kStep * i, 0.0}, Eigen::Quaterniond::Identity())));
    frame->header.capture_time = Time(i + jitter);
    const CaptureTime arrival = clock_.Now();
    clock_.Advance(wait);
    scan_->Add(ReceivedDepth{frame, nullptr, arrival, arrival});
  }
  void Thermal(double at) {
    auto frame = std::make_shared<ThermalFrame>();
    frame->header.capture_time = Time(at);
    frame->temperature_raw = Image<std::uint16_t>(rig_.rig.thermal->width, rig_.rig.thermal->height,
                                                  32'315);  // 50 °C.
    frame->valid = true;
    scan_->Add(ReceivedThermal{frame, nullptr, clock_.Now(), clock_.Now()});
  }
  /// Depth frames `first` .. `last`, a thermal frame before each but the first of all.
  void Run(int first, int last, Nanoseconds wait) {
    for (int i = first; i <= last; ++i) {
      if (i > 0) Thermal(i - 0.5);
      Depth(i, wait);
    }
  }

  const ScanCounts& counts() { return scan_->model().counts; }
  std::uint64_t ThermalBehind() { return counts().thermal_left_out[LeftOutReason::kBehind]; }

  FakeClock clock_{CaptureTime(FromSeconds(1000.0))};
  GroundOptions options_;
  RigDescription rig_;
  std::unique_ptr<LiveScan> scan_;
};

TEST_F(LiveScanTest, FramesInTimeAreAllUsed) {
  Start();
  Run(0, 6, 30ms);
  scan_->FinishFrames();
  EXPECT_EQ(counts().depth_integrated, 7U);
  EXPECT_EQ(counts().depth_behind, 0U);
  EXPECT_EQ(counts().thermal_fused, 6U);
  EXPECT_EQ(scan_->waiting().count(), 13U);
}

TEST_F(LiveScanTest, FeedbackSaysHowUncertainThePoseIs) {
  Start();
  Run(0, 6, 30ms);
  const std::optional<Feedback> feedback = scan_->TakeFeedback();
  ASSERT_TRUE(feedback && feedback->T_world_depth && feedback->pose_covariance);
  EXPECT_TRUE(IsCovariance(*feedback->pose_covariance));
  const PoseSigma sigma = LargestSigma(*feedback->pose_covariance);
  EXPECT_GT(sigma.translation_m, 0.0);
  EXPECT_LT(sigma.translation_m, 0.001) << "a ball in a corner holds the rig in all directions";
  EXPECT_EQ(scan_->model().trajectory.sigmas().size(), scan_->model().trajectory.poses().size());
  EXPECT_EQ(scan_->model().trajectory.sigmas().back().rotation_rad, sigma.rotation_rad);
}

TEST_F(LiveScanTest, EverySecondThermalFrameIsLeftOutBeforeAllAre) {
  Start();
  Run(0, 6, 40ms);
  scan_->FinishFrames();
  EXPECT_EQ(counts().depth_integrated, 7U);
  EXPECT_EQ(counts().thermal_fused, 3U);
  EXPECT_EQ(ThermalBehind(), 3U);
  const std::optional<Feedback> feedback = scan_->TakeFeedback();
  ASSERT_TRUE(feedback.has_value());
  Run(7, 20, 40ms);
  EXPECT_EQ(scan_->TakeFeedback()->advice, std::vector<Advice>{Advice::kSlower});
}

TEST_F(LiveScanTest, BeyondMostOfTheLongestWaitTenThermalFramesPerSecondStay) {
  Start();
  Run(0, 6, 50ms);
  scan_->FinishFrames();
  EXPECT_EQ(counts().depth_integrated, 7U);
  EXPECT_EQ(counts().depth_behind, 0U);
  EXPECT_EQ(counts().thermal_fused, 2U);
  EXPECT_EQ(ThermalBehind(), 4U);
}

TEST_F(LiveScanTest, BeyondTheLongestWaitEverySecondDepthFrameIsNotIntegratedEither) {
  Start();
  Run(0, 7, 150ms);
  scan_->FinishFrames();
  EXPECT_EQ(counts().depth_tracked, 8U);
  EXPECT_EQ(counts().depth_integrated, 4U);
  EXPECT_EQ(counts().depth_behind, 4U);
  EXPECT_EQ(ThermalBehind(), 4U) << "frames 0, 3 and 6 are fused";
}

TEST_F(LiveScanTest, OnceCaughtUpAllIsDoneAgain) {
  Start();
  Run(0, 3, 150ms);
  Run(4, 8, 10ms);
  scan_->FinishFrames();
  EXPECT_EQ(counts().depth_tracked, 9U);
  EXPECT_EQ(counts().depth_behind, 2U);  // Frames 1 and 3.
  EXPECT_EQ(counts().depth_integrated, 7U);
  EXPECT_EQ(ThermalBehind(), 2U);
  EXPECT_EQ(counts().thermal_fused, 6U);  // The first, and from the one before frame 4 on.
}

TEST_F(LiveScanTest, ItSaysWhenWorkWasLeftOut) {
  Start();
  Run(0, 3, 120ms);
  clock_.Advance(1s);
  Run(4, 6, 10ms);
  scan_->FinishFrames();
  const Json json = scan_->DescribeLoadShedding();
  EXPECT_DOUBLE_EQ(json.at("begun_unix_s").get<double>(), 1000.0);
  EXPECT_DOUBLE_EQ(json.at("until_s").get<double>(), 1.51);
  ASSERT_EQ(json.at("changes").size(), 2U) << JsonText(json);
  EXPECT_EQ(json.at("changes").at(0).at("level"), "every_second");
  EXPECT_DOUBLE_EQ(json.at("changes").at(0).at("since_s").get<double>(), 0.0);
  EXPECT_EQ(json.at("changes").at(1).at("level"), "none");
  EXPECT_DOUBLE_EQ(json.at("changes").at(1).at("since_s").get<double>(), 1.0);
}

TEST_F(LiveScanTest, WhatWaitsForTheOtherStreamIsNotBehind) {
  Start();
  Depth(0, 10ms);
  clock_.Advance(2s);  // No thermal frame comes; the depth frame is held back.
  Run(1, 6, 10ms);
  scan_->FinishFrames();
  EXPECT_EQ(counts().depth_behind, 0U);
  EXPECT_EQ(ThermalBehind(), 0U);
  EXPECT_GT(scan_->waiting().Percentile(100), 2000.0);
}

TEST_F(LiveScanTest, AnImageThatComesTwiceIsNotALoss) {
  options_.mutable_live()->mutable_expert()->set_feedback_hz(30.0);
  Start();
  Run(0, 3, 10ms);
  scan_->FinishFrames();
  EXPECT_EQ(scan_->TakeFeedback()->tracking_state, TrackingState::kTracked);
  Depth(3, 10ms);  // The same again.
  scan_->FinishFrames();
  EXPECT_EQ(counts().depth_repeated, 1U);
  EXPECT_FALSE(scan_->TakeFeedback().has_value());
}

TEST_F(LiveScanTest, AReplayThatWaitsForTheGroundLosesNothing) {
  rig_.waits_for_ground = true;
  Start();
  Run(0, 6, 10s);
  scan_->FinishFrames();
  EXPECT_EQ(counts().depth_integrated, 7U);
  EXPECT_EQ(counts().depth_behind, 0U);
  EXPECT_EQ(counts().thermal_fused, 6U);
  EXPECT_EQ(ThermalBehind(), 0U);
}

TEST_F(LiveScanTest, ALongestWaitOfZeroNeverLeavesAnythingOut) {
  options_.mutable_live()->mutable_expert()->set_max_wait_s(0.0);
  Start();
  Run(0, 6, 10s);
  scan_->FinishFrames();
  EXPECT_EQ(counts().depth_integrated, 7U);
  EXPECT_EQ(counts().depth_behind, 0U);
  EXPECT_EQ(counts().thermal_fused, 6U);
  EXPECT_TRUE(scan_->DescribeLoadShedding().is_null());
}

TEST_F(LiveScanTest, FeedbackKeepsItsRateWhenFramesJitter) {
  options_.mutable_live()->mutable_expert()->set_feedback_hz(10.0);
  Start();
  int messages = 0;
  constexpr int kFrames = 31;  // One second.
  for (int i = 0; i < kFrames; ++i) {
    if (i > 0) Thermal(i - 0.5);
    Depth(i, 1ms, i % 3 == 0 ? -0.01 : 0.0);  // A deadline is met a little early.
    if (scan_->TakeFeedback()) ++messages;
  }
  EXPECT_GE(messages, 10);
  EXPECT_LE(messages, 11);
}

TEST_F(LiveScanTest, FeedbackSaysHowWellViewAndModelAreMeasured) {
  options_.mutable_live()->mutable_expert()->set_feedback_hz(60.0);  // On each frame.
  Start();
  std::optional<Feedback> feedback;
  for (int i = 0; i < 8; ++i) {
    if (i > 0) Thermal(i - 0.5);
    Depth(i, 1ms);
    if (auto next = scan_->TakeFeedback()) feedback = std::move(next);
    scan_->ThinkAhead();
  }
  ASSERT_TRUE(feedback.has_value());
  EXPECT_EQ(feedback->session, rig_.session);
  EXPECT_EQ(feedback->tracking_state, TrackingState::kTracked);
  const auto sum = [](const CoverageFractions& fractions) {
    return fractions.good + fractions.acceptable + fractions.bad + fractions.never_measured;
  };
  EXPECT_NEAR(sum(feedback->view), 1.0, 1e-5);
  EXPECT_NEAR(sum(feedback->model), 1.0, 1e-5);
  // The ball is 0.33 m away and faces the camera; the walls behind it are 0.62 m away.
  EXPECT_GT(feedback->view.good, 0.02);
  EXPECT_LT(feedback->view.good, 0.6);
  EXPECT_GT(feedback->view.acceptable, 0.2);
  EXPECT_GT(feedback->covered_area_m2, 0.1);
  EXPECT_LT(feedback->covered_area_m2, 0.6);
  ASSERT_FALSE(feedback->image.empty());
  EXPECT_LE(feedback->image.size(), kMaxConfidenceImageBytes);
  EXPECT_EQ(JsonText(scan_->DescribeFeedback()).find("\"messages\": 0"), std::string::npos);
}

TEST_F(LiveScanTest, TheNextViewIsGivenInWorldAndFromTheRig) {
  options_.mutable_live()->mutable_expert()->set_feedback_hz(60.0);  // On each frame.
  Start();
  std::optional<Feedback> feedback;
  for (int i = 0; i < 12; ++i) {
    Depth(i, 1ms);
    Thermal(i + 0.5);
    if (auto next = scan_->TakeFeedback()) feedback = std::move(next);
    for (int k = 0; k < 5; ++k) scan_->ThinkAhead();
  }
  ASSERT_TRUE(feedback.has_value());
  ASSERT_TRUE(feedback->T_world_depth_next.has_value());
  EXPECT_GT(feedback->next_gain_m2, options_.feedback().expert().min_gain_m2());
  ASSERT_TRUE(feedback->T_depth_next.has_value());
  EXPECT_TRUE((*feedback->T_world_depth * *feedback->T_depth_next)
                  .isApprox(*feedback->T_world_depth_next, 1e-9));
}

TEST_F(LiveScanTest, EnoughOfTheSurfaceMeasuredWellIsDone) {
  options_.mutable_live()->mutable_expert()->set_feedback_hz(60.0);  // On each frame.
  options_.mutable_feedback()->set_done_fraction(0.01);
  options_.mutable_feedback()->mutable_expert()->set_settle_s(0.0);
  Start();
  std::optional<Feedback> feedback;
  for (int i = 0; i < 10; ++i) {
    if (i > 0) Thermal(i - 0.5);
    Depth(i, 1ms);
    if (auto next = scan_->TakeFeedback()) feedback = std::move(next);
    scan_->ThinkAhead();
  }
  ASSERT_TRUE(feedback.has_value());
  EXPECT_TRUE(feedback->done);
  ASSERT_EQ(feedback->advice.size(), 1U);
  EXPECT_EQ(feedback->advice[0], Advice::kDone);
  EXPECT_FALSE(feedback->T_world_depth_next.has_value()) << "there is nothing more to go to";
}

TEST_F(LiveScanTest, ALostTrackIsSentBackToWhereItWorked) {
  options_.mutable_live()->mutable_expert()->set_feedback_hz(60.0);  // On each frame.
  Start();
  Run(0, 6, 1ms);
  scan_->FinishFrames();
  const RigidTransform last = *scan_->TakeFeedback()->T_world_depth;
  auto nothing = std::make_shared<DepthFrame>();  // The camera is covered.
  nothing->header.capture_time = Time(7);
  nothing->depth_scale = 1000.0;
  nothing->depth_raw = Image<std::uint16_t>(rig_.rig.depth->width, rig_.rig.depth->height, 0);
  scan_->Add(ReceivedDepth{nothing, nullptr, clock_.Now(), clock_.Now()});
  scan_->FinishFrames();
  const std::optional<Feedback> feedback = scan_->TakeFeedback();
  ASSERT_TRUE(feedback.has_value());
  EXPECT_EQ(feedback->tracking_state, TrackingState::kLost);
  ASSERT_EQ(feedback->advice.size(), 1U);
  EXPECT_EQ(feedback->advice[0], Advice::kGoBackToRelocalise);
  ASSERT_TRUE(feedback->T_world_depth_next.has_value());
  EXPECT_TRUE(feedback->T_world_depth_next->isApprox(last, 1e-9));
  EXPECT_FALSE(feedback->T_depth_next.has_value()) << "nobody knows where the rig is";
  EXPECT_FALSE(feedback->T_world_depth.has_value());
}

}  // namespace
}  // namespace isotherm
