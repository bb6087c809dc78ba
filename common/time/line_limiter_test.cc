#include "common/time/line_limiter.h"

#include <gtest/gtest.h>

namespace isotherm {
namespace {

using namespace std::chrono_literals;

TEST(LineLimiterTest, TenLinesPerSecondPassAndTheRestIsCounted) {
  LineLimiter limiter(10, 1s);
  SteadyTime now{1h};
  int admitted = 0;
  for (int i = 0; i < 1000; ++i) admitted += limiter.Admit(now) ? 1 : 0;
  EXPECT_EQ(admitted, 10);
  EXPECT_EQ(limiter.suppressed(), 990U);
  EXPECT_EQ(limiter.Admit(now + 1s), 990U);
}

TEST(LineLimiterTest, ANewAttackAfterAQuietHourIsToldAtOnce) {
  LineLimiter limiter;
  SteadyTime now{1h};
  EXPECT_EQ(limiter.Admit(now), 0U);
  for (int i = 0; i < 299; ++i) EXPECT_EQ(limiter.Admit(now += 33ms), std::nullopt);
  now += 1h;
  EXPECT_EQ(limiter.Admit(now), 299U) << "and says what was left out";
  EXPECT_EQ(limiter.Admit(now), std::nullopt);
  EXPECT_EQ(LeftOutText(299), " (299 more since the last such line)");
  EXPECT_EQ(LeftOutText(0), "");
}

}  // namespace
}  // namespace isotherm
