#include "common/time/step_watch.h"

#include <gtest/gtest.h>

namespace isotherm {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr ClockReading kStart{CaptureTime(seconds(1'700'000'000)), SteadyTime(seconds(500))};
constexpr milliseconds kFrame{33};

/// A computer whose wall clock somebody sets.
class StepWatchTest : public testing::Test {
 protected:
  std::optional<Nanoseconds> Next(Nanoseconds interrupted = Nanoseconds(0)) {
    elapsed_ += kFrame;
    return watch_.Observe(
        {.wall = kStart.wall + elapsed_ + set_ + interrupted, .steady = kStart.steady + elapsed_});
  }
  /// Frames until the step is found; its size.
  std::optional<Nanoseconds> Find(int frames) {
    for (int i = 0; i < frames; ++i) {
      if (const auto step = Next()) return step;
    }
    return std::nullopt;
  }

  StepWatch watch_{kStart};
  Nanoseconds elapsed_{0};
  Nanoseconds set_{0};
};

TEST_F(StepWatchTest, WithoutAStepTheTimeLineIsTheWallClock) {
  EXPECT_EQ(Find(1000), std::nullopt);
  EXPECT_EQ(watch_.At(kStart.steady + elapsed_), kStart.wall + elapsed_);
  EXPECT_EQ(watch_.steps(), 0U);
}

TEST_F(StepWatchTest, F15EveryStepIsFoundInTimeAndLeavesTheTimeLineAlone) {
  constexpr int kTwoSeconds = 60;
  Nanoseconds sum{0};
  for (const Nanoseconds step :
       {Nanoseconds(seconds(1)), -Nanoseconds(seconds(1)), Nanoseconds(milliseconds(5)),
        Nanoseconds(seconds(100'000'000)), -Nanoseconds(seconds(100'000'000))}) {
    EXPECT_EQ(Find(100), std::nullopt);
    set_ += step;
    sum += step;
    EXPECT_EQ(Find(kTwoSeconds), step);
    EXPECT_EQ(watch_.total(), sum);
    EXPECT_EQ(watch_.At(kStart.steady + elapsed_), kStart.wall + elapsed_);
  }
  EXPECT_EQ(watch_.steps(), 5U);
}

TEST_F(StepWatchTest, F16ALeapSecondIsAStep) {
  set_ = -seconds(1);
  EXPECT_EQ(Find(60), -seconds(1));
  EXPECT_EQ(watch_.steps(), 1U);
}

TEST_F(StepWatchTest, AReadingThatWasInterruptedIsNoStep) {
  for (int i = 0; i < 30; ++i) {
    EXPECT_EQ(Next(i % 3 == 0 ? milliseconds(0) : milliseconds(2 * i)), std::nullopt) << i;
  }
  EXPECT_EQ(watch_.steps(), 0U);
}

TEST(ReadClocksTest, ReadsBothClocks) {
  FakeClock clock(kStart.wall);
  clock.Advance(seconds(7));
  const ClockReading reading = ReadClocks(clock);
  EXPECT_EQ(reading.wall, clock.Now());
  EXPECT_EQ(reading.steady, clock.SteadyNow());
}

}  // namespace
}  // namespace isotherm
