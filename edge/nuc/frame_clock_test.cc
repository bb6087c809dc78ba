#include "edge/nuc/frame_clock.h"

#include <gtest/gtest.h>

namespace isotherm {
namespace {

using std::chrono::hours;
using std::chrono::seconds;

constexpr CaptureTime kStart{hours(1)};

TEST(FrameClockTest, BeginsWithTheFirstFrame) {
  FrameClock clock;
  EXPECT_FALSE(clock.has_begun());
  EXPECT_EQ(clock.Advance(kStart), Nanoseconds(0));
  EXPECT_TRUE(clock.has_begun());
  EXPECT_EQ(clock.first(), kStart);
  EXPECT_EQ(clock.now(), kStart);
}

TEST(FrameClockTest, GoesOnWithTheFrames) {
  FrameClock clock;
  clock.Advance(kStart);
  EXPECT_EQ(clock.Advance(kStart + seconds(3)), seconds(3));
  EXPECT_EQ(clock.now(), kStart + seconds(3));
}

TEST(FrameClockTest, NoTimePassesWhenTheWallClockJumpsBackAndItGoesOnFromThere) {
  FrameClock clock;
  clock.Advance(kStart);
  EXPECT_EQ(clock.Advance(kStart - hours(1)), Nanoseconds(0));
  EXPECT_EQ(clock.now(), kStart);
  EXPECT_EQ(clock.Advance(kStart - hours(1) + seconds(2)), seconds(2));
  EXPECT_EQ(clock.now(), kStart + seconds(2));
}

}  // namespace
}  // namespace isotherm
