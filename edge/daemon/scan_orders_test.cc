#include "edge/daemon/scan_orders.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace isotherm {
namespace {

using State = ScanOrders::State;

class ScanOrdersTest : public ::testing::Test {
 protected:
  CommandOutcome Order(CommandKind kind) {
    const CommandResult answer = orders_.Execute({.number = ++number_, .kind = kind});
    EXPECT_EQ(answer.number, number_);
    EXPECT_FALSE(answer.text.empty()) << "the operator sees the text";
    return answer.outcome;
  }
  CommandOutcome Start() { return Order(CommandKind::kStartScan); }
  CommandOutcome Stop() { return Order(CommandKind::kStopScan); }

  ScanOrders orders_;
  std::uint64_t number_ = 0;
};

TEST_F(ScanOrdersTest, AScanIsStoppedAndTheNextOneBegins) {
  EXPECT_EQ(Stop(), CommandOutcome::kDone);
  EXPECT_EQ(orders_.state(), State::kEnding);
  EXPECT_TRUE(orders_.NoteFinished());
  EXPECT_EQ(orders_.state(), State::kEnded);
  EXPECT_EQ(Start(), CommandOutcome::kDone);
  EXPECT_EQ(orders_.state(), State::kStarting);
}

TEST_F(ScanOrdersTest, TheRecordingIsClosedOnce) {
  EXPECT_TRUE(orders_.NoteFinished()) << "also when the source ends by itself";
  EXPECT_FALSE(orders_.NoteFinished());
  EXPECT_EQ(Start(), CommandOutcome::kDone);
  EXPECT_FALSE(orders_.NoteFinished());
}

TEST_F(ScanOrdersTest, OrdersThatDoNotFitAreRefusedAndChangeNothing) {
  EXPECT_EQ(Start(), CommandOutcome::kRefused) << "a scan is under way";
  EXPECT_EQ(orders_.state(), State::kScanning);
  EXPECT_EQ(Stop(), CommandOutcome::kDone);
  EXPECT_EQ(Stop(), CommandOutcome::kRefused) << "it ends already";
  EXPECT_EQ(Start(), CommandOutcome::kRefused) << "frames are under way";
  EXPECT_EQ(orders_.state(), State::kEnding);
  EXPECT_TRUE(orders_.NoteFinished());
  EXPECT_EQ(Stop(), CommandOutcome::kRefused) << "there is none";
  EXPECT_EQ(orders_.state(), State::kEnded);
  EXPECT_EQ(Start(), CommandOutcome::kDone);
  EXPECT_EQ(Start(), CommandOutcome::kRefused);
  EXPECT_EQ(Stop(), CommandOutcome::kRefused);
  EXPECT_EQ(orders_.state(), State::kStarting);
}

}  // namespace
}  // namespace isotherm
