#include "common/time/text_limiter.h"

#include <gtest/gtest.h>

namespace isotherm {
namespace {

using namespace std::chrono_literals;

TEST(TextLimiterTest, OfAKindOneLinePassesThenOneInTenSecondsWithTheNumberLeftOut) {
  TextLimiter limiter;
  SteadyTime now{1h};
  const std::string words = "ddsi_udp_conn_write to udp/10.0.0.";
  EXPECT_EQ(limiter.Admit(words + "1 failed", now), words + "1 failed");
  for (int i = 2; i < 100; ++i)
    EXPECT_EQ(limiter.Admit(words + std::to_string(i) + " failed", now += 100ms), std::nullopt);
  EXPECT_EQ(limiter.untold(), 98U);
  EXPECT_EQ(limiter.Admit(words + "1 failed", now += 1s),
            words + "1 failed (98 more since the last such line)");
  EXPECT_EQ(limiter.untold(), 0U);
  EXPECT_EQ(limiter.suppressed(), 98U);
}

TEST(TextLimiterTest, AnotherKindIsNotHeldUp) {
  TextLimiter limiter;
  const SteadyTime now{1h};
  EXPECT_EQ(limiter.Admit("malformed packet received from vendor 1.16", now),
            "malformed packet received from vendor 1.16");
  EXPECT_EQ(limiter.Admit("malformed packet received from vendor 9.9", now), std::nullopt);
  EXPECT_EQ(limiter.Admit("no interface is up", now), "no interface is up");
}

TEST(TextLimiterTest, MadeUpKindsGetNoMoreLines) {
  TextLimiter limiter;
  const SteadyTime now{1h};
  std::size_t lines = 0;
  for (char a = 'a'; a <= 'z'; ++a) {
    for (char b = 'a'; b <= 'z'; ++b) {
      lines += limiter.Admit(std::string{a} + b, now) ? 1 : 0;
    }
  }
  EXPECT_EQ(lines, TextLimiter::kMaxKinds + 1);
  EXPECT_EQ(limiter.suppressed(), 26U * 26U - lines);
}

}  // namespace
}  // namespace isotherm
