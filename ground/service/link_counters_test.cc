#include "ground/service/link_counters.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace isotherm {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

/// The disk failed, worked again, and was nearly full in the end.
RecordingProgress TwoFailures() {
  RecordingProgress progress;
  progress.path = "scan.mcap";
  progress.closed = true;
  progress.disk_error = IoError("input/output error");
  progress.status = ResourceExhausted("only 3 MB are free");
  progress.depth_left_out[NotRecorded::kDiskFailed] = 7;
  progress.depth_left_out[NotRecorded::kDiskNearlyFull] = 5;
  return progress;
}

TEST(LinkCountersTest, F43WhatTheDiskLostIsToldInTheWordsOfTheDisk) {
  EXPECT_THAT(CountersText({}, TwoFailures()),
              AllOf(HasSubstr("7 frames are not in the recording, because the disk failed: "
                              "input/output error\n"),
                    HasSubstr("5 frames are not in the recording: what was left"),
                    Not(HasSubstr("only 3 MB"))));
}

TEST(LinkCountersTest, F43StatsHaveTheNewestFailureAndTheFramesByReason) {
  Json link;
  DescribeCounters({}, TwoFailures(), link);
  EXPECT_EQ(link["recording_failed_because"], "only 3 MB are free");
  EXPECT_EQ(link["depth"]["not_recorded_by_reason"]["disk_failed"], 7);
  EXPECT_EQ(link["depth"]["not_recorded_by_reason"]["disk_nearly_full"], 5);
  EXPECT_FALSE(link["depth"]["not_recorded_by_reason"].contains("unwritable"));
  EXPECT_EQ(link["recording_failed_frames"], 7);
}

/// A narrow link: the rig's queue ran over, what left it arrived.
SessionCounters NarrowLink() {
  SessionCounters counters;
  counters.ended = true;
  counters.depth = {.published = 1037, .received = 1037};
  counters.depth.captured_by_rig = 1800;
  counters.depth.dropped_by_rig = {{"queue full", 760}, {"rejected", 3}};
  return counters;
}

TEST(LinkCountersTest, F28WhatTheRigDroppedItselfIsInTheSummaryWithItsReasons) {
  EXPECT_THAT(CountersText(NarrowLink(), {}),
              HasSubstr("link     1037 published = 1037 received + 0 missing; 0 recorded\n"
                        "         the rig dropped 763 of 1800 captured: queue full 760, rejected "
                        "3\n"));
  EXPECT_THAT(CountersText({}, {}), Not(HasSubstr("the rig dropped")));
}

TEST(LinkCountersTest, WhatWasLeftForLaterAndNeverCameIsOnTheRig) {
  SessionCounters counters = NarrowLink();
  counters.most_lacking = 763;
  counters.depth.dropped_by_rig = {{"left for later", 763}};
  EXPECT_THAT(CountersText(counters, {}), HasSubstr("isotherm merge-recordings"));
  Json link;
  DescribeCounters(counters, {}, link);
  EXPECT_EQ(link["depth"]["dropped_by_rig"]["left_for_later"], 763);
  EXPECT_EQ(link["most_lacking_frames"], 763);
}

TEST(LinkCountersTest, MarksAreInTheResultsWithTheirTimes) {
  SessionCounters counters;
  counters.marks = {{CaptureTimeFromNanoseconds(1'500'000'000), "left burner"}};
  Json link;
  DescribeCounters(counters, {}, link);
  ASSERT_EQ(link["marks"].size(), 1U);
  EXPECT_EQ(link["marks"][0]["time_s"], 1.5);
  EXPECT_EQ(link["marks"][0]["text"], "left burner");
}

TEST(LinkCountersTest, WhereWhatIsMissingIsToBeHadIsSaid) {
  RecordingProgress recording;
  recording.path = "out/scan.mcap";
  const std::string words = "isotherm merge-recordings out/scan.mcap RIG.mcap -o WHOLE.mcap\n";
  EXPECT_THAT(CountersText(NarrowLink(), recording), HasSubstr(words));
  SessionCounters outage;
  outage.thermal = {.published = 240, .received = 200, .missing = 40};
  EXPECT_THAT(CountersText(outage, recording), HasSubstr(words));
  SessionCounters whole;
  whole.thermal = {.published = 240, .received = 240};
  whole.thermal.dropped_by_rig = {{"rejected", 3}};
  EXPECT_THAT(CountersText(whole, recording), Not(HasSubstr("merge-recordings")));
}

TEST(LinkCountersTest, F28StatsHaveItToo) {
  Json link;
  DescribeCounters(NarrowLink(), {}, link);
  EXPECT_EQ(link["depth"]["captured_by_rig"], 1800);
  EXPECT_EQ(link["depth"]["dropped_by_rig"]["queue_full"], 760);
  EXPECT_FALSE(link["thermal"].contains("dropped_by_rig"));
}

}  // namespace
}  // namespace isotherm
