#include "edge/publisher/stop_budget.h"

#include <gtest/gtest.h>

namespace isotherm {
namespace {

using namespace std::chrono_literals;

class StopBudgetTest : public ::testing::Test {
 protected:
  StopBudget budget_;
  SteadyTime stop_{1h};
};

TEST_F(StopBudgetTest, WaitingEndsBeforeWritingDoes) {
  EXPECT_TRUE(budget_.MayWait(stop_));
  EXPECT_TRUE(budget_.MayWait(stop_ + 500ms - 1ns));
  EXPECT_FALSE(budget_.MayWait(stop_ + 500ms));
  EXPECT_TRUE(budget_.MayWrite(stop_ + 500ms));
  EXPECT_TRUE(budget_.MayWrite(stop_ + 700ms - 1ns));
  EXPECT_FALSE(budget_.MayWrite(stop_ + 700ms));
}

TEST_F(StopBudgetTest, AQuestionAboutWritingBeginsTheTimeOfBoth) {
  EXPECT_TRUE(budget_.MayWrite(stop_));
  EXPECT_FALSE(budget_.MayWait(stop_ + 500ms));
}

TEST_F(StopBudgetTest, AllFramesShareOneBudget) {
  constexpr Nanoseconds kWait = 10ms;
  SteadyTime now = stop_;
  int waited = 0;
  for (int frame = 0; frame < 100; ++frame) {
    if (!budget_.MayWait(now)) continue;
    now += kWait;
    ++waited;
  }
  EXPECT_EQ(waited, 50) << "500 ms in all, however often it is asked";
}

TEST_F(StopBudgetTest, WhatIsUsedUpDoesNotComeBack) {
  EXPECT_TRUE(budget_.MayWrite(stop_));
  EXPECT_FALSE(budget_.MayWrite(stop_ + 1s));
  EXPECT_FALSE(budget_.MayWrite(stop_ + 1h));
  EXPECT_FALSE(budget_.MayWait(stop_ + 1h));
}

}  // namespace
}  // namespace isotherm
