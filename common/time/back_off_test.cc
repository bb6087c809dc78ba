#include "common/time/back_off.h"

#include <gtest/gtest.h>

namespace isotherm {
namespace {

using namespace std::chrono_literals;

TEST(BackOffTest, WaitsDoubleUpToTheLongest) {
  BackOff back_off(500ms, 5s);
  for (const Nanoseconds wait : {Nanoseconds(500ms), Nanoseconds(1s), Nanoseconds(2s),
                                 Nanoseconds(4s), Nanoseconds(5s), Nanoseconds(5s)}) {
    EXPECT_EQ(back_off.Next(), wait);
  }
}

TEST(BackOffTest, OnceItWorkedTheNextFailureStartsOver) {
  BackOff back_off(500ms, 5s);
  back_off.Next();
  back_off.Next();
  back_off.Reset();
  EXPECT_EQ(back_off.Next(), 500ms);
  EXPECT_EQ(back_off.Next(), 1s);
}

TEST(BackOffTest, ANightOfFailuresDoesNotOverflow) {
  BackOff back_off(1ns, 5s);
  for (int i = 0; i < 10'000; ++i) back_off.Next();
  EXPECT_EQ(back_off.Next(), 5s);
}

}  // namespace
}  // namespace isotherm
