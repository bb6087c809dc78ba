#include "ground/cli/recording_summary.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "ground/cli/frame_rendering.h"
#include "ground/cli/numbers.h"
#include "ground/cli/recording_report.h"
#include "ground/evaluation/true_poses.h"

namespace isotherm {
namespace {

using std::chrono::milliseconds;
using testing::HasSubstr;

CaptureTime Time(int ms) { return CaptureTime(milliseconds(ms)); }

RecordedDepth Depth(std::uint64_t number, int ms, std::uint8_t content = 0) {
  RecordedDepth depth;
  depth.frame.header.session = 1;
  depth.frame.header.frame_number = number;
  depth.frame.header.capture_time = Time(ms);
  depth.frame.image = {Encoding::kRaw16, 2, 1, {static_cast<std::uint8_t>(number), content, 0, 0}};
  return depth;
}

RecordedThermal Thermal(std::uint64_t number, int ms, NucState state) {
  RecordedThermal thermal;
  thermal.frame.header.session = 1;
  thermal.frame.header.frame_number = number;
  thermal.frame.header.capture_time = Time(ms);
  thermal.frame.image = {Encoding::kThermalRans, 4, 1, {static_cast<std::uint8_t>(number)}};
  thermal.frame.nuc_state = state;
  thermal.frame.valid = state == NucState::kIdle;
  return thermal;
}

RecordingSummary Summarized(const std::vector<RecordedItem>& items) {
  RecordingSummarizer summarizer;
  for (const RecordedItem& item : items) summarizer.Add(item);
  return summarizer.Finish();
}

TEST(RecordingSummaryTest, HolesDuplicatesAndGapsAreCounted) {
  // Numbers 3 and 4 are missing, 7 is there twice, 9 comes before 8.
  std::vector<RecordedItem> items;
  for (const int number : {0, 1, 2, 5, 6, 7, 7, 9, 8, 10})
    items.emplace_back(Depth(number, 100 + 10 * number));
  const StreamSummary depth = Summarized(items).depth;
  EXPECT_EQ(depth.frames, 10U);
  EXPECT_EQ(depth.missing, 2U);
  EXPECT_EQ(depth.holes, 1U);
  EXPECT_EQ(depth.duplicates, 1U);
  EXPECT_EQ(depth.repeats, 1U);
  EXPECT_EQ(depth.out_of_order, 1U);
  EXPECT_EQ(depth.gaps, 1U);
  EXPECT_NEAR(depth.longest_gap_s, 0.030, 1e-9);
  EXPECT_EQ(depth.longest_gap_at, Time(120));
  EXPECT_NEAR(depth.rate_hz(), 100.0, 1e-6);
  EXPECT_EQ(depth.first, Time(100));
  EXPECT_EQ(depth.last, Time(200));
}

TEST(RecordingSummaryTest, ARecordingMayStartInTheMiddleAndHaveSeveralSessions) {
  std::vector<RecordedItem> items{Depth(70, 0), Depth(71, 10)};
  RecordedDepth later = Depth(0, 20);
  later.frame.header.session = 2;
  items.emplace_back(later);
  const StreamSummary depth = Summarized(items).depth;
  EXPECT_EQ(depth.missing, 0U);
  EXPECT_EQ(depth.sessions.size(), 2U);
}

TEST(RecordingSummaryTest, BytesAndEncodings) {
  const RecordingSummary summary =
      Summarized({Depth(0, 0), Depth(1, 10), Thermal(0, 5, NucState::kIdle)});
  EXPECT_EQ(summary.depth.raw_bytes, 8U);
  EXPECT_EQ(summary.depth.payload_bytes, 8U);
  EXPECT_EQ(summary.thermal.raw_bytes, 8U);
  EXPECT_EQ(summary.thermal.payload_bytes, 1U);
  EXPECT_EQ(summary.thermal.encodings.at("thermal-rans"), 1U);
}

TEST(RecordingSummaryTest, ShutterRunsAreFoundFromTheFrames) {
  using enum NucState;
  std::vector<RecordedItem> items;
  int number = 0;
  for (const NucState state : {kIdle, kInProgress, kInProgress, kSettling, kIdle, kError}) {
    items.emplace_back(Thermal(static_cast<std::uint64_t>(number), 25 * number, state));
    ++number;
  }
  const RecordingSummary summary = Summarized(items);
  EXPECT_EQ(summary.valid_thermal, 2U);
  ASSERT_EQ(summary.nuc_runs.size(), 2U);
  EXPECT_EQ(summary.nuc_runs[0].start, Time(25));
  EXPECT_EQ(summary.nuc_runs[0].end, Time(50));
  EXPECT_EQ(summary.nuc_runs[0].frames, 2U);
  EXPECT_EQ(summary.nuc_states.at("in progress"), 2U);
  EXPECT_EQ(summary.nuc_states.at("error"), 1U);
}

TEST(RecordingSummaryTest, WhatHappenedIsListedUpToALimit) {
  std::vector<RecordedItem> items(RecordingSummary::kMaxLog + 7,
                                  RecordedLog{Time(5), "warning", "nuc: storm"});
  const RecordingSummary summary = Summarized(items);
  ASSERT_EQ(summary.log.size(), RecordingSummary::kMaxLog);
  EXPECT_EQ(summary.log[0].text, "nuc: storm");
  EXPECT_EQ(summary.log_left_out, 7U);
}

TEST(RecordingSummaryTest, EmptyRecording) {
  const RecordingSummary summary = Summarized({});
  EXPECT_EQ(summary.depth.frames, 0U);
  EXPECT_EQ(summary.depth.rate_hz(), 0.0);
}

TEST(PoseAtTest, IsBetweenItsNeighbours) {
  const auto at = [](double x) { return MakeTransform({x, 0, 0}, Eigen::Quaterniond::Identity()); };
  const std::vector<StampedPose> poses{{Time(1000), at(1.0)}, {Time(1100), at(2.0)}};
  EXPECT_NEAR(PoseAt(poses, Time(1025))->translation().x(), 1.25, 1e-12);
  EXPECT_NEAR(PoseAt(poses, Time(1100))->translation().x(), 2.0, 1e-12);
  EXPECT_NEAR(PoseAt(poses, Time(960))->translation().x(), 1.0, 1e-12);
  EXPECT_NEAR(PoseAt(poses, Time(1140))->translation().x(), 2.0, 1e-12);
  EXPECT_FALSE(PoseAt(poses, Time(900)));
  EXPECT_FALSE(PoseAt(poses, Time(1200)));
  EXPECT_FALSE(PoseAt({}, Time(1000)));
}

TEST(ParseNumbersTest, TakesSpacesAndCommas) {
  EXPECT_THAT(*ParseNumbers("1 -2.5,3", {1, 3}, "--volume"), testing::ElementsAre(1.0, -2.5, 3.0));
  EXPECT_THAT(*ParseNumbers(" 0.96 ", {1, 3}, "--volume"), testing::ElementsAre(0.96));
  EXPECT_THAT(ParseNumbers("1 2", {1, 3}, "--volume").error().message(),
              HasSubstr("--volume: expected 1 or 3"));
  EXPECT_THAT(ParseNumbers("wide", {1}, "--volume").error().message(),
              HasSubstr("'wide' is not a number"));
  EXPECT_FALSE(ParseNumbers("nan", {1}, "--volume"));
  EXPECT_FALSE(ParseNumbers("", {1}, "--volume"));
}

TEST(FrameRenderingTest, HotIsRedAndColdIsBlueBesideALegend) {
  Image<std::uint16_t> centikelvin(64, 48, 30000);
  for (int y = 0; y < 48; ++y) {
    for (int x = 32; x < 64; ++x) centikelvin.At(x, y) = 31000;
  }
  centikelvin.At(0, 0) = 0;
  const RgbImage rendering = ThermalRendering(centikelvin, kCentikelvin);
  EXPECT_GT(rendering.width(), 64);
  const int top = (rendering.height() - 48) / 2;
  const Rgb8 cold = rendering.At(10, top + 20);
  const Rgb8 hot = rendering.At(50, top + 20);
  EXPECT_GT(cold.b, cold.r);
  EXPECT_GT(hot.r, hot.b);
  const Rgb8 none = rendering.At(0, top);
  EXPECT_TRUE(none.r == none.g && none.g == none.b);
}

TEST(FrameRenderingTest, AFrameWithoutAnyValueIsDrawnToo) {
  EXPECT_GT(ThermalRendering(Image<std::uint16_t>(8, 8, 0), kCentikelvin).width(), 8);
  EXPECT_GT(DepthRendering(Image<std::uint16_t>(8, 8, 65535), 1000.0).width(), 8);
}

TEST(RecordingReportTest, F15StepsOfTheClockAreShown) {
  using std::chrono::seconds;
  RecordingReport report;
  report.summary = Summarized({ClockStep{Time(1500), seconds(-3), seconds(-3)},
                               ClockStep{Time(2500), seconds(1), seconds(-2)}});
  EXPECT_THAT(ToText(report),
              HasSubstr("set by -3.000 s at 1.500000000: from there on UTC = capture "
                        "time -3.000 s"));
  EXPECT_THAT(ToText(report),
              HasSubstr("set by +1.000 s at 2.500000000: from there on UTC = capture "
                        "time -2.000 s"));
  EXPECT_THAT(JsonText(ToJson(report)), HasSubstr("\"utc_minus_capture_time_s\": -3"));
}

TEST(RecordingReportTest, F17AnUnsynchronisedClockIsShown) {
  RecordingReport report;
  EXPECT_THAT(ToText(report), testing::Not(HasSubstr("clock")));
  report.info.metadata["clock"] = {{"synchronised", "no"}};
  EXPECT_THAT(ToText(report), HasSubstr("clock         NOT SYNCHRONISED"));
  report.info.metadata["clock"] = {{"synchronised", "yes"},
                                   {"estimated_error_s", "0.0001"},
                                   {"max_error_s", "0.002"},
                                   {"minus_ground_clock_s", "0.08"},
                                   {"minus_ground_clock_uncertainty_s", "0.001"},
                                   {"alarms", "1"}};
  EXPECT_THAT(ToText(report),
              HasSubstr("synchronised, off by about 0.0001 s, at most 0.002 s; minus the ground's "
                        "0.08 s (+-0.001 s), CLOCK ALARM"));
}

}  // namespace
}  // namespace isotherm
