#include "common/stamping/period_tracker.h"

#include <gtest/gtest.h>

#include <cmath>

#include "common/base/noise.h"

namespace isotherm {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr CaptureTime kEpoch{seconds(1'700'000'000)};
constexpr double kPeriod_s = 0.0400217;  // Nobody knows the nominal rate exactly.
constexpr double kJitter_s = 0.002;
constexpr double kSettled_s = 0.0005;

/// A camera without a clock at nearly 25 Hz, with exponential jitter.
class PeriodTrackerTest : public testing::Test {
 protected:
  double Next() {
    const double jitter_s =
        -kJitter_s * std::log1p(-UniformNoise(3, static_cast<std::uint64_t>(exposure_)));
    const CaptureTime exposure =
        kEpoch + begin_ + FromSeconds(kPeriod_s * static_cast<double>(exposure_));
    stamp_ = tracker_.Process(number_, exposure + FromSeconds(jitter_s));
    ++exposure_;
    ++number_;
    return ToSeconds(stamp_.time - exposure);
  }
  void Run(int frames) {
    for (int i = 0; i < frames; ++i) Next();
  }

  PeriodTracker tracker_{EnvelopeOptions{}};
  std::int64_t exposure_ = 0;  ///< Exposures that the camera made.
  std::uint64_t number_ = 0;   ///< The source's count of frames.
  Nanoseconds begin_{0};       ///< Later exposures are later by this.
  Stamp stamp_;
};

TEST_F(PeriodTrackerTest, StampsAreEvenAfterTenSeconds) {
  Run(250);
  for (int i = 0; i < 2500; ++i) {
    EXPECT_LT(std::abs(Next()), kSettled_s) << i;
    EXPECT_GT(stamp_.sigma, Nanoseconds(0));
  }
  EXPECT_EQ(tracker_.slips(), 0U);
}

TEST_F(PeriodTrackerTest, AWrongPeriodAtTheStartDoesNotStay) {
  constexpr milliseconds kSlower{3};  // Per frame, as long as the period is estimated.
  for (int i = 0; i < 40; ++i) {
    begin_ += kSlower;
    Next();
  }
  Run(250);
  const std::uint64_t slips = tracker_.slips();
  EXPECT_GT(slips, 0U) << "nothing went wrong";
  for (int i = 0; i < 2500; ++i) EXPECT_LT(std::abs(Next()), kSettled_s) << i;
  EXPECT_EQ(tracker_.slips(), slips);
}

TEST_F(PeriodTrackerTest, LostFramesThatWereCountedChangeNothing) {
  Run(250);
  exposure_ += 7;
  number_ += 7;
  EXPECT_LT(std::abs(Next()), kSettled_s);
  EXPECT_EQ(tracker_.slips(), 0U);
}

TEST_F(PeriodTrackerTest, FramesThatWereLostUnseenAreNoticed) {
  Run(250);
  exposure_ += 1;
  const double late_s = std::abs(Next());
  EXPECT_GE(2.0 * ToSeconds(stamp_.sigma), late_s) << "sigma does not cover the doubt";
  Run(75);
  EXPECT_LT(std::abs(Next()), 2.0 * kSettled_s);
  EXPECT_EQ(tracker_.slips(), 1U);
}

TEST_F(PeriodTrackerTest, AHoleThatWasNoneIsNoticedAtOnce) {
  Run(250);
  number_ += 1;
  Run(20);
  EXPECT_EQ(tracker_.slips(), 1U);
  Run(250);
  EXPECT_LT(std::abs(Next()), kSettled_s);
}

TEST_F(PeriodTrackerTest, ALongGapStartsAgain) {
  Run(250);
  exposure_ += 1000;
  EXPECT_LT(std::abs(Next()), 5.0 * kJitter_s);
  Run(250);
  EXPECT_LT(std::abs(Next()), kSettled_s);
}

}  // namespace
}  // namespace isotherm
