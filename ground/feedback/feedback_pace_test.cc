#include "ground/feedback/feedback_pace.h"

#include <gtest/gtest.h>

#include "common/base/units.h"

namespace isotherm {
namespace {

/// Frames of a rig that moves evenly, at 30 Hz unless a test says otherwise.
class FeedbackPaceTest : public ::testing::Test {
 protected:
  static constexpr double kFrame_s = 1.0 / 30.0;

  std::optional<FeedbackMoment> Frame(double time_s, bool tracked = true, bool repeated = false) {
    FrameHeader header;
    header.frame_number = number_++;
    header.capture_time = CaptureTime(FromSeconds(100.0 + time_s));
    DepthReport report;
    report.tracked = tracked;
    report.repeated = repeated;
    report.tracking.step_m = 0.01;
    report.tracking.step_rad = 0.5 * kRadPerDeg;
    pace_.Add(header, report);
    return pace_.Take();
  }

  FeedbackPace pace_{10.0};
  std::uint64_t number_ = 0;
};

TEST_F(FeedbackPaceTest, MessagesAreDueAtTheirRateWhateverTheFramesJitter) {
  int messages = 0;
  for (int i = 0; i < 300; ++i) {
    const double jitter_s = i % 2 == 0 ? 0.004 : 0.0;
    messages += Frame(i * kFrame_s + jitter_s) ? 1 : 0;
  }
  EXPECT_NEAR(messages, 100, 1);
}

TEST_F(FeedbackPaceTest, AfterAGapOneMessageIsDueNotAll) {
  EXPECT_TRUE(Frame(0.0).has_value());
  EXPECT_TRUE(Frame(3.0).has_value());
  EXPECT_FALSE(Frame(3.0 + kFrame_s).has_value());
}

TEST_F(FeedbackPaceTest, AMessageTellsTheMotionSinceTheOneBefore) {
  Frame(0.0);
  for (int i = 1; i < 3; ++i) EXPECT_FALSE(Frame(i * kFrame_s).has_value());
  const std::optional<FeedbackMoment> moment = Frame(3 * kFrame_s + 0.001);
  ASSERT_TRUE(moment.has_value());
  EXPECT_NEAR(moment->speed_m_s, 0.03 / 0.101, 1e-9);
  EXPECT_NEAR(moment->rotation_rate_deg_s, 1.5 / 0.101, 1e-9);
  EXPECT_NEAR(moment->frame_interval_s, 0.101 / 3.0, 1e-9);
}

TEST_F(FeedbackPaceTest, WhatWasNotTrackedIsNoMotion) {
  Frame(0.0);
  const std::optional<FeedbackMoment> moment = Frame(0.2, false);
  ASSERT_TRUE(moment.has_value());
  EXPECT_EQ(moment->speed_m_s, 0.0);
  EXPECT_FALSE(moment->report.tracked);
}

TEST_F(FeedbackPaceTest, ARepeatedFrameIsNoReasonForAMessage) {
  EXPECT_FALSE(Frame(0.0, true, true).has_value());
  EXPECT_TRUE(Frame(kFrame_s).has_value());
}

}  // namespace
}  // namespace isotherm
