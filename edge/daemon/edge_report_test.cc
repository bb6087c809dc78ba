#include "edge/daemon/edge_report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>

#include "common/base/terminal_line.h"
#include "edge/frame_counters/frame_counters.h"

namespace isotherm {
namespace {

using std::chrono::seconds;
using testing::EndsWith;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

class EdgeReportTest : public testing::Test {
 protected:
  void Count(Sensor sensor, FrameFate fate, std::uint64_t count) {
    counters_.Set(sensor, fate, count);
  }
  /// The line of the journal, with the ground there or not and what it says.
  std::string Line(const EdgeStatus& status, const std::optional<Feedback>& feedback = std::nullopt,
                   bool ground_present = true, const std::string& ground_problem = {}) const {
    EdgeSituation situation = Situation(status, feedback);
    situation.ground_present = ground_present;
    situation.ground_problem = ground_problem;
    return StatusLine(situation);
  }
  EdgeSituation Situation(const EdgeStatus& status, const std::optional<Feedback>& feedback) const {
    return {.status = status,
            .depth = counters_.Get(Sensor::kDepth),
            .thermal = counters_.Get(Sensor::kThermal),
            .ground_present = true,
            .feedback = feedback,
            .feedback_age = std::nullopt};
  }
  /// A scan that goes well, with the advice of the ground.
  EdgeSituation Scanning() {
    for (const Sensor sensor : {Sensor::kDepth, Sensor::kThermal}) {
      Count(sensor, FrameFate::kRecorded, 900);
      Count(sensor, FrameFate::kPublished, 900);
    }
    EdgeStatus status;
    status.scan_state = ScanState::kScanning;
    status.depth.rate_hz = 30.0;
    status.thermal.rate_hz = 40.0;
    Feedback feedback;
    feedback.tracking_state = TrackingState::kTracked;
    feedback.view.good = 0.55F;
    feedback.model.good = 0.22F;
    feedback.covered_area_m2 = 0.84;
    feedback.advice = {Advice::kMoveCloser};
    feedback.advice_reason = "40 % of the surface is farther than 0.60 m";
    return Situation(status, feedback);
  }
  static std::string Narrow(const EdgeSituation& situation) {
    constexpr std::size_t kColumns = 79;  // A terminal has 80; a full line would wrap.
    return FitLine(StatusParts(situation), "  ", kColumns);
  }
  FrameCounters counters_;
};

TEST_F(EdgeReportTest, TheCountersBalanceWhenEachFrameHasItsFate) {
  Count(Sensor::kDepth, FrameFate::kCaptured, 10);
  Count(Sensor::kDepth, FrameFate::kRejected, 1);
  Count(Sensor::kDepth, FrameFate::kRecorded, 6);
  Count(Sensor::kDepth, FrameFate::kRecordFailed, 3);
  Count(Sensor::kDepth, FrameFate::kPublished, 7);
  Count(Sensor::kDepth, FrameFate::kPublishQueueFull, 1);
  EXPECT_EQ(counters_.Get(Sensor::kDepth).OnTheWayToDisk(), 0);
  EXPECT_EQ(counters_.Get(Sensor::kDepth).OnTheWayToGround(), 1);
}

TEST_F(EdgeReportTest, SummaryIsTheCountersAsAnEquation) {
  Count(Sensor::kDepth, FrameFate::kCaptured, 10);
  Count(Sensor::kDepth, FrameFate::kRecorded, 8);
  Count(Sensor::kDepth, FrameFate::kRecordQueueFull, 2);
  Count(Sensor::kDepth, FrameFate::kPublished, 10);
  const std::string text = Summary(counters_, true, std::nullopt, {});
  EXPECT_THAT(text, HasSubstr("captured 10 = recorded 8 + rejected 0 + queue full 2 + failed 0\n"));
  EXPECT_THAT(text,
              HasSubstr("captured 10 = published 10 + rejected 0 + queue full 0 + failed 0\n"));
  EXPECT_THAT(text, Not(HasSubstr("unaccounted")));
}

TEST_F(EdgeReportTest, FramesThatTheCamerasProcessLeftOutAreCapturedAndDropped) {
  Count(Sensor::kDepth, FrameFate::kCaptured, 10);
  Count(Sensor::kDepth, FrameFate::kLeftOut, 3);
  Count(Sensor::kDepth, FrameFate::kRecorded, 7);
  Count(Sensor::kDepth, FrameFate::kPublished, 7);
  Count(Sensor::kDepth, FrameFate::kLostInCamera, 4);
  const SensorCounters depth = counters_.Get(Sensor::kDepth);
  EXPECT_EQ(depth.OnTheWayToDisk(), 0);
  EXPECT_EQ(depth.OnTheWayToGround(), 0);
  const std::string text = Summary(counters_, true, std::nullopt, {});
  EXPECT_THAT(text, HasSubstr("captured 10 = recorded 7 + rejected 0 + queue full 0 + failed 0 + "
                              "no free slot in the camera's process 3\n"));
  EXPECT_THAT(text, HasSubstr("depth    lost in the camera or its library 4\n"));
  EXPECT_THAT(text, Not(HasSubstr("unaccounted")));
  const std::vector<DropCount> dropped = ToStreamStatus(depth, 30.0).dropped;
  EXPECT_TRUE(std::ranges::any_of(dropped, [](const auto& drop) {
    return drop.reason == "no free slot in the camera's process" && drop.frames == 3;
  }));
}

TEST_F(EdgeReportTest, SummarySaysWhatTheGroundHasOfWhatLeftTheRig) {
  Count(Sensor::kDepth, FrameFate::kCaptured, 13);
  Count(Sensor::kDepth, FrameFate::kPublishQueueFull, 3);
  Count(Sensor::kDepth, FrameFate::kPublished, 10);
  Receipt receipt;
  receipt.depth = {.next = 13, .handled = 13, .received = 9};
  EXPECT_THAT(Summary(counters_, false, receipt, {}),
              HasSubstr("depth    ground received 9 of 10 published\n"));
}

TEST_F(EdgeReportTest, SummarySaysHowSoonTheGroundAnswered) {
  EXPECT_THAT(
      Summary(counters_, false, std::nullopt, {.count = 12, .p50_s = 0.048, .p99_s = 0.0924}),
      HasSubstr("feedback 12 messages, depth capture to arrival p50 48 ms, p99 92 ms\n"));
  EXPECT_THAT(Summary(counters_, false, std::nullopt, {}), HasSubstr("arrival unknown"));
}

TEST_F(EdgeReportTest, F08TheStatusLineShowsTheDutyCycleOfAStorm) {
  EdgeStatus status;
  status.nuc.state = NucState::kError;
  status.nuc.reason = "shutter closed for 7 s";
  EXPECT_THAT(Line(status), HasSubstr("NUC error (shutter closed for 7 s)  recorded"));
  status.nuc = {
      .state = NucState::kIdle, .closings_per_minute = 9, .closed_fraction = 0.41, .storm = true};
  EXPECT_THAT(Line(status), HasSubstr("NUC idle, STORM: 9/min, 41 % closed"));
}

TEST_F(EdgeReportTest, CountersThatDoNotBalanceAreNotHidden) {
  Count(Sensor::kThermal, FrameFate::kCaptured, 5);
  Count(Sensor::kThermal, FrameFate::kPublished, 4);
  EXPECT_THAT(Summary(counters_, false, std::nullopt, {}), HasSubstr("unaccounted 1"));
}

TEST_F(EdgeReportTest, StreamStatusAddsUp) {
  Count(Sensor::kDepth, FrameFate::kCaptured, 20);
  Count(Sensor::kDepth, FrameFate::kRejected, 2);
  Count(Sensor::kDepth, FrameFate::kPublishQueueFull, 3);
  Count(Sensor::kDepth, FrameFate::kPublished, 11);
  const StreamStatus status = ToStreamStatus(counters_.Get(Sensor::kDepth), 30.0);
  std::uint64_t dropped = 0;
  for (const DropCount& drop : status.dropped) dropped += drop.frames;
  EXPECT_EQ(status.captured, status.published + dropped + status.queue_frames);
}

TEST_F(EdgeReportTest, StatusLineShowsTheGroundsAdvice) {
  Feedback feedback;
  feedback.tracking_state = TrackingState::kLost;
  feedback.model.good = 0.34F;
  feedback.covered_area_m2 = 0.5;
  feedback.advice = {Advice::kGoBackToRelocalise};
  EXPECT_THAT(Line({}, feedback), HasSubstr("ground: go back, LOST, all 34 % of 0.50 m2"));
  feedback.tracking_state = TrackingState::kDegraded;
  feedback.pose_covariance = 1e-6 * PoseCovariance::Identity();
  EXPECT_THAT(Line({}, feedback), HasSubstr("degraded within 1.0 mm 0.06 deg, all 34 %"));
  EXPECT_THAT(Line({}, feedback, false), HasSubstr("ground: absent"));
  EdgeSituation lost = Situation({}, feedback);
  lost.ground_present = false;
  lost.receipt_age = std::chrono::milliseconds(12'300);
  EXPECT_THAT(StatusLine(lost), HasSubstr("ground: absent")) << "the scan is over";
  lost.status.scan_state = ScanState::kScanning;
  EXPECT_THAT(StatusLine(lost), HasSubstr("ground: LOST for 12 s, and there is no recording"));
  lost.status.spool_fill_ratio = 0.0;
  EXPECT_THAT(StatusLine(lost), HasSubstr("ground: LOST for 12 s, what it lacks is recorded"));
  lost.status.spool_keeps_s = 11.2;
  EXPECT_THAT(StatusLine(lost), HasSubstr("ground: LOST for 12 s, the newest 11 s are kept"));
  EXPECT_THAT(Line({}, feedback, true, "refuses this scan"),
              HasSubstr("ground: refuses this scan |"));
  EXPECT_THAT(Line({}), HasSubstr("no feedback yet"));
}

TEST_F(EdgeReportTest, On80ColumnsTheAdviceComesFirstAndIsWhole) {
  EdgeSituation situation = Scanning();
  EXPECT_EQ(Narrow(situation),
            "closer (40 % of the surface is farther than 0.60 m)  tracked  view 55 % good");
  situation.feedback->advice = {Advice::kMoreOblique};
  situation.feedback->advice_reason =
      "55 % of the surface is seen at less than 10 deg and reflects you";
  EXPECT_EQ(Narrow(situation),
            "more oblique (55 % of the surface is seen at less than 10 deg and reflects you)");
}

TEST_F(EdgeReportTest, F48On80ColumnsThatTheGroundIsBehindAndWhatToDoAreNotCut) {
  EdgeSituation situation = Scanning();
  situation.feedback->frames_left_out = 764;
  EXPECT_EQ(Narrow(situation),
            "closer  ground BEHIND 764: reconstruct its scan.mcap again  tracked  30+40/s");
  EXPECT_THAT(StatusLine(situation),
              HasSubstr("ground BEHIND 764: reconstruct its scan.mcap again, 40 % of the surface"));
}

TEST_F(EdgeReportTest, F41On80ColumnsWhatIsWrongHereStandsBehindTheAdvice) {
  EdgeSituation situation = Scanning();
  situation.problems = {"NOT RECORDING, disk full"};
  situation.status.depth_camera.state = CameraState::kLost;
  Count(Sensor::kDepth, FrameFate::kRecordQueueFull, 7);
  situation.depth = counters_.Get(Sensor::kDepth);
  EXPECT_EQ(Narrow(situation),
            "closer  NOT RECORDING, disk full  depth (camera lost)  dropped 7  tracked");
  situation.ground_present = false;
  EXPECT_EQ(Narrow(situation),
            "ground: absent  NOT RECORDING, disk full  depth (camera lost)  dropped 7");
}

TEST_F(EdgeReportTest, F28OldAdviceIsSaid) {
  EdgeSituation situation = Scanning();
  situation.feedback_age = std::chrono::milliseconds(400);
  EXPECT_THAT(StatusLine(situation), Not(HasSubstr("OLD")));
  situation.feedback_age = std::chrono::milliseconds(2322);
  EXPECT_THAT(Narrow(situation), StartsWith("closer  advice 2.3 s OLD  40 % of the surface"));
  EXPECT_THAT(StatusLine(situation), HasSubstr(", advice 2.3 s OLD | depth"));
  situation.status.scan_state = ScanState::kEnded;
  EXPECT_THAT(StatusLine(situation), Not(HasSubstr("OLD"))) << "nobody waits for any";
}

TEST_F(EdgeReportTest, F25WhatTheGroundLacksIsSaidOnceItIsMoreThanUsual) {
  EdgeSituation situation = Scanning();
  situation.status.spool_frames = 100;
  EXPECT_THAT(StatusLine(situation), Not(HasSubstr("lacks")));
  situation.status.spool_frames = 640;
  EXPECT_THAT(StatusLine(situation), HasSubstr("ground lacks 640 frames"));
  EXPECT_THAT(Narrow(situation), HasSubstr("ground lacks 640 frames"));
  EXPECT_THAT(StatusLine(situation), Not(HasSubstr("too narrow")));
  situation.status.frames_gone = 31;
  EXPECT_THAT(StatusLine(situation),
              HasSubstr("ground lacks 640 frames of 9 s, 31 frames DELETED that it does not have"));
  situation.status.spool_frames = 0;
  EXPECT_THAT(Narrow(situation), HasSubstr("  31 frames DELETED"));
}

TEST_F(EdgeReportTest, F28FramesThatAreLeftForLaterAreCountedAndTheReasonIsSaid) {
  Count(Sensor::kDepth, FrameFate::kCaptured, 1000);
  Count(Sensor::kDepth, FrameFate::kPublished, 360);
  Count(Sensor::kDepth, FrameFate::kLeftForLater, 640);
  EXPECT_THAT(Summary(counters_, false, std::nullopt, {}),
              HasSubstr("captured 1000 = published 360 + rejected 0 + queue full 0 + failed 0 + "
                        "left for later 640\n"));
  EdgeSituation situation = Scanning();
  situation.status.depth = ToStreamStatus(counters_.Get(Sensor::kDepth), 30.0);
  situation.status.spool_frames = 640;
  EXPECT_THAT(StatusLine(situation), HasSubstr("ground lacks 640 frames of 9 s (link too narrow)"));
}

TEST_F(EdgeReportTest, F41HowLongTheDiskLastsIsSaidWhileAllIsWell) {
  EdgeSituation situation = Scanning();
  EXPECT_THAT(StatusLine(situation), Not(HasSubstr("disk")));
  situation.disk_left_s = 3.0 * 3600.0;
  EXPECT_THAT(StatusLine(situation), EndsWith("  disk: 3 h left"));
  situation.feedback = std::nullopt;
  EXPECT_EQ(Narrow(situation),
            "ground: no feedback yet  30+40/s  disk: 3 h left  NUC unknown  recorded 1800");
}

TEST_F(EdgeReportTest, F17TheStatusLineSaysWhetherTheClockIsSynchronised) {
  EdgeStatus status;
  EXPECT_THAT(Line(status), HasSubstr("clock not synchronised"));
  HostStatus host;
  host.clock = {
      .synchronised = true, .offset_s = 0.0, .estimated_error_s = 0.0001, .max_error_s = 0.0012};
  AddHostStatus(host, status);
  status.clock.steps = 2;
  status.clock.step_sum_s = 3.02;
  status.depth_camera.stamp_sigma_s = 0.00005;
  status.thermal_camera.unsynchronised_frames = 7;
  EXPECT_THAT(
      Line(status),
      HasSubstr("clock synchronised, off by about 0.10 ms, at most 1.2 ms, set 2 times by "
                "+3.020 s in all  stamps +-0.050 ms depth, UNSYNCHRONISED frames 0 depth, 7 "
                "thermal"));
}

TEST_F(EdgeReportTest, F17WhatIsWrongWithTheClockIsSaidWithWhatToDo) {
  const auto unsynchronised = ClockProblem({});
  ASSERT_TRUE(unsynchronised.has_value());
  EXPECT_THAT(*unsynchronised, HasSubstr("not synchronised"));
  EXPECT_THAT(*unsynchronised, HasSubstr("chrony"));
  EXPECT_THAT(*unsynchronised, HasSubstr("docs/timing.md"));
  KernelClock clock{
      .synchronised = true, .offset_s = -0.02, .estimated_error_s = 0.001, .max_error_s = 0.4};
  EXPECT_EQ(ClockProblem(clock), std::nullopt) << "a wide bound alone is no error";
  clock.estimated_error_s = 0.06;
  EXPECT_THAT(ClockProblem(clock).value_or(""), HasSubstr("off by about 60 ms"));
  clock = {.synchronised = true, .offset_s = -0.08, .estimated_error_s = 0.001};
  EXPECT_THAT(ClockProblem(clock).value_or(""), HasSubstr("off by about 80 ms"));
}

TEST_F(EdgeReportTest, F17TheRecordingSaysThatTheClockWasNotSynchronised) {
  EXPECT_EQ(ClockMetadata({}, TimeBase::kWallClock).at("synchronised"), "no");
  const KernelClock clock{
      .synchronised = true, .offset_s = 0.0, .estimated_error_s = 0.0001, .max_error_s = 0.0012};
  const auto metadata = ClockMetadata(clock, TimeBase::kWallClock);
  EXPECT_EQ(metadata.at("synchronised"), "yes");
  EXPECT_EQ(metadata.at("estimated_error_s"), "0.0001");
  EXPECT_EQ(metadata.at("max_error_s"), "0.0012");
  EXPECT_FALSE(ClockMetadata({}, TimeBase::kShifted).contains("synchronised"))
      << "a replay with its own times does not depend on this clock";
}

TEST(RateMeterTest, CountsPerSecond) {
  RateMeter meter;
  const SteadyTime start{seconds(100)};
  EXPECT_EQ(meter.Update(7, start), 0.0);
  EXPECT_DOUBLE_EQ(meter.Update(67, start + seconds(2)), 30.0);
  EXPECT_EQ(meter.Update(80, start + seconds(2)), 0.0) << "no time has passed";
}

}  // namespace
}  // namespace isotherm
