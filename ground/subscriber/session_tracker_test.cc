#include "ground/subscriber/session_tracker.h"

#include <gtest/gtest.h>

namespace isotherm {
namespace {

using namespace std::chrono_literals;

constexpr Nanoseconds kGrace = 2s;

StreamTally Tally(std::uint64_t session, std::uint64_t received, std::uint64_t next) {
  return {.session = session,
          .next = next,
          .received = received,
          .late = 0,
          .duplicates = 0,
          .refused = {}};
}

EdgeStatus Status(std::uint64_t session, ScanState state, std::uint64_t depth,
                  std::uint64_t thermal) {
  EdgeStatus status;
  status.session = session;
  status.scan_state = state;
  status.depth.published = depth;
  status.thermal.published = thermal;
  return status;
}

class SessionTrackerTest : public ::testing::Test {
 protected:
  SessionTracker sessions_{kGrace};
  SteadyTime now_{1h};
};

TEST_F(SessionTrackerTest, WhileScanningWhatIsNotHereIsMissing) {
  sessions_.OnFrame(1, now_);
  const SessionCounters counters = sessions_.Counters(Tally(1, 8, 10), Tally(1, 5, 5));
  EXPECT_EQ(counters.depth.published, 10U);
  EXPECT_EQ(counters.depth.missing, 2U);
  EXPECT_EQ(counters.thermal.missing, 0U);
  EXPECT_FALSE(counters.ended);
  EXPECT_EQ(sessions_.TryClose(Tally(1, 8, 10), Tally(1, 5, 5), now_ + 1h), std::nullopt);
}

TEST_F(SessionTrackerTest, F19PublishedIsReceivedPlusMissingAtTheEnd) {
  sessions_.OnFrame(1, now_);
  sessions_.OnStatus(Status(1, ScanState::kEnded, 9, 5), now_);
  // Numbers up to 9 were seen, but the edge published only 9 of these 10: it dropped one itself.
  const SessionCounters counters = sessions_.Counters(Tally(1, 8, 10), Tally(1, 5, 5));
  EXPECT_TRUE(counters.ended);
  EXPECT_EQ(counters.depth.published, 9U);
  EXPECT_EQ(counters.depth.received, 8U);
  EXPECT_EQ(counters.depth.missing, 1U);
}

TEST_F(SessionTrackerTest, F28WhatTheRigDroppedItselfIsKept) {
  EdgeStatus status = Status(1, ScanState::kEnded, 1037, 5);
  status.depth.captured = 1800;
  status.depth.dropped = {{"rejected", 0}, {"queue full", 763}};
  sessions_.OnStatus(status, now_);
  const SessionCounters counters = sessions_.Counters(Tally(1, 1037, 1800), Tally(1, 5, 5));
  EXPECT_EQ(counters.depth.captured_by_rig, 1800U);
  ASSERT_EQ(counters.depth.dropped_by_rig.size(), 1U) << "what happened, not what could";
  EXPECT_EQ(counters.depth.dropped_by_rig[0].reason, "queue full");
  EXPECT_EQ(counters.depth.dropped_by_rig[0].frames, 763U);
  EXPECT_TRUE(counters.thermal.dropped_by_rig.empty());
}

TEST_F(SessionTrackerTest, StatusesSayHowSoonFeedbackArrivedAndHowMuchWasLacking) {
  EdgeStatus status = Status(1, ScanState::kScanning, 9, 5);
  status.feedback = {.count = 10, .p50_s = 0.05, .p99_s = 0.10};
  status.spool_frames = 700;
  sessions_.OnStatus(status, now_);
  status.scan_state = ScanState::kEnded;
  status.spool_frames = 0;
  status.feedback = {.count = 20, .p50_s = 0.06, .p99_s = 0.12};
  sessions_.OnStatus(status, now_);
  const SessionCounters counters = sessions_.Counters(Tally(1, 9, 9), Tally(1, 5, 5));
  EXPECT_EQ(counters.feedback.count, 20U);
  EXPECT_EQ(counters.feedback.p99_s, 0.12);
  EXPECT_EQ(counters.most_lacking, 700U) << "what was caught up with was lacking all the same";
}

TEST_F(SessionTrackerTest, MarksAreKeptOnceWhicheverStatusesArrive) {
  const ScanMark left{CaptureTimeFromNanoseconds(1), "left"};
  const ScanMark right{CaptureTimeFromNanoseconds(2), "right"};
  const ScanMark top{CaptureTimeFromNanoseconds(3), "top"};
  EdgeStatus status = Status(1, ScanState::kScanning, 9, 5);
  std::vector<ScanMark> fresh;
  for (const std::vector<ScanMark>& marks :
       {std::vector{left}, std::vector{left, right}, std::vector{right}, std::vector{top}}) {
    status.marks = marks;  // The last is of a rig that was started again.
    for (const ScanMark& mark : sessions_.OnStatus(status, now_)) fresh.push_back(mark);
  }
  EXPECT_EQ(fresh, (std::vector{left, right, top}));
  const SessionCounters counters = sessions_.Counters(Tally(1, 9, 9), Tally(1, 5, 5));
  EXPECT_EQ(counters.marks, (std::vector{left, right, top}));
}

TEST_F(SessionTrackerTest, ACompleteSessionClosesAtOnceAndOnce) {
  sessions_.OnFrame(1, now_);
  sessions_.OnStatus(Status(1, ScanState::kEnded, 10, 5), now_);
  EXPECT_EQ(sessions_.TryClose(Tally(1, 9, 10), Tally(1, 5, 5), now_), std::nullopt);
  const auto counters = sessions_.TryClose(Tally(1, 10, 10), Tally(1, 5, 5), now_);
  ASSERT_TRUE(counters.has_value());
  EXPECT_TRUE(counters->closed);
  EXPECT_EQ(counters->depth.missing + counters->thermal.missing, 0U);
  EXPECT_EQ(sessions_.TryClose(Tally(1, 10, 10), Tally(1, 5, 5), now_), std::nullopt);
  EXPECT_EQ(sessions_.oldest_open(), std::nullopt);
}

TEST_F(SessionTrackerTest, LostFramesAreGivenUpAfterTheGraceTime) {
  sessions_.OnFrame(1, now_);
  sessions_.OnStatus(Status(1, ScanState::kEnded, 10, 0), now_);
  ASSERT_EQ(sessions_.deadline(), now_ + kGrace);
  sessions_.OnStatus(Status(1, ScanState::kEnded, 10, 0), now_ + 1s);  // A repeat changes nothing.
  EXPECT_EQ(sessions_.TryClose(Tally(1, 9, 10), Tally(1, 0, 0), now_ + kGrace - 1ns), std::nullopt);
  const auto counters = sessions_.TryClose(Tally(1, 9, 10), Tally(1, 0, 0), now_ + kGrace);
  ASSERT_TRUE(counters.has_value());
  EXPECT_EQ(counters->depth.missing, 1U);
}

TEST_F(SessionTrackerTest, ASessionThatNeverEndedClosesWhenAnotherHasBegun) {
  sessions_.OnFrame(1, now_);
  sessions_.OnFrame(2, now_ + 1s);
  EXPECT_EQ(sessions_.oldest_open(), 1U);
  const auto counters = sessions_.TryClose(Tally(1, 4, 4), Tally(1, 4, 4), now_ + kGrace);
  ASSERT_TRUE(counters.has_value());
  EXPECT_FALSE(counters->ended);
  EXPECT_EQ(sessions_.oldest_open(), 2U);
  EXPECT_EQ(sessions_.newest(), 2U);
}

TEST_F(SessionTrackerTest, F33TheNumbersOfAKilledEdgeAreNotThoseOfItsSuccessor) {
  EdgeStatus killed = Status(1, ScanState::kScanning, 9, 5);
  killed.depth.captured = 12;
  killed.feedback.count = 3;
  sessions_.OnStatus(killed, now_);
  SessionClock clock;
  clock.session = 1;
  clock.alarms = 7;
  sessions_.SetClock(clock);
  EdgeStatus successor = Status(2, ScanState::kEnded, 100, 50);
  successor.depth.captured = 200;
  successor.feedback.count = 30;
  sessions_.OnStatus(successor, now_ + 1s);
  const SessionCounters first = sessions_.Counters(Tally(1, 9, 9), Tally(1, 5, 5));
  EXPECT_FALSE(first.ended);
  EXPECT_EQ(first.depth.published, 9U);
  EXPECT_EQ(first.depth.captured_by_rig, 12U);
  EXPECT_EQ(first.feedback.count, 3U);
  ASSERT_TRUE(first.clock.has_value());
  EXPECT_EQ(first.clock->alarms, 7U);
  const SessionCounters second = sessions_.Counters(Tally(2, 100, 100), Tally(2, 50, 50));
  EXPECT_TRUE(second.ended);
  EXPECT_EQ(second.depth.captured_by_rig, 200U);
  EXPECT_EQ(second.feedback.count, 30U);
  EXPECT_FALSE(second.clock.has_value());
}

TEST_F(SessionTrackerTest, AnIdleEdgeOpensNoSession) {
  sessions_.OnStatus(Status(0, ScanState::kIdle, 0, 0), now_);
  EXPECT_EQ(sessions_.newest(), std::nullopt);
}

}  // namespace
}  // namespace isotherm
