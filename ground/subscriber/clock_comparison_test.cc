#include "ground/subscriber/clock_comparison.h"

#include <gtest/gtest.h>

#include <cmath>
#include <iostream>
#include <random>

namespace isotherm {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr CaptureTime kStart{seconds(1'700'000'000)};
// Bounds are exceeded by no more: drift is bounded, nanoseconds are rounded.
constexpr double kRounding_s = 1e-6;

/// Two computers with a link between them, as seen by somebody who knows the time.
class ClockComparisonTest : public testing::Test {
 protected:
  SteadyTime Steady() const { return SteadyTime(seconds(500)) + elapsed_; }
  ClockReading Ground() const { return {kStart + elapsed_ + ground_set_, Steady()}; }
  CaptureTime Rig() const {
    return kStart + elapsed_ + rig_set_ + FromSeconds(rig_drift_ * ToSeconds(elapsed_));
  }

  /// A receipt goes out, comes after `there`, is held until the next status and comes back.
  void RoundTrip(Nanoseconds there, Nanoseconds back, Nanoseconds held = milliseconds(300)) {
    const std::uint64_t ping = comparison_.Ping(Steady());
    elapsed_ += there;
    ClockEcho echo{.ping = ping, .received = Rig(), .sent = {}};
    elapsed_ += held;
    echo.sent = Rig();
    elapsed_ += back;
    comparison_.Add(echo, Steady());
  }
  /// The offset that a bystander sees now.
  double Truth() const { return ToSeconds(Rig() - Ground().wall); }
  void ExpectTruthWithinBounds() {
    const auto offset = comparison_.Offset(Ground());
    ASSERT_TRUE(offset.has_value());
    EXPECT_LE(std::abs(offset->offset_s - Truth()), offset->uncertainty_s + kRounding_s)
        << "offset " << offset->offset_s << " +- " << offset->uncertainty_s << ", truth "
        << Truth();
  }

  ClockComparison comparison_{1'000'000};
  Nanoseconds elapsed_{0};
  Nanoseconds ground_set_{0};
  Nanoseconds rig_set_{0};
  double rig_drift_ = 0.0;
};

TEST_F(ClockComparisonTest, KnowsNothingBeforeTheFirstEcho) {
  comparison_.Ping(Steady());
  EXPECT_FALSE(comparison_.Offset(Ground()).has_value());
}

TEST_F(ClockComparisonTest, EqualWaysGiveTheOffsetExactly) {
  rig_set_ = milliseconds(80);
  RoundTrip(milliseconds(2), milliseconds(2));
  const auto offset = comparison_.Offset(Ground());
  ASSERT_TRUE(offset.has_value());
  EXPECT_NEAR(offset->offset_s, 0.080, kRounding_s);
  EXPECT_NEAR(offset->uncertainty_s, 0.002, ClockComparison::kMaxDrift);
}

TEST_F(ClockComparisonTest, UnequalWaysNeverLeaveTheBounds) {
  RoundTrip(milliseconds(400), milliseconds(1));
  ExpectTruthWithinBounds();
  EXPECT_NEAR(comparison_.Offset(Ground())->uncertainty_s, 0.2, 0.001);
}

TEST_F(ClockComparisonTest, BoundsHoldForAnyLinkAndDrift) {
  constexpr unsigned kSeed = 42;
  std::cout << "seed " << kSeed << "\n";
  std::mt19937 random(kSeed);
  std::exponential_distribution<double> delay(1.0 / 0.050);
  std::uniform_real_distribution<double> drift(-90e-6, 90e-6);
  for (int link = 0; link < 50; ++link) {
    comparison_ = ClockComparison(1);
    rig_drift_ = drift(random);
    rig_set_ = milliseconds(20 * (link - 25)) - FromSeconds(rig_drift_ * ToSeconds(elapsed_));
    for (int i = 0; i < 30; ++i) {
      RoundTrip(FromSeconds(delay(random)), FromSeconds(delay(random)), milliseconds(700));
      ExpectTruthWithinBounds();
    }
  }
}

TEST_F(ClockComparisonTest, TheFastestRoundTripOfTheWindowCounts) {
  RoundTrip(milliseconds(1), milliseconds(1));
  for (int i = 0; i < 5; ++i) RoundTrip(milliseconds(200), milliseconds(5));
  EXPECT_LT(comparison_.Offset(Ground())->uncertainty_s, 0.003);
  for (int i = 0; i < 20; ++i) RoundTrip(milliseconds(200), milliseconds(5));
  EXPECT_GT(comparison_.Offset(Ground())->uncertainty_s, 0.1) << "the fast one is long ago";
}

TEST_F(ClockComparisonTest, AStepOfTheRigIsFollowedAtOnce) {
  for (const Nanoseconds step :
       {Nanoseconds(seconds(1)), -Nanoseconds(seconds(2)), Nanoseconds(milliseconds(70))}) {
    // Faster than what follows, so that it would count if it were not forgotten.
    for (int i = 0; i < 4; ++i) RoundTrip(milliseconds(1), milliseconds(0));
    rig_set_ += step;
    RoundTrip(milliseconds(3), milliseconds(1));
    ExpectTruthWithinBounds();
    EXPECT_LT(comparison_.Offset(Ground())->uncertainty_s, 0.005);
  }
}

TEST_F(ClockComparisonTest, AStepBetweenPingAndEchoDoesNotMislead) {
  for (const Nanoseconds step : {Nanoseconds(seconds(100)), -Nanoseconds(seconds(100))}) {
    RoundTrip(milliseconds(1), milliseconds(1));
    const std::uint64_t ping = comparison_.Ping(Steady());
    ClockEcho echo{.ping = ping, .received = Rig(), .sent = {}};
    rig_set_ += step;
    elapsed_ += milliseconds(500);
    echo.sent = Rig();
    comparison_.Add(echo, Steady());
    if (comparison_.Offset(Ground())) ExpectTruthWithinBounds();
    RoundTrip(milliseconds(1), milliseconds(1));
    ExpectTruthWithinBounds();
  }
}

TEST_F(ClockComparisonTest, AStepOfOurOwnClockCountsAtOnce) {
  RoundTrip(milliseconds(1), milliseconds(1));
  ground_set_ += seconds(3);
  ExpectTruthWithinBounds();
}

TEST_F(ClockComparisonTest, WhatIsOldIsNotKnownAnyMore) {
  RoundTrip(milliseconds(1), milliseconds(1));
  elapsed_ += ClockComparison::kWindow + seconds(1);
  EXPECT_FALSE(comparison_.Offset(Ground()).has_value());
}

TEST_F(ClockComparisonTest, EchoesOfOthersAreIgnored) {
  comparison_.Ping(Steady());
  for (const std::uint64_t ping : {0UL, 1UL, 999'999UL, 1'000'001UL, ~0UL}) {
    comparison_.Add({.ping = ping, .received = Rig(), .sent = Rig()}, Steady());
  }
  EXPECT_FALSE(comparison_.Offset(Ground()).has_value());
}

TEST_F(ClockComparisonTest, PingsLongAgoAreForgotten) {
  const std::uint64_t first = comparison_.Ping(Steady());
  for (int i = 0; i < 2000; ++i) comparison_.Ping(Steady());
  comparison_.Add({.ping = first, .received = Rig(), .sent = Rig()}, Steady());
  EXPECT_FALSE(comparison_.Offset(Ground()).has_value());
  RoundTrip(milliseconds(1), milliseconds(1));
  ExpectTruthWithinBounds();
}

}  // namespace
}  // namespace isotherm
