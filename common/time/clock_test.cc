#include "common/time/clock.h"

#include <gtest/gtest.h>

namespace isotherm {
namespace {

using namespace std::chrono_literals;

TEST(ClockTest, FakeClockMovesBothTimesTogether) {
  FakeClock clock(CaptureTimeFromNanoseconds(1'000));
  const SteadyTime steady = clock.SteadyNow();
  clock.Advance(5ms);
  EXPECT_EQ(ToNanoseconds(clock.Now()), 5'001'000);
  EXPECT_EQ(clock.SteadyNow() - steady, 5ms);
}

TEST(ClockTest, SecondsRoundToTheNearestNanosecond) {
  EXPECT_EQ(FromSeconds(1000.0333333337).count(), 1000'033'333'334);
  EXPECT_EQ(FromSeconds(-0.5e-9 - 1e-10).count(), -1);
  EXPECT_DOUBLE_EQ(ToSeconds(1500ms), 1.5);
}

}  // namespace
}  // namespace isotherm
