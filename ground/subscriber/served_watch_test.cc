#include "ground/subscriber/served_watch.h"

#include <gtest/gtest.h>

namespace isotherm {
namespace {

using namespace std::chrono_literals;

class ServedWatchTest : public ::testing::Test {
 protected:
  static constexpr PeerHandle kSelf = 7;
  /// Statuses come for so long that name this ground.
  void Pass(int statuses, PeerHandle served) {
    EdgeStatus status;
    status.served_ground = served;
    for (int i = 0; i < statuses; ++i) watch_.OnStatus(status, kSelf, now_ += 1s);
  }

  SteadyTime now_{1h};
  ServedWatch watch_;
};

TEST_F(ServedWatchTest, AnotherGroundIsTold) {
  Pass(3, 0);
  Pass(3, kSelf);
  EXPECT_EQ(watch_.other(), 0U);
  Pass(10, 5);
  EXPECT_EQ(watch_.other(), 5U);
}

TEST_F(ServedWatchTest, AGroundThatTakesAnothersPlaceIsNotWarnedOfIt) {
  Pass(3, 5);
  EXPECT_EQ(watch_.other(), 0U);
  Pass(1, kSelf);
  Pass(3, 5);
  EXPECT_EQ(watch_.other(), 0U);
}

TEST_F(ServedWatchTest, WhatWasTrueOnceIsNotSaidForEver) {
  Pass(10, 5);
  Pass(1, kSelf);
  EXPECT_EQ(watch_.other(), 0U);
}

}  // namespace
}  // namespace isotherm
