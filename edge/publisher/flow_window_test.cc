#include "edge/publisher/flow_window.h"

#include <gtest/gtest.h>

namespace isotherm {
namespace {

using namespace std::chrono_literals;

class FlowWindowTest : public ::testing::Test {
 protected:
  void Publish(std::uint64_t first, std::uint64_t count) {
    for (std::uint64_t i = 0; i < count; ++i) window_.OnPublished(first + i);
  }

  FlowWindow window_{4, 10s};
  SteadyTime now_{1h};
};

TEST_F(FlowWindowTest, RoomIsTheWindowAboveWhatIsHandled) {
  Publish(0, 3);
  EXPECT_TRUE(window_.HasRoom());
  Publish(3, 1);
  EXPECT_FALSE(window_.HasRoom());
  window_.OnReceipt(2, now_);
  Publish(4, 1);
  EXPECT_TRUE(window_.HasRoom());
  Publish(5, 1);
  EXPECT_FALSE(window_.HasRoom());
}

TEST_F(FlowWindowTest, NumbersThatWereNeverPublishedTakeNoRoom) {
  Publish(0, 2);
  window_.OnReceipt(2, now_);
  Publish(200, 3);  // 198 frames were dropped before.
  EXPECT_TRUE(window_.HasRoom());
  window_.OnReceipt(201, now_);
  Publish(203, 1);
  EXPECT_TRUE(window_.HasRoom());
  Publish(204, 1);
  EXPECT_FALSE(window_.HasRoom());
}

TEST_F(FlowWindowTest, AnOldReceiptTakesNothingBack) {
  Publish(0, 4);
  window_.OnReceipt(3, now_);
  window_.OnReceipt(2, now_);
  Publish(4, 2);
  EXPECT_TRUE(window_.HasRoom());
}

TEST_F(FlowWindowTest, AGroundThatHangsCostsTheTimeoutOnce) {
  Publish(0, 4);
  EXPECT_FALSE(window_.GiveUp(now_));
  EXPECT_FALSE(window_.GiveUp(now_ + 10s - 1ns));
  EXPECT_TRUE(window_.GiveUp(now_ + 10s));
  Publish(4, 1000);
  EXPECT_TRUE(window_.HasRoom());
  window_.OnReceipt(1, now_ + 11s);  // Back again.
  EXPECT_FALSE(window_.HasRoom());
  EXPECT_FALSE(window_.GiveUp(now_ + 12s));
}

TEST_F(FlowWindowTest, ANewSessionStartsFromZero) {
  Publish(0, 4);
  window_.BeginSession();
  EXPECT_TRUE(window_.HasRoom());
}

}  // namespace
}  // namespace isotherm
