#include "edge/publisher/served_ground.h"

#include <gtest/gtest.h>

namespace isotherm {
namespace {

using namespace std::chrono_literals;

class ServedGroundTest : public ::testing::Test {
 protected:
  /// Both send receipts for a while, or one of them.
  void Pass(Nanoseconds time, bool first, bool second) {
    for (Nanoseconds passed{0}; passed < time; passed += 200ms) {
      now_ += 200ms;
      if (first) first_counts_ = grounds_.OnReceipt(1, now_);
      if (second) second_counts_ = grounds_.OnReceipt(2, now_);
    }
  }

  SteadyTime now_{1h};
  ServedGround grounds_;
  bool first_counts_ = false;
  bool second_counts_ = false;
};

TEST_F(ServedGroundTest, TheOneThatCameFirstCounts) {
  EXPECT_EQ(grounds_.served(), 0U);
  Pass(1s, true, false);
  Pass(10s, true, true);
  EXPECT_TRUE(first_counts_);
  EXPECT_FALSE(second_counts_);
  EXPECT_EQ(grounds_.served(), 1U);
  EXPECT_EQ(grounds_.other(now_), 2U);
}

TEST_F(ServedGroundTest, ASuccessorDoesNotWaitForOneThatHasLeftAndIsNoOther) {
  Pass(1s, true, false);
  grounds_.OnLeft(1);
  Pass(200ms, false, true);
  EXPECT_TRUE(second_counts_);
  Pass(10s, false, true);
  EXPECT_EQ(grounds_.other(now_), 0U);
}

TEST_F(ServedGroundTest, TheSuccessorOfOneThatWasKilledIsNoOther) {
  Pass(1s, true, false);
  for (int i = 0; i < 50; ++i) {
    Pass(200ms, false, true);
    EXPECT_EQ(grounds_.other(now_), 0U);
  }
}

TEST_F(ServedGroundTest, TheNextHasItsTurnWhenTheFirstIsSilent) {
  Pass(1s, true, true);
  Pass(1s, false, true);
  EXPECT_FALSE(second_counts_) << "a pause is no end";
  Pass(2s, false, true);
  EXPECT_TRUE(second_counts_);
  EXPECT_EQ(grounds_.other(now_), 0U);
}

TEST_F(ServedGroundTest, AfterAnOutageItIsTheFirstOnesTurnAgain) {
  Pass(1s, true, true);
  Pass(10s, false, true);
  Pass(1s, true, true);
  EXPECT_TRUE(first_counts_);
  EXPECT_FALSE(second_counts_);
}

TEST_F(ServedGroundTest, OnesThatComeAndGoDoNotDriveTheFirstOut) {
  for (PeerHandle ground = 10; ground < 1000; ++ground) {
    Pass(200ms, true, false);
    EXPECT_FALSE(grounds_.OnReceipt(ground, now_));
  }
  EXPECT_TRUE(first_counts_) << "those were silent for longer";
}

TEST_F(ServedGroundTest, OneThatWasForgottenComesBehindTheOthers) {
  Pass(1s, true, true);
  for (PeerHandle ground = 10; ground < 20; ++ground) {
    Pass(200ms, false, true);
    grounds_.OnReceipt(ground, now_);
  }
  Pass(200ms, true, true);
  EXPECT_TRUE(second_counts_);
  EXPECT_FALSE(first_counts_);
}

}  // namespace
}  // namespace isotherm
