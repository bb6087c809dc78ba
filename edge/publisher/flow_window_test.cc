#include "edge/publisher/flow_window.h"

#include <gtest/gtest.h>

namespace isotherm {
namespace {

using namespace std::chrono_literals;

class FlowWindowTest : public ::testing::Test {
 protected:
  FlowWindow window_{4, 10s};
  SteadyTime now_{1h};
};

TEST_F(FlowWindowTest, RoomIsTheWindowAboveWhatIsHandled) {
  EXPECT_TRUE(window_.HasRoom(3));
  EXPECT_FALSE(window_.HasRoom(4));
  window_.OnReceipt(2, now_);
  EXPECT_TRUE(window_.HasRoom(5));
  EXPECT_FALSE(window_.HasRoom(6));
}

TEST_F(FlowWindowTest, AnOldReceiptTakesNothingBack) {
  window_.OnReceipt(10, now_);
  window_.OnReceipt(2, now_);
  EXPECT_TRUE(window_.HasRoom(13));
}

TEST_F(FlowWindowTest, AGroundThatHangsCostsTheTimeoutOnce) {
  EXPECT_FALSE(window_.GiveUp(now_));
  EXPECT_FALSE(window_.GiveUp(now_ + 10s - 1ns));
  EXPECT_TRUE(window_.GiveUp(now_ + 10s));
  EXPECT_TRUE(window_.HasRoom(1000));
  window_.OnReceipt(1, now_ + 11s);  // Back again.
  EXPECT_FALSE(window_.HasRoom(1000));
  EXPECT_FALSE(window_.GiveUp(now_ + 12s));
}

TEST_F(FlowWindowTest, ANewSessionStartsFromZero) {
  window_.OnReceipt(100, now_);
  window_.BeginSession();
  EXPECT_TRUE(window_.HasRoom(3));
  EXPECT_FALSE(window_.HasRoom(4));
}

}  // namespace
}  // namespace isotherm
