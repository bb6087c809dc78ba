#include "ground/service/status_reporter.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace isotherm {
namespace {

using std::chrono::seconds;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

constexpr std::size_t kColumns = 79;  // A terminal has 80; a full line would wrap.

GroundSituation Scanning() {
  GroundSituation situation;
  situation.link.edge_present = true;
  situation.link.counters.session = 1;
  situation.link.counters.depth = {.published = 10, .received = 9, .missing = 1};
  Feedback feedback;
  feedback.tracking_state = TrackingState::kTracked;
  feedback.view.good = 0.55F;
  feedback.model.good = 0.22F;
  feedback.covered_area_m2 = 0.84;
  feedback.advice = {Advice::kMoveCloser};
  feedback.advice_reason = "40 % of the surface is farther than 0.60 m";
  situation.feedback = feedback;
  return situation;
}

std::string Narrow(const GroundSituation& situation) {
  return FitLine(StatusParts(situation), " | ", kColumns);
}

TEST(StatusReporterTest, BeforeAScanItSaysWhatIsWaitedFor) {
  GroundSituation situation;
  EXPECT_EQ(StatusText(situation), "waiting for a rig");
  situation.link.edge_present = true;
  EXPECT_EQ(StatusText(situation), "rig found, no scan yet");
}

TEST(StatusReporterTest, AdviceComesFirstThenTrackingCoverageAndFrames) {
  EXPECT_THAT(
      StatusText(Scanning()),
      StartsWith("closer (40 % of the surface is farther than 0.60 m) | tracked | view 55 % "
                 "good | all 22 % of 0.84 m2 | received 9 of 10 depth, 0 of 0 thermal"));
  EXPECT_EQ(Narrow(Scanning()),
            "closer (40 % of the surface is farther than 0.60 m) | tracked | view 55 % good");
}

TEST(StatusReporterTest, TheLongestAdviceIsNotCutAt80Columns) {
  GroundSituation situation = Scanning();
  situation.feedback->advice = {Advice::kMoreOblique};
  situation.feedback->advice_reason =
      "55 % of the surface is seen at less than 10 deg and reflects you";
  EXPECT_EQ(Narrow(situation),
            "more oblique (55 % of the surface is seen at less than 10 deg and reflects you)");
}

TEST(StatusReporterTest, F48WorkThatWasLeftOutIsSaidWithWhatToDo) {
  GroundSituation situation = Scanning();
  situation.behind = {.now = true, .thermal_frames = 764, .depth_frames = 0};
  EXPECT_EQ(Narrow(situation),
            "closer | BEHIND 764 | 40 % of the surface is farther than 0.60 m | tracked");
  EXPECT_THAT(StatusText(situation),
              HasSubstr("reconstruct scan.mcap again: 764 thermal frames were left out"));
}

TEST(StatusReporterTest, F41TheRigsDiskIsSaidWhenItIsLowOrFull) {
  GroundSituation situation = Scanning();
  situation.edge = EdgeStatus();
  EXPECT_THAT(StatusText(situation), Not(HasSubstr("disk"))) << "it does not say";
  situation.edge->disk_free_bytes = 4'100'000'000;
  EXPECT_THAT(StatusText(situation), Not(HasSubstr("disk")));
  situation.edge->disk_free_bytes = 3'240'000'000;
  EXPECT_THAT(StatusText(situation), HasSubstr(" | rig's disk low, 3.2 GB left"));
  situation.edge->disk_free_bytes = 1;  // None.
  EXPECT_THAT(Narrow(situation), HasSubstr(" | RIG'S DISK FULL, 0.0 GB"));
}

TEST(StatusReporterTest, F42AStuckDiskAndWhatTheRecordingLacksAreSaid) {
  GroundSituation situation = Scanning();
  situation.recording_at_it = seconds(12);
  situation.recording.depth_left_out[NotRecorded::kDiskTooSlow] = 30;
  situation.recording.thermal_left_out[NotRecorded::kDiskTooSlow] = 40;
  EXPECT_THAT(StatusText(situation),
              HasSubstr(" | DISK STUCK for 12 s | RECORDING LACKS 70 frames"));
  situation.problem = "the recording has not gone on for 61 s";
  EXPECT_THAT(StatusText(situation),
              StartsWith("STUCK: the recording has not gone on for 61 s | "));
}

TEST(StatusReporterTest, F42ResultsThatAreLostAreSaid) {
  GroundSituation situation = Scanning();
  EXPECT_THAT(StatusText(situation), Not(HasSubstr("RESULTS")));
  situation.scans_given_up = 2;
  EXPECT_THAT(StatusText(situation), HasSubstr(" | RESULTS OF 2 SCANS LOST"));
}

TEST(StatusReporterTest, F41TheDiskLastsSoLong) {
  GroundSituation situation = Scanning();
  RecordingProgress& recording = situation.recording;
  EXPECT_THAT(StatusText(situation), Not(HasSubstr("disk")));
  recording.path = "scan.mcap";
  recording.free_bytes = 54'100'000'000;
  recording.reserve_bytes = 100'000'000;
  recording.bytes_per_s = 5e6;
  EXPECT_THAT(StatusText(situation), HasSubstr(" | disk: 3 h left"));
  recording.free_bytes = 400'000'000;
  EXPECT_THAT(StatusText(situation), HasSubstr(" | disk: 1 min left"));
  recording.free_bytes = 50'000'000;
  EXPECT_THAT(StatusText(situation), HasSubstr(" | disk: 0 min left"));
}

TEST(StatusReporterTest, F43ARecordingThatPausesSaysSoAndThatGoesOnWhatItLacks) {
  GroundSituation situation = Scanning();
  RecordingProgress& recording = situation.recording;
  recording.status = ResourceExhausted("full");
  recording.paused = true;
  recording.depth_left_out[NotRecorded::kDiskFailed] = 7;
  EXPECT_THAT(StatusText(situation), HasSubstr(" | NOT RECORDING | RECORDING LACKS 7 frames"));
  recording.paused = false;
  EXPECT_THAT(StatusText(situation),
              AllOf(HasSubstr(" | RECORDING LACKS 7 frames"), Not(HasSubstr("NOT RECORDING"))));
}

TEST(StatusReporterTest, F31AMissingOutputFolderIsSaidBeforeAScanToo) {
  GroundSituation situation;
  situation.folder_problem = "creating the output folder /media/disk: Read-only file system";
  EXPECT_EQ(StatusText(situation),
            "waiting for a rig | NO OUTPUT FOLDER: creating the output folder /media/disk: "
            "Read-only file system");
}

TEST(StatusReporterTest, ACalibrationThatHasMovedIsSaid) {
  GroundSituation situation;
  situation.moved_calibration =
      "the thermal camera is not as it was calibrated (pose moved by 1.2 px)";
  EXPECT_THAT(StatusText(situation), HasSubstr("CALIBRATION: the thermal camera is not as"));
}

TEST(StatusReporterTest, F28AdviceThatIsOldWhenItArrivesIsSaid) {
  GroundSituation situation = Scanning();
  situation.edge = EdgeStatus();
  situation.edge->feedback = {.count = 100, .p50_s = 0.1, .p99_s = 3.0};
  EXPECT_THAT(StatusText(situation), Not(HasSubstr(" old")));
  situation.edge->feedback.p50_s = 2.322;
  EXPECT_THAT(StatusText(situation), HasSubstr(" | advice is 2.3 s old when it reaches the rig"));
}

TEST(StatusReporterTest, F25WhatIsStillToComeIsSaid) {
  GroundSituation situation = Scanning();
  situation.edge.emplace().spool_frames = 100;
  EXPECT_THAT(StatusText(situation), Not(HasSubstr("to come")));
  EXPECT_THAT(StatusText(situation), HasSubstr(" | link good | received"));
  situation.edge->spool_frames = 1180;
  EXPECT_THAT(StatusText(situation), HasSubstr("to come from the rig's recording: 1180 frames |"));
  situation.edge->scan_state = ScanState::kScanning;
  situation.edge->depth.rate_hz = 29.5;
  situation.edge->thermal.rate_hz = 39.9;
  EXPECT_THAT(StatusText(situation), HasSubstr("recording: 1180 frames of 17 s |"));
  situation.edge->spool_bytes = 96'400'000;
  EXPECT_THAT(StatusText(situation), Not(HasSubstr("too narrow")));
  situation.edge->depth.dropped = {{"left for later", 700}};
  EXPECT_THAT(StatusText(situation),
              HasSubstr("recording: 1180 frames of 17 s, 96 MB (link too narrow) |"));
  EXPECT_THAT(StatusText(situation), Not(HasSubstr("DELETED")));
  situation.edge->frames_gone = 31;
  EXPECT_THAT(
      StatusText(situation),
      HasSubstr(" (link too narrow), THE RIG HAS DELETED 31 frames that did not arrive | "));
  situation.edge->spool_frames = 0;
  EXPECT_THAT(StatusText(situation), HasSubstr(" | THE RIG HAS DELETED 31 frames that did"));
}

TEST(StatusReporterTest, WhatTheRigDroppedItselfIsSaid) {
  GroundSituation situation = Scanning();
  situation.edge = EdgeStatus();
  situation.edge->depth.dropped = {{"queue full", 5}, {"rejected", 2}};
  situation.edge->thermal.dropped = {{"queue full", 3}};
  EXPECT_THAT(StatusText(situation), HasSubstr(" | dropped by the rig 10"));
}

TEST(StatusReporterTest, F25ALostRigIsSaidWithHowLongAndWhetherItRecords) {
  GroundSituation situation = Scanning();
  situation.link.edge_present = false;
  situation.rig_lost_for = std::chrono::seconds(12);
  EXPECT_THAT(StatusText(situation), StartsWith("RIG LOST for 12 s, and it does not record | clo"));
  situation.edge.emplace().spool_fill_ratio = 0.1;
  EXPECT_THAT(StatusText(situation),
              StartsWith("RIG LOST for 12 s, it records: nothing is lost | closer"));
  EXPECT_THAT(StatusText(situation), Not(HasSubstr("link good")));
  situation.edge->spool_keeps_s = 11.2;
  EXPECT_THAT(StatusText(situation), StartsWith("RIG LOST for 12 s, it keeps the newest 11 s | c"));
  situation.edge->spool_keeps_s = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(StatusText(situation), StartsWith("RIG LOST for 12 s, it keeps the newest only | c"));
}

TEST(StatusReporterTest, F32AModelThatIsMadeAnewSaysHowFarItIs) {
  GroundSituation situation = Scanning();
  situation.rebuilt_fraction = 0.4;
  EXPECT_THAT(StatusText(situation),
              StartsWith("making the model anew of its recording, 40 % | received 9"));
}

}  // namespace
}  // namespace isotherm
