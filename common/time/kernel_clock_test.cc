#include "common/time/kernel_clock.h"

#include <gtest/gtest.h>
#include <sys/timex.h>

#include <cmath>

namespace isotherm {
namespace {

TEST(KernelClockTest, ASynchronisedClockSaysHowFarOffItMayBe) {
  timex answer{};
  answer.status = STA_PLL | STA_NANO;
  answer.offset = -20'000;
  answer.esterror = 150;
  answer.maxerror = 1'200;
  const KernelClock clock = Interpret(answer, TIME_OK);
  EXPECT_TRUE(clock.synchronised);
  EXPECT_DOUBLE_EQ(clock.offset_s, -20e-6);
  EXPECT_DOUBLE_EQ(clock.estimated_error_s, 150e-6);
  EXPECT_DOUBLE_EQ(clock.max_error_s, 1.2e-3);
  answer.status = STA_PLL;
  EXPECT_DOUBLE_EQ(Interpret(answer, TIME_OK).offset_s, -20e-3) << "microseconds without STA_NANO";
}

TEST(KernelClockTest, F17AnUnsynchronisedClockSaysNothing) {
  timex answer{};
  answer.status = STA_UNSYNC;
  answer.maxerror = 16'000'000;
  for (const int state : {TIME_OK, TIME_ERROR, -1}) {
    const KernelClock clock = Interpret(answer, state);
    EXPECT_FALSE(clock.synchronised);
    EXPECT_TRUE(std::isnan(clock.max_error_s));
    EXPECT_TRUE(std::isnan(clock.offset_s));
  }
}

TEST(KernelClockTest, F16ALeapSecondUnderWayIsNoLossOfSynchronisation) {
  timex answer{};
  answer.status = STA_PLL | STA_INS;
  for (const int state : {TIME_INS, TIME_OOP, TIME_WAIT}) {
    EXPECT_TRUE(Interpret(answer, state).synchronised);
  }
}

TEST(KernelClockTest, TheKernelAnswers) {
  const KernelClock clock = ReadKernelClock();
  EXPECT_EQ(clock.synchronised, !std::isnan(clock.max_error_s));
}

}  // namespace
}  // namespace isotherm
