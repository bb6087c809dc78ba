#include "ground/subscriber/session_book.h"

#include <gtest/gtest.h>

namespace isotherm {
namespace {

using namespace std::chrono_literals;

constexpr Nanoseconds kGrace = 2s;

StreamTally Tally(std::uint64_t session, std::uint64_t received, std::uint64_t next) {
  return {.session = session,
          .next = next,
          .received = received,
          .late = 0,
          .duplicates = 0,
          .refused = {}};
}

EdgeStatus Status(std::uint64_t session, ScanState state, std::uint64_t depth,
                  std::uint64_t thermal) {
  EdgeStatus status;
  status.session = session;
  status.scan_state = state;
  status.depth.published = depth;
  status.thermal.published = thermal;
  return status;
}

class SessionBookTest : public ::testing::Test {
 protected:
  SessionBook book_{kGrace};
  SteadyTime now_{1h};
};

TEST_F(SessionBookTest, WhileScanningWhatIsNotHereIsMissing) {
  book_.OnFrame(1, now_);
  const SessionAccount account = book_.Account(Tally(1, 8, 10), Tally(1, 5, 5));
  EXPECT_EQ(account.depth.published, 10U);
  EXPECT_EQ(account.depth.missing, 2U);
  EXPECT_EQ(account.thermal.missing, 0U);
  EXPECT_FALSE(account.ended);
  EXPECT_EQ(book_.TryClose(Tally(1, 8, 10), Tally(1, 5, 5), now_ + 1h), std::nullopt);
}

TEST_F(SessionBookTest, F19PublishedIsReceivedPlusMissingAtTheEnd) {
  book_.OnFrame(1, now_);
  book_.OnStatus(Status(1, ScanState::kEnded, 9, 5), now_);
  // Numbers up to 9 were seen, but the edge published only 9 of these 10: it dropped one itself.
  const SessionAccount account = book_.Account(Tally(1, 8, 10), Tally(1, 5, 5));
  EXPECT_TRUE(account.ended);
  EXPECT_EQ(account.depth.published, 9U);
  EXPECT_EQ(account.depth.received, 8U);
  EXPECT_EQ(account.depth.missing, 1U);
}

TEST_F(SessionBookTest, TheLastStatusSaysHowSoonFeedbackArrived) {
  EdgeStatus status = Status(1, ScanState::kScanning, 9, 5);
  status.feedback = {.count = 10, .p50_s = 0.05, .p99_s = 0.10};
  book_.OnStatus(status, now_);
  status.scan_state = ScanState::kEnded;
  status.feedback = {.count = 20, .p50_s = 0.06, .p99_s = 0.12};
  book_.OnStatus(status, now_);
  const SessionAccount account = book_.Account(Tally(1, 9, 9), Tally(1, 5, 5));
  EXPECT_EQ(account.feedback.count, 20U);
  EXPECT_EQ(account.feedback.p99_s, 0.12);
}

TEST_F(SessionBookTest, ACompleteSessionClosesAtOnceAndOnce) {
  book_.OnFrame(1, now_);
  book_.OnStatus(Status(1, ScanState::kEnded, 10, 5), now_);
  EXPECT_EQ(book_.TryClose(Tally(1, 9, 10), Tally(1, 5, 5), now_), std::nullopt);
  const auto account = book_.TryClose(Tally(1, 10, 10), Tally(1, 5, 5), now_);
  ASSERT_TRUE(account.has_value());
  EXPECT_TRUE(account->closed);
  EXPECT_EQ(account->depth.missing + account->thermal.missing, 0U);
  EXPECT_EQ(book_.TryClose(Tally(1, 10, 10), Tally(1, 5, 5), now_), std::nullopt);
  EXPECT_EQ(book_.oldest_open(), std::nullopt);
}

TEST_F(SessionBookTest, LostFramesAreGivenUpAfterTheGraceTime) {
  book_.OnFrame(1, now_);
  book_.OnStatus(Status(1, ScanState::kEnded, 10, 0), now_);
  ASSERT_EQ(book_.deadline(), now_ + kGrace);
  book_.OnStatus(Status(1, ScanState::kEnded, 10, 0), now_ + 1s);  // A repeat changes nothing.
  EXPECT_EQ(book_.TryClose(Tally(1, 9, 10), Tally(1, 0, 0), now_ + kGrace - 1ns), std::nullopt);
  const auto account = book_.TryClose(Tally(1, 9, 10), Tally(1, 0, 0), now_ + kGrace);
  ASSERT_TRUE(account.has_value());
  EXPECT_EQ(account->depth.missing, 1U);
}

TEST_F(SessionBookTest, ASessionThatNeverEndedClosesWhenAnotherHasBegun) {
  book_.OnFrame(1, now_);
  book_.OnFrame(2, now_ + 1s);
  EXPECT_EQ(book_.oldest_open(), 1U);
  const auto account = book_.TryClose(Tally(1, 4, 4), Tally(1, 4, 4), now_ + kGrace);
  ASSERT_TRUE(account.has_value());
  EXPECT_FALSE(account->ended);
  EXPECT_EQ(book_.oldest_open(), 2U);
  EXPECT_EQ(book_.newest(), 2U);
}

TEST_F(SessionBookTest, AnIdleEdgeOpensNoSession) {
  book_.OnStatus(Status(0, ScanState::kIdle, 0, 0), now_);
  EXPECT_EQ(book_.newest(), std::nullopt);
}

}  // namespace
}  // namespace isotherm
