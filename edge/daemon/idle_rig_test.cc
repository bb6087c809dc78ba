#include "edge/daemon/idle_rig.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <thread>

#include "edge/publisher/testing/fake_publisher.h"

namespace isotherm {
namespace {

using ::testing::HasSubstr;
using ::testing::SizeIs;

TEST(IdleRigTest, OnlyTheOrderToStartAScanEndsTheWait) {
  FakePublisher publisher;
  publisher.commands = {{.number = 1, .kind = CommandKind::kStopScan},
                        {.number = 2, .kind = CommandKind::kTriggerNuc},
                        {.number = 3, .kind = CommandKind::kStartScan}};
  SystemClock clock;
  EXPECT_TRUE(WaitForScanOrder(publisher, clock, {}));
  const std::vector<CommandResult> answers = publisher.answers();
  ASSERT_THAT(answers, SizeIs(3));
  EXPECT_EQ(answers[0].outcome, CommandOutcome::kRefused);
  EXPECT_THAT(answers[1].text, HasSubstr("no scan is under way"));
  EXPECT_EQ(answers[2].number, 3U);
  EXPECT_EQ(answers[2].outcome, CommandOutcome::kDone);
  EXPECT_EQ(publisher.sessions(), 0);
  for (const EdgeStatus& status : publisher.statuses())
    EXPECT_EQ(status.scan_state, ScanState::kIdle);
}

TEST(IdleRigTest, ItLeavesWhenItIsToldTo) {
  FakePublisher publisher;
  SystemClock clock;
  std::stop_source stop;
  std::jthread leaving([&] {
    while (publisher.statuses().empty()) std::this_thread::yield();
    stop.request_stop();
  });
  EXPECT_FALSE(WaitForScanOrder(publisher, clock, stop.get_token()));
}

}  // namespace
}  // namespace isotherm
