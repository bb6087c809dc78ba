#include "edge/backfill/backfill_window.h"

#include <gtest/gtest.h>

namespace isotherm {
namespace {

using namespace std::chrono_literals;

class BackfillWindowTest : public ::testing::Test {
 protected:
  /// Sends all that may be sent of what the ground lacks, `holes`, from `number` on.
  int SendAll(std::uint64_t* number) {
    int sent = 0;
    for (; window_.MaySend(now_); now_ += 1ms, ++sent)
      window_.OnSent(Sensor::kDepth, (*number)++, now_);
    return sent;
  }

  static constexpr std::size_t kMax = 28;
  BackfillWindow window_{kMax, 1e6};
  SteadyTime now_{1s};
};

TEST_F(BackfillWindowTest, GrowsWithWhatTheGroundConfirmsUpToItsLimit) {
  std::uint64_t next = 0;
  int sent = SendAll(&next);
  EXPECT_EQ(sent, 4) << "it begins with few";
  for (int receipt = 0; receipt < 6; ++receipt) {
    window_.OnReceipt(Sensor::kDepth, {{next, 1000}}, now_);
    EXPECT_EQ(window_.under_way(), 0U);
    sent = SendAll(&next);
  }
  EXPECT_EQ(sent, static_cast<int>(kMax));
  EXPECT_EQ(window_.confirmed(), next - kMax);
}

TEST_F(BackfillWindowTest, AWindowThatIsNotUsedUpDoesNotGrow) {
  for (std::uint64_t number = 0; number < 100; ++number) {
    window_.OnSent(Sensor::kDepth, number, now_);
    window_.OnReceipt(Sensor::kDepth, {{number + 1, 1000}}, now_);
  }
  std::uint64_t next = 100;
  EXPECT_EQ(SendAll(&next), 4);
}

TEST_F(BackfillWindowTest, FramesThatGotLostMayBeSentAgainAndFewerAreUnderWay) {
  std::uint64_t next = 0;
  for (int receipt = 0; receipt < 4; ++receipt) {
    SendAll(&next);
    window_.OnReceipt(Sensor::kDepth, {{next, 1000}}, now_);
  }
  const int before = SendAll(&next);
  const std::uint64_t first = next - static_cast<std::uint64_t>(before);
  window_.OnReceipt(Sensor::kDepth, {{first, 1000}}, now_);
  EXPECT_TRUE(window_.IsUnderWay(Sensor::kDepth, first)) << "it may still come";
  now_ += BackfillWindow::kLostAfter;
  window_.OnReceipt(Sensor::kDepth, {{first, 1000}}, now_);
  EXPECT_FALSE(window_.IsUnderWay(Sensor::kDepth, first));
  EXPECT_EQ(SendAll(&next), before / 2);
}

TEST_F(BackfillWindowTest, AFrameBeforeOneThatArrivedIsKnownToBeLost) {
  std::uint64_t next = 0;
  ASSERT_EQ(SendAll(&next), 4);
  window_.OnReceipt(Sensor::kDepth, {{0, 0}, {2, 1000}}, now_);
  EXPECT_FALSE(window_.IsUnderWay(Sensor::kDepth, 0)) << "to be sent again";
  EXPECT_TRUE(window_.IsUnderWay(Sensor::kDepth, 2)) << "it may still come";
  EXPECT_EQ(window_.confirmed(), 1U);
}

TEST_F(BackfillWindowTest, GivesWayToWhatIsLive) {
  std::uint64_t next = 0;
  for (int receipt = 0; receipt < 4; ++receipt) {
    SendAll(&next);
    window_.OnReceipt(Sensor::kDepth, {{next, 1000}}, now_);
  }
  for (int i = 0; i < 10; ++i) window_.OnLiveBehind();
  EXPECT_EQ(SendAll(&next), 2);
}

TEST_F(BackfillWindowTest, StreamsAreToldApart) {
  window_.OnSent(Sensor::kDepth, 7, now_);
  EXPECT_FALSE(window_.IsUnderWay(Sensor::kThermal, 7));
  window_.OnReceipt(Sensor::kThermal, {}, now_);
  EXPECT_TRUE(window_.IsUnderWay(Sensor::kDepth, 7));
}

TEST_F(BackfillWindowTest, SendsNoMorePerSecondThanItMay) {
  BackfillWindow window(1000, 100.0);
  std::uint64_t sent = 0;
  for (SteadyTime now(10s); now < SteadyTime(12s); now += 1ms) {
    // A pause, in which nothing was wanted, is not made up for.
    if (now > SteadyTime(10500ms) && now < SteadyTime(11s)) continue;
    while (window.MaySend(now)) {
      window.OnSent(Sensor::kDepth, sent++, now);
      window.OnReceipt(Sensor::kDepth, {{sent, 5000}}, now);
    }
  }
  EXPECT_GE(sent, 148U);
  EXPECT_LE(sent, 155U);
}

}  // namespace
}  // namespace isotherm
