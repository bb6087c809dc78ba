#include "edge/publisher/arrival_watch.h"

#include <gtest/gtest.h>

namespace isotherm {
namespace {

using namespace std::chrono_literals;

constexpr PeerHandle kGround = 7;

/// A rig at 30 + 40 frames per second and a ground that says five times a second what it has.
class ArrivalWatchTest : public ::testing::Test {
 protected:
  void Run(Nanoseconds duration, bool publishes, bool arrives, bool is_heard) {
    for (const SteadyTime end = now_ + duration; now_ < end; now_ += 200ms) {
      if (publishes) {
        published_[0] += 6;
        published_[1] += 8;
      }
      if (arrives) arrived_ = published_;
      Receipt receipt;
      receipt.depth.next = arrived_[0];
      receipt.thermal.next = arrived_[1];
      if (is_heard) watch_.OnReceipt(kGround, receipt, now_);
      watch_.Look(published_, waits_, now_);
    }
  }

  SteadyTime now_{1h};
  std::array<std::uint64_t, 2> published_{}, arrived_{};
  bool waits_ = false;
  ArrivalWatch watch_;
};

TEST_F(ArrivalWatchTest, F29ReceiptsWithoutProgressAreNoticedWithinFourSeconds) {
  Run(10s, true, true, true);
  EXPECT_EQ(watch_.unheard_by(), 0U);
  Run(2s, true, false, true);
  EXPECT_EQ(watch_.unheard_by(), 0U) << "a link may be slow";
  Run(2s, true, false, true);
  EXPECT_EQ(watch_.unheard_by(), kGround);
  Run(20s, true, false, false);
  EXPECT_EQ(watch_.unheard_by(), kGround)
      << "the middleware has forgotten this side, nothing is better";
  Run(1s, true, true, true);
  EXPECT_EQ(watch_.unheard_by(), 0U);
}

TEST_F(ArrivalWatchTest, F29AGroundThatIsNotHeardIsAnotherMatter) {
  Run(10s, true, true, true);
  Run(20s, true, false, false);
  EXPECT_EQ(watch_.unheard_by(), 0U);
  Run(400ms, true, false, true);
  EXPECT_EQ(watch_.unheard_by(), 0U) << "it is back, and frames are a little behind its receipts";
  Run(1s, true, true, true);
  EXPECT_EQ(watch_.unheard_by(), 0U);
}

TEST_F(ArrivalWatchTest, F29ALastFrameThatGotLostSaysNothing) {
  Run(10s, true, true, true);
  Run(200ms, true, false, true);
  ++published_[0];
  Run(60s, false, false, true);
  EXPECT_EQ(watch_.unheard_by(), 0U);
}

TEST_F(ArrivalWatchTest, F29WhoWaitsForReceiptsNeedsNoMoreFrames) {
  Run(10s, true, true, true);
  Run(200ms, true, false, true);
  waits_ = true;
  Run(4s, false, false, true);
  EXPECT_EQ(watch_.unheard_by(), kGround);
}

}  // namespace
}  // namespace isotherm
