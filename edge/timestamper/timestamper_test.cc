#include "edge/timestamper/timestamper.h"

#include <gtest/gtest.h>

#include "edge/options/edge_options.pb.h"

namespace isotherm {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr CaptureTime kEpoch{seconds(1'700'000'000)};

class TimestamperTest : public testing::TestWithParam<StampEstimator> {
 protected:
  TimestamperTest() { options_.mutable_expert()->set_estimator(GetParam()); }

  Timestamper Make(Nanoseconds rig_delay = Nanoseconds(0)) const {
    return Timestamper(options_, Sensor::kThermal, rig_delay);
  }
  static RawFrame Frame(Nanoseconds ticks, CaptureTime arrival) {
    RawFrame frame;
    frame.sensor = Sensor::kThermal;
    frame.device_ticks = DeviceTicks(std::chrono::floor<std::chrono::microseconds>(ticks));
    frame.arrival_wall = arrival;
    return frame;
  }
  static Stamp Process(Timestamper& timestamper, Nanoseconds ticks, CaptureTime arrival) {
    return timestamper.Process(Frame(ticks, arrival), arrival);
  }

  TimestamperOptions options_;
};

TEST_P(TimestamperTest, ConstantDelaysAreAdded) {
  options_.mutable_expert()->set_thermal_delay_s(-0.042);
  Timestamper timestamper = Make(milliseconds(2));
  EXPECT_EQ(Process(timestamper, seconds(1), kEpoch).time, kEpoch - milliseconds(40));
}

TEST_P(TimestamperTest, F09StampsStayStrictlyIncreasingWhenTheResetFrameWasEarly) {
  Timestamper timestamper = Make();
  // Until now each frame arrived 40 ms late; the first one of the new counter arrives at once.
  const CaptureTime before = Process(timestamper, seconds(10), kEpoch + milliseconds(40)).time;
  const CaptureTime after = Process(timestamper, seconds(0), kEpoch + milliseconds(33)).time;
  EXPECT_EQ(after, before + Nanoseconds(1));
  EXPECT_EQ(timestamper.counts().moved, 1U);
  EXPECT_EQ(timestamper.counts().resets, 1U);
}

TEST_P(TimestamperTest, F04ACounterThatStoodStillWhileTheCameraWasAwayIsAnotherOne) {
  Timestamper timestamper = Make();
  for (int i = 0; i < 400; ++i)
    Process(timestamper, i * milliseconds(111), kEpoch + i * milliseconds(111));
  // Away for eleven seconds, and the ticks go on as if nothing had been.
  for (int i = 400; i < 430; ++i) {
    const CaptureTime arrival = kEpoch + seconds(11) + i * milliseconds(111);
    RawFrame frame = Frame(i * milliseconds(111), arrival);
    frame.reopened = i == 400;
    const Stamp stamp = timestamper.Process(frame, arrival);
    EXPECT_EQ(stamp.time, arrival) << i;
    EXPECT_TRUE(stamp.synchronised) << i;
    EXPECT_LT(stamp.sigma, milliseconds(1)) << i;
  }
  EXPECT_EQ(timestamper.counts().resets, 1U);
}

TEST_P(TimestamperTest, RepeatedTicksGetDistinctStamps) {
  Timestamper timestamper = Make();
  const CaptureTime first = Process(timestamper, seconds(1), kEpoch).time;
  EXPECT_EQ(Process(timestamper, seconds(1), kEpoch).time, first + Nanoseconds(1));
  EXPECT_EQ(timestamper.counts().resets, 0U);
}

TEST_P(TimestamperTest, ACameraWithoutAClockIsStampedByItsFrames) {
  Timestamper timestamper = Make();
  CaptureTime last{};
  for (int i = 0; i < 400; ++i) {
    // Ticks that mean nothing.
    RawFrame frame = Frame(Nanoseconds(0), kEpoch + i * milliseconds(40));
    if (i % 5 == 0) frame.arrival_wall += milliseconds(9);
    frame.has_device_clock = false;
    frame.frame_number = static_cast<std::uint64_t>(i);
    const Stamp stamp = timestamper.Process(frame, frame.arrival_wall);
    if (i > 100) {
      EXPECT_EQ(stamp.time - last, milliseconds(40)) << i;
      EXPECT_GT(stamp.sigma, Nanoseconds(0));
    }
    last = stamp.time;
  }
}

INSTANTIATE_TEST_SUITE_P(Estimators, TimestamperTest, testing::Values(MEDIAN, ENVELOPE));

}  // namespace
}  // namespace isotherm
