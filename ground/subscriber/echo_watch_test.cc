#include "ground/subscriber/echo_watch.h"

#include <gtest/gtest.h>

namespace isotherm {
namespace {

using namespace std::chrono_literals;

constexpr PeerHandle kRig = 7;

class EchoWatchTest : public ::testing::Test {
 protected:
  /// Statuses as they come, once a second. `hears`: the rig has got another ping.
  void Statuses(int count, bool hears) {
    for (int i = 0; i < count; ++i) {
      now_ += 1s;
      if (hears) ++ping_;
      EdgeStatus status;
      if (ping_ > 0) status.clock_echo = ClockEcho{.ping = ping_};
      watch_.OnStatus(kRig, status, now_);
    }
  }

  SteadyTime now_{1h};
  std::uint64_t ping_ = 0;  ///< The newest that the rig has got.
  EchoWatch watch_;
};

TEST_F(EchoWatchTest, F29StatusesThatEchoNothingAreOfARigThatHearsNothing) {
  Statuses(5, true);
  EXPECT_EQ(watch_.deaf_rig(), 0U);
  Statuses(3, false);
  EXPECT_EQ(watch_.deaf_rig(), 0U) << "receipts get lost, too";
  Statuses(1, false);
  EXPECT_EQ(watch_.deaf_rig(), kRig);
  Statuses(1, true);
  EXPECT_EQ(watch_.deaf_rig(), 0U);
}

TEST_F(EchoWatchTest, F29ARigThatHasNeverHeardTheGroundIsNoticed) {
  Statuses(3, false);
  EXPECT_EQ(watch_.deaf_rig(), 0U);
  Statuses(2, false);
  EXPECT_EQ(watch_.deaf_rig(), kRig);
}

TEST_F(EchoWatchTest, F29SilenceOfTheRigSaysNothing) {
  Statuses(2, true);
  now_ += 1h;
  EXPECT_EQ(watch_.deaf_rig(), 0U);
  Statuses(1, false);
  EXPECT_EQ(watch_.deaf_rig(), 0U) << "its first status goes out before it can have heard anything";
  ping_ = 0;  // Another process of it.
  now_ += 1h;
  Statuses(2, false);
  EXPECT_EQ(watch_.deaf_rig(), 0U);
}

}  // namespace
}  // namespace isotherm
