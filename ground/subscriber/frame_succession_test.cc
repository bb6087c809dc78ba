#include "ground/subscriber/frame_succession.h"

#include <gtest/gtest.h>

namespace isotherm {
namespace {

using namespace std::chrono_literals;

class FrameSuccessionTest : public ::testing::Test {
 protected:
  /// Checks a frame this much further on in numbers, capture time and arrival.
  std::optional<RefusalCause> Check(std::int64_t numbers, Nanoseconds time, Nanoseconds arrival) {
    FrameMark frame = before_;
    frame.number += static_cast<std::uint64_t>(numbers);
    frame.time += time;
    frame.arrival += arrival;
    return CheckFollows(before_, frame);
  }
  FrameMark before_{.number = 1'000'000,
                    .time = CaptureTimeFromNanoseconds(1'700'000'000'000'000'000)};
};

TEST_F(FrameSuccessionTest, WhatCamerasAndLinksDoIsPlausible) {
  EXPECT_EQ(Check(1, 33ms, 33ms), std::nullopt);
  EXPECT_EQ(Check(1, 33ms, 0ms), std::nullopt) << "a burst after an outage, or a replay";
  EXPECT_EQ(Check(1, 11ms, 5s), std::nullopt) << "an outage began";
  EXPECT_EQ(Check(900, 30s, 30s), std::nullopt) << "what an outage cost";
  EXPECT_EQ(Check(1, 1h, 1h), std::nullopt) << "a camera was away";
  EXPECT_EQ(Check(1, 20s, 19'800ms), std::nullopt) << "and the frame before it was late";
  EXPECT_EQ(Check(30, 1s, 50ms), std::nullopt) << "a replay of which frames were dropped";
  EXPECT_EQ(Check(-3, -100ms, 10ms), std::nullopt) << "a late frame";
}

TEST_F(FrameSuccessionTest, TimesThatAreNotInTheSessionAreNot) {
  EXPECT_EQ(Check(1, 1h, 33ms), RefusalCause::kImplausibleTime);
  EXPECT_EQ(Check(1, 1301ms, 33ms), RefusalCause::kImplausibleTime);
  EXPECT_EQ(Check(1, -1ns, 33ms), RefusalCause::kImplausibleTime);
  EXPECT_EQ(Check(-1, 1ns, 33ms), RefusalCause::kImplausibleTime);
  EXPECT_EQ(Check(1'000'000, 500'000s, 33ms), RefusalCause::kImplausibleTime);
}

TEST_F(FrameSuccessionTest, AGapInARecordingIsForwardsAndInThePast) {
  const auto may_follow = [&](std::int64_t numbers, Nanoseconds time) {
    FrameMark frame = before_;
    frame.number += static_cast<std::uint64_t>(numbers);
    frame.time += time;
    return MayFollowGap(before_, frame, before_.time + 24h);
  };
  EXPECT_TRUE(may_follow(1, 1h));
  EXPECT_TRUE(may_follow(100'000, 1h)) << "numbers went on";
  EXPECT_FALSE(may_follow(1, 25h)) << "nobody recorded it yet";
  EXPECT_FALSE(may_follow(1, -1h));
  EXPECT_FALSE(may_follow(-1, 1h));
  EXPECT_FALSE(may_follow(5'600'000, 1h)) << "more than any camera";
}

TEST_F(FrameSuccessionTest, NumbersThatNoCameraReachesAreNot) {
  EXPECT_EQ(Check(5'600'000, 33ms, 33ms), RefusalCause::kImpossibleNumber) << "one flipped bit";
  EXPECT_EQ(Check(100, 33ms, 33ms), RefusalCause::kImpossibleNumber);
  EXPECT_EQ(Check(60, 33ms, 33ms), std::nullopt);
}

}  // namespace
}  // namespace isotherm
