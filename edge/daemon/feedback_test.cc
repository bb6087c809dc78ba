// The edge measures the age of feedback, and shows its words and its image.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <numbers>
#include <sstream>

#include "common/messages/feedback_text.h"
#include "common/testing/temporary_directory.h"
#include "edge/daemon/replace_file.h"
#include "edge/pipeline/feedback_monitor.h"

namespace isotherm {
namespace {

using namespace std::chrono_literals;
using ::testing::HasSubstr;
using ::testing::Not;

/// The percentiles in StageStats are as exact as this.
constexpr double kRelativeTolerance = 0.01;

TEST(FeedbackMonitorTest, AgeIsFromCaptureToArrival) {
  FeedbackMonitor monitor(TimeBase::kWallClock);
  EXPECT_EQ(monitor.latency().count, 0U);
  EXPECT_TRUE(std::isnan(monitor.latency().p99_s));
  Feedback feedback;
  for (int i = 1; i <= 100; ++i) {
    feedback.frame_number = static_cast<std::uint64_t>(i);
    feedback.capture_time = CaptureTime(i * 100ms);
    monitor.Add(feedback, feedback.capture_time + i * 1ms);
  }
  EXPECT_EQ(monitor.latency().count, 100U);
  EXPECT_NEAR(monitor.latency().p50_s, 0.050, 0.050 * kRelativeTolerance);
  EXPECT_NEAR(monitor.latency().p99_s, 0.099, 0.099 * kRelativeTolerance);
  EXPECT_EQ(monitor.newest()->frame_number, 100U);
}

TEST(FeedbackMonitorTest, ARecordingsOwnTimesCountFromWhenItsFramesCame) {
  FeedbackMonitor monitor(TimeBase::kShifted);
  Feedback feedback;
  feedback.capture_time = CaptureTime(10s);
  monitor.NoteCapture(CaptureTime(10s), CaptureTime(1h + 3ms));  // Played 3 ms late.
  monitor.NoteCapture(CaptureTime(11s), CaptureTime(1h + 1s));
  monitor.NoteCapture(CaptureTime(12s), CaptureTime(1h + 2s + 5ms));
  monitor.Add(feedback, CaptureTime(1h + 50ms));
  EXPECT_NEAR(monitor.latency().p50_s, 0.050, 0.050 * kRelativeTolerance);
}

TEST(FeedbackMonitorTest, TimesAtAnotherPaceHaveNoAge) {
  FeedbackMonitor monitor(TimeBase::kOther);
  monitor.NoteCapture({}, CaptureTime(1h));
  monitor.Add({}, CaptureTime(1h));
  EXPECT_EQ(monitor.latency().count, 1U);
  EXPECT_TRUE(std::isnan(monitor.latency().p50_s));
}

Eigen::Quaterniond Rotation(double deg, const Eigen::Vector3d& axis) {
  return Eigen::Quaterniond(Eigen::AngleAxisd(deg * std::numbers::pi / 180.0, axis));
}

TEST(FeedbackTextTest, MovesAreSaidInTheOperatorsWords) {
  EXPECT_EQ(MoveText(RigidTransform::Identity()), "here");
  EXPECT_EQ(MoveText(MakeTransform({0.3, 0, 0}, Eigen::Quaterniond::Identity())), "0.30 m right");
  EXPECT_EQ(MoveText(MakeTransform({-0.3, 0.1, -0.2}, Eigen::Quaterniond::Identity())),
            "0.30 m left, 0.10 m down, 0.20 m back");
  // About y (down), x (right) turns to the back: a positive angle looks to the right.
  EXPECT_EQ(MoveText(MakeTransform({0, 0, 0}, Rotation(30, Eigen::Vector3d::UnitY()))),
            "turn 30 deg right");
  EXPECT_EQ(MoveText(MakeTransform({0, -0.1, 0.01}, Rotation(20, Eigen::Vector3d::UnitX()))),
            "0.10 m up, turn 20 deg up");
}

TEST(FeedbackTextTest, OneLineHasStateCoverageAdviceAndWay) {
  Feedback feedback;
  feedback.tracking_state = TrackingState::kTracked;
  feedback.view.good = 0.615F;
  feedback.model.good = 0.25F;
  feedback.covered_area_m2 = 0.8;
  feedback.advice = {Advice::kMoveCloser};
  feedback.advice_reason = "40 % of the surface is farther than 0.60 m";
  feedback.T_depth_next = MakeTransform({0.3, 0, 0}, Eigen::Quaterniond::Identity());
  EXPECT_EQ(
      FeedbackText(feedback),
      "closer (40 % of the surface is farther than 0.60 m), tracked, view 62 % good, all 25 % "
      "of 0.80 m2, next view: 0.30 m right");
}

TEST(FeedbackTextTest, WithoutAdviceTheOperatorGoesOn) {
  Feedback feedback;
  EXPECT_EQ(AdviceText(feedback), "go on");
  feedback.advice_reason = "90 % in view is measured well: go on";
  EXPECT_EQ(AdviceText(feedback), "90 % in view is measured well: go on");
}

TEST(FeedbackTextTest, WhileLostTheLineSaysWhereTrackingWorked) {
  Feedback feedback;
  feedback.tracking_state = TrackingState::kLost;
  feedback.advice = {Advice::kGoBackToRelocalise};
  feedback.advice_reason = "tracking is lost: return to where it worked";
  feedback.T_world_depth_next = MakeTransform({0.5, 0.59, -0.11}, Eigen::Quaterniond::Identity());
  EXPECT_EQ(FeedbackText(feedback),
            "go back (tracking is lost: return to where it worked), LOST, it worked at (0.50 0.59 "
            "-0.11) m looking (0.00 0.00 1.00)");
}

TEST(FeedbackReporterTest, TellsChangesOfStateOnly) {
  FeedbackReporter reporter;
  Feedback feedback;
  feedback.tracking_state = TrackingState::kTracked;
  EXPECT_TRUE(reporter.Report(feedback).has_value());
  feedback.view.good = 0.7F;
  feedback.advice_reason = "other numbers";
  EXPECT_FALSE(reporter.Report(feedback).has_value());
  feedback.advice = {Advice::kSlower};
  EXPECT_THAT(reporter.Report(feedback).value_or(""), HasSubstr("slower"));
  EXPECT_FALSE(reporter.Report(feedback).has_value());
  feedback.tracking_state = TrackingState::kLost;
  EXPECT_THAT(reporter.Report(feedback).value_or(""), HasSubstr("LOST"));
  feedback.done = true;
  EXPECT_TRUE(reporter.Report(feedback).has_value());
}

std::string ReadAll(const std::filesystem::path& path) {
  std::ostringstream text;
  text << std::ifstream(path).rdbuf();
  return text.str();
}

std::span<const std::uint8_t> Bytes(std::string_view text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

TEST(ImageFileTest, TheNewestReplacesTheOneBefore) {
  const testing::TemporaryDirectory folder;
  const auto path = folder.path() / "confidence.png";
  ASSERT_TRUE(ReplaceFile(path, Bytes("first image")).ok());
  ASSERT_TRUE(ReplaceFile(path, Bytes("second")).ok());
  EXPECT_EQ(ReadAll(path), "second");
  EXPECT_FALSE(std::filesystem::exists(path.string() + ".partial"));
}

TEST(ImageFileTest, F65ALinkInItsPlaceIsNotFollowed) {
  const testing::TemporaryDirectory folder;
  const auto path = folder.path() / "confidence.png", victim = folder.path() / "victim";
  std::ofstream(victim) << "precious";
  std::filesystem::create_symlink(victim, path.string() + ".partial");
  EXPECT_FALSE(ReplaceFile(path, Bytes("image")).ok());
  EXPECT_EQ(ReadAll(victim), "precious");
  std::filesystem::remove(path.string() + ".partial");
  std::filesystem::create_symlink(victim, path);
  EXPECT_TRUE(ReplaceFile(path, Bytes("image")).ok()) << "the link itself is replaced";
  EXPECT_EQ(ReadAll(victim), "precious");
  EXPECT_EQ(ReadAll(path), "image");
}

TEST(ImageFileTest, WhatCannotBeWrittenLeavesTheOldOneAndIsSaid) {
  const testing::TemporaryDirectory folder;
  const auto path = folder.path() / "confidence.png";
  ASSERT_TRUE(ReplaceFile(path, Bytes("first")).ok());
  std::filesystem::create_directory(path.string() + ".partial");  // In the way.
  EXPECT_FALSE(ReplaceFile(path, Bytes("second")).ok());
  EXPECT_EQ(ReadAll(path), "first");
  const Status status = ReplaceFile(folder.path() / "no" / "folder.png", Bytes("x"));
  EXPECT_THAT(status.message(), HasSubstr("folder.png"));
}

}  // namespace
}  // namespace isotherm
