#include "edge/publisher/repair_watch.h"

#include <gtest/gtest.h>

#include <cstdint>

namespace isotherm {
namespace {

using namespace std::chrono_literals;

constexpr SteadyTime kStart{1000s};
constexpr Nanoseconds kInterval = 100ms;
constexpr std::size_t kBytes = 500'000;  ///< In each interval.
/// Frames have been late for long enough.
constexpr Nanoseconds kFound = RepairWatch::kOver + 2 * kInterval;

/// A link whose rig looks at it ten times a second.
class RepairWatchTest : public ::testing::Test {
 protected:
  struct Time {
    double repeated;  ///< A fraction of what the cameras take.
    bool is_late = true;
    Nanoseconds quickest = 45ms;
    bool has_receipts = true;
    bool is_sending = true;
  };
  /// Returns whether the link was found to be poor meanwhile.
  bool Pass(Nanoseconds duration, const Time& time) {
    bool found = false;
    for (const SteadyTime end = now_ + duration; now_ < end; now_ += kInterval) {
      if (time.is_sending) watch_.OnSent(kBytes, now_);
      repeated_bytes_ += static_cast<std::uint64_t>(time.repeated * kBytes);
      if (time.has_receipts) watch_.OnReceipt(now_);
      found = watch_.Look(repeated_bytes_, time.quickest, time.is_late, now_) || found;
    }
    return found;
  }

  SteadyTime now_ = kStart;
  std::uint64_t repeated_bytes_ = 0;
  RepairWatch watch_;
};

TEST_F(RepairWatchTest, RepairsThatHoldUpWhatComesAfterAreNoticed) {
  EXPECT_FALSE(Pass(RepairWatch::kOver, {.repeated = 0.05})) << "a moment is none";
  EXPECT_TRUE(Pass(2 * kInterval, {.repeated = 0.05}));
}

TEST_F(RepairWatchTest, NothingNewIsSentWhileEverythingIsRepaired) {
  Pass(RepairWatch::kOver, {.repeated = 0.0, .is_late = false});
  EXPECT_TRUE(Pass(2 * kFound, {.repeated = 0.05, .is_sending = false}));
}

TEST_F(RepairWatchTest, ASessionBeginsWithoutThePast) {
  Pass(RepairWatch::kOver, {.repeated = 0.05});
  watch_.BeginSession();
  EXPECT_FALSE(Pass(RepairWatch::kOver, {.repeated = 0.05}));
}

TEST_F(RepairWatchTest, RepairsThatHoldNothingUpAreTheMiddlewares) {
  EXPECT_FALSE(Pass(60s, {.repeated = 0.3, .is_late = false}));
}

TEST_F(RepairWatchTest, NearbyTheMiddlewareRepairsAllTheSame) {
  EXPECT_FALSE(Pass(60s, {.repeated = 0.3, .quickest = 5ms})) << "a busy computer loses, too";
}

TEST_F(RepairWatchTest, AGroundThatIsSlowIsNoPoorLink) {
  EXPECT_FALSE(Pass(60s, {.repeated = 0.0}));
  EXPECT_FALSE(Pass(60s, {.repeated = 0.015}));
}

TEST_F(RepairWatchTest, ALostPacketIsNoPoorLinkHoweverLittleIsSent) {
  EXPECT_FALSE(Pass(60s, {.repeated = 0.0015, .is_sending = false}));
}

TEST_F(RepairWatchTest, ACountThatBeginsAnewIsNone) {
  Pass(RepairWatch::kOver, {.repeated = 0.015});
  repeated_bytes_ = 0;
  EXPECT_FALSE(Pass(kFound, {.repeated = 0.0}));
}

TEST_F(RepairWatchTest, WhatAnOutageLeftBehindIsNoPoorLink) {
  EXPECT_FALSE(Pass(5s, {.repeated = 0.0, .is_late = false}));
  // Nothing gets through; receipts of before still come for a moment, and what was not confirmed
  // is sent again.
  EXPECT_FALSE(Pass(RepairWatch::kSilence, {.repeated = 0.5, .has_receipts = false}));
  EXPECT_FALSE(Pass(10s, {.repeated = 0.5, .has_receipts = false}));
  EXPECT_FALSE(Pass(RepairWatch::kAfterSilence, {.repeated = 2.0}));
  EXPECT_FALSE(Pass(10s, {.repeated = 0.0, .is_late = false}));
}

TEST_F(RepairWatchTest, ALinkThatStaysPoorAfterAnOutageIsPoor) {
  Pass(5s, {.repeated = 0.0, .is_late = false});
  Pass(10s, {.repeated = 0.0, .has_receipts = false});
  EXPECT_TRUE(Pass(RepairWatch::kAfterSilence + kFound, {.repeated = 0.05}));
}

TEST_F(RepairWatchTest, AGroundThatComesLaterIsSentFirstWhatWasKept) {
  EXPECT_FALSE(Pass(5s, {.repeated = 0.0, .is_late = false, .has_receipts = false}));
  EXPECT_FALSE(Pass(RepairWatch::kAfterSilence, {.repeated = 2.0}));
}

TEST_F(RepairWatchTest, AGroundThatNeverAnsweredSaysNothing) {
  EXPECT_FALSE(Pass(10s, {.repeated = 0.5, .has_receipts = false}));
}

}  // namespace
}  // namespace isotherm
