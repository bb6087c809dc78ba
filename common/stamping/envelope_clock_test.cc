#include "common/stamping/envelope_clock.h"

#include <gtest/gtest.h>

#include <cmath>

#include "common/base/noise.h"

namespace isotherm {
namespace {

using std::chrono::microseconds;
using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr CaptureTime kEpoch{seconds(1'700'000'000)};
constexpr microseconds kPeriod{33'333};
constexpr double kJitter_s = 0.001;
// An estimate that has settled, with a millisecond of jitter.
constexpr double kSettled_s = 0.0005;
// One that rests on a few frames.
constexpr double kFresh_s = 0.005;

/// A camera at 30 Hz whose frames take at least 40 ms and exponential jitter.
class EnvelopeClockTest : public testing::Test {
 protected:
  /// How far the stamp of the next frame is behind its exposure and the shortest transport.
  double Next(Nanoseconds held_up = Nanoseconds(0)) {
    const Nanoseconds exposure = frame_ * kPeriod;
    const double jitter_s =
        -kJitter_s * std::log1p(-UniformNoise(1, static_cast<std::uint64_t>(frame_)));
    const auto device = std::chrono::round<microseconds>(Nanoseconds(static_cast<std::int64_t>(
        static_cast<double>(exposure.count()) * (1.0 + 1e-6 * drift_ppm_))));
    stamp_ = clock_.Process(DeviceTicks(device + counter_),
                            kEpoch + exposure + milliseconds(40) + FromSeconds(jitter_s) + held_up);
    ++frame_;
    return ToSeconds(stamp_.time - (kEpoch + exposure + milliseconds(40)));
  }
  void Run(int frames) {
    for (int i = 0; i < frames; ++i) Next();
  }

  void ExpectFollowed(double drift_ppm) {
    drift_ppm_ = drift_ppm;
    Run(10 * 30);
    for (int i = 0; i < 120 * 30; ++i) EXPECT_LT(std::abs(Next()), kSettled_s);
    constexpr double kSkewTolerance_ppm = 10.0;  // Of 0.3 ms in half a minute.
    EXPECT_NEAR(clock_.skew_ppm(), -drift_ppm, kSkewTolerance_ppm);
    EXPECT_EQ(clock_.resets() + clock_.relearned(), 0U);
  }

  EnvelopeClock clock_{EnvelopeOptions{}};
  std::int64_t frame_ = 0;
  double drift_ppm_ = 0.0;
  microseconds counter_{0};  ///< Reading at the first exposure.
  Stamp stamp_;
};

TEST_F(EnvelopeClockTest, TheFirstFrameGetsItsOwnArrival) {
  EXPECT_EQ(clock_.Process(DeviceTicks(seconds(5)), kEpoch).time, kEpoch);
  EXPECT_EQ(clock_.Process(DeviceTicks(seconds(6)), kEpoch + seconds(1)).time, kEpoch + seconds(1));
}

TEST_F(EnvelopeClockTest, EqualTicksAndArrivalPassUnchanged) {
  for (int i = 0; i < 3000; ++i) {
    const microseconds time = i * microseconds(33'333 + i % 3);
    ASSERT_EQ(clock_.Process(DeviceTicks(time), kEpoch + time).time, kEpoch + time) << i;
  }
}

TEST_F(EnvelopeClockTest, F10AFastClockIsFollowed) { ExpectFollowed(100.0); }
TEST_F(EnvelopeClockTest, F10ASlowClockIsFollowed) { ExpectFollowed(-100.0); }

TEST_F(EnvelopeClockTest, FramesHeldUpForTenSecondsMoveNothing) {
  Run(20 * 30);
  for (int i = 0; i < 10 * 30; ++i) EXPECT_LT(std::abs(Next(milliseconds(8))), kSettled_s);
  EXPECT_TRUE(stamp_.synchronised);
}

TEST_F(EnvelopeClockTest, SpacingIsTheCamerasButForTheSlew) {
  const EnvelopeOptions options;
  Run(12 * 30);
  CaptureTime last = stamp_.time;
  for (int i = 0; i < 100 * 30; ++i) {
    Next(i % 7 == 0 ? milliseconds(30) : milliseconds(0));
    const double stretch = ToSeconds(stamp_.time - last) / ToSeconds(kPeriod) - 1.0;
    EXPECT_LT(std::abs(stretch), 1e-6 * (options.max_slew_ppm + options.max_skew_ppm) + 1e-6) << i;
    last = stamp_.time;
  }
}

TEST_F(EnvelopeClockTest, F09AResetCounterIsFoundAtOnceAndStampsGoOn) {
  counter_ = seconds(4000);
  Run(20 * 30);
  counter_ = -frame_ * kPeriod;
  for (int i = 0; i < 30; ++i) EXPECT_LT(std::abs(Next()), kFresh_s) << i;
  EXPECT_EQ(clock_.resets(), 1U);
  Run(10 * 30);
  EXPECT_LT(std::abs(Next()), kSettled_s);
}

TEST_F(EnvelopeClockTest, F09AWrapAfter32BitsOfMicrosecondsIsAReset) {
  constexpr microseconds kWrap{std::int64_t{1} << 32};
  counter_ = kWrap - 15 * kPeriod * 30;
  Run(15 * 30);
  counter_ -= kWrap;
  for (int i = 0; i < 300; ++i) EXPECT_LT(std::abs(Next()), kFresh_s) << i;
  EXPECT_EQ(clock_.resets(), 1U);
}

TEST_F(EnvelopeClockTest, F09ACounterThatJumpsAheadOfItsArrivalIsReset) {
  Run(20 * 30);
  counter_ += milliseconds(50);
  for (int i = 0; i < 30; ++i) EXPECT_LT(std::abs(Next()), kFresh_s) << i;
  EXPECT_EQ(clock_.resets(), 1U);
}

TEST_F(EnvelopeClockTest,
       F10AClockThatFellBehindIsUnsynchronisedAfterTwoSecondsAndThenLearnedAgain) {
  Run(20 * 30);
  counter_ -= milliseconds(25);
  int frames = 0;
  do {
    Next();
    ++frames;
  } while (stamp_.synchronised && frames < 300);
  EXPECT_LE(frames, 61) << "longer than two seconds";
  EXPECT_GE(stamp_.sigma, milliseconds(24)) << "sigma does not say how far it may be off";
  Run(12 * 30);
  EXPECT_TRUE(stamp_.synchronised);
  EXPECT_EQ(clock_.relearned(), 1U);
  EXPECT_LT(std::abs(Next()), kFresh_s);
}

TEST_F(EnvelopeClockTest, ALongGapIsBridged) {
  Run(40 * 30);
  frame_ += 300 * 30;
  EXPECT_LT(std::abs(Next()), kFresh_s);
  Run(10 * 30);
  EXPECT_LT(std::abs(Next()), kSettled_s);
}

}  // namespace
}  // namespace isotherm
