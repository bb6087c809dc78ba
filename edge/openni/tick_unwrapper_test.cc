#include "edge/openni/tick_unwrapper.h"

#include <gtest/gtest.h>

namespace isotherm {
namespace {

constexpr std::uint64_t kWrap_us = 4'294'967'296;  // 71.6 minutes.

std::int64_t Us(DeviceTicks ticks) { return ticks.time_since_epoch().count(); }

TEST(TickUnwrapperTest, RisingStampsPass) {
  TickUnwrapper unwrapper;
  for (const std::uint64_t stamp_us : {5ULL, 33'338ULL, 5'000'000'000ULL, 5'000'033'333ULL}) {
    EXPECT_EQ(Us(unwrapper.Unwrap(stamp_us)), static_cast<std::int64_t>(stamp_us));
  }
  EXPECT_EQ(unwrapper.wraps() + unwrapper.resets(), 0U);
}

TEST(TickUnwrapperTest, F09ACounterOf32BitsGoesOnAcrossItsWraps) {
  TickUnwrapper unwrapper;
  constexpr std::uint64_t kPeriod_us = 33'333;
  // Three turns and a bit, a frame a minute so that it stays quick.
  std::uint64_t true_us = 17;
  for (int frame = 0; frame < 240; ++frame, true_us += 1800 * kPeriod_us) {
    ASSERT_EQ(Us(unwrapper.Unwrap(true_us % kWrap_us)), static_cast<std::int64_t>(true_us));
  }
  EXPECT_EQ(unwrapper.wraps(), 3U);
  EXPECT_EQ(unwrapper.resets(), 0U);
}

TEST(TickUnwrapperTest, F09AResetGoesBackwards) {
  TickUnwrapper unwrapper;
  const DeviceTicks before = unwrapper.Unwrap(100'000'000);
  const DeviceTicks after = unwrapper.Unwrap(33'333);
  EXPECT_LT(after, before);
  EXPECT_EQ(Us(after), 33'333);
  EXPECT_EQ(unwrapper.resets(), 1U);
}

TEST(TickUnwrapperTest, F09AResetAfterAWrapStartsFromTheCounterAgain) {
  TickUnwrapper unwrapper;
  unwrapper.Unwrap(kWrap_us - 10);
  const DeviceTicks wrapped = unwrapper.Unwrap(60'000'000);
  EXPECT_EQ(Us(wrapped), static_cast<std::int64_t>(kWrap_us) + 60'000'000);
  EXPECT_EQ(Us(unwrapper.Unwrap(1000)), 1000);
  EXPECT_EQ(unwrapper.wraps(), 1U);
  EXPECT_EQ(unwrapper.resets(), 1U);
}

TEST(TickUnwrapperTest, F09ALongCounterDoesNotWrapAt32Bits) {
  TickUnwrapper unwrapper;
  unwrapper.Unwrap(3 * kWrap_us);
  EXPECT_EQ(Us(unwrapper.Unwrap(5)), 5) << "a counter beyond 32 bits was reset";
  EXPECT_EQ(unwrapper.resets(), 1U);
}

}  // namespace
}  // namespace isotherm
