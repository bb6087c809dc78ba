#include "edge/pipeline/feedback_monitor.h"

#include <gtest/gtest.h>

#include <cmath>

namespace isotherm {
namespace {

using namespace std::chrono_literals;

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
  EXPECT_EQ(monitor.age(feedback.capture_time + 3s), 3s) << "it grows while none comes";
}

TEST(FeedbackMonitorTest, WhatIsAboutAFrameOfTheRecordingTellsNotHowSoonAdviceArrives) {
  FeedbackMonitor monitor(TimeBase::kWallClock);
  Feedback feedback;
  feedback.capture_time = CaptureTime(1h);
  monitor.Add(feedback, feedback.capture_time + 50ms);
  monitor.Add(feedback, feedback.capture_time + 70s, /*is_live=*/false);
  EXPECT_EQ(monitor.latency().count, 2U);
  EXPECT_NEAR(monitor.latency().p99_s, 0.050, 0.050 * kRelativeTolerance);
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
  EXPECT_EQ(monitor.age(CaptureTime(1h + 2s)), 2s);
}

TEST(FeedbackMonitorTest, TimesAtAnotherPaceHaveNoAge) {
  FeedbackMonitor monitor(TimeBase::kOther);
  monitor.NoteCapture({}, CaptureTime(1h));
  monitor.Add({}, CaptureTime(1h));
  EXPECT_EQ(monitor.latency().count, 1U);
  EXPECT_TRUE(std::isnan(monitor.latency().p50_s));
  EXPECT_EQ(monitor.age(CaptureTime(1h)), std::nullopt);
}

}  // namespace
}  // namespace isotherm
