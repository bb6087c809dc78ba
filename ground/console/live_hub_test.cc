#include "ground/console/live_hub.h"

#include <gtest/gtest.h>

#include <vector>

namespace isotherm {
namespace {

LiveMessagePtr HubMessage(LiveKind kind, std::uint64_t model, int x = 0) {
  auto message = std::make_shared<LiveMessage>();
  message->slot = {kind, {.map = 0, .x = x, .y = 0, .z = 0}};
  message->model = model;
  message->bytes = "12345";
  return message;
}

class LiveHubTest : public ::testing::Test {
 protected:
  LiveClient MakeClient(int& wakes) {
    return {.mailbox = ClientMailbox({}, SteadyTime{}), .wake = [&wakes] { ++wakes; }};
  }
  static std::size_t TakeAll(LiveClient& client) {
    std::size_t count = 0;
    while (client.mailbox.Take(SteadyTime{std::chrono::hours(1)})) ++count;
    return count;
  }
  LiveHub hub_;
};

TEST_F(LiveHubTest, WhoComesLaterGetsEverythingThatIsKept) {
  hub_.Publish(HubMessage(LiveKind::kScan, 1));
  hub_.Publish(HubMessage(LiveKind::kGroup, 1, 1));
  hub_.Publish(HubMessage(LiveKind::kGroup, 1, 2));
  hub_.Publish(HubMessage(LiveKind::kGroup, 1, 2));
  int wakes = 0;
  LiveClient client = MakeClient(wakes);
  hub_.Join(client);
  EXPECT_EQ(wakes, 1);
  EXPECT_EQ(TakeAll(client), 3U);
  hub_.Leave(client);
}

TEST_F(LiveHubTest, EveryClientHearsOfWhatIsNew) {
  int first_wakes = 0, second_wakes = 0;
  LiveClient first = MakeClient(first_wakes), second = MakeClient(second_wakes);
  hub_.Join(first);
  hub_.Join(second);
  hub_.Publish(HubMessage(LiveKind::kPose, 1));
  EXPECT_EQ(TakeAll(first), 1U);
  EXPECT_EQ(TakeAll(second), 1U);
  EXPECT_EQ(first_wakes, 2);
  hub_.Leave(first);
  hub_.Publish(HubMessage(LiveKind::kPose, 1));
  EXPECT_EQ(first_wakes, 2);
  EXPECT_EQ(hub_.clients(), 1U);
  hub_.Leave(second);
}

TEST_F(LiveHubTest, ANewModelVoidsWhatIsKept) {
  hub_.Publish(HubMessage(LiveKind::kScan, 1));
  hub_.Publish(HubMessage(LiveKind::kGroup, 1, 1));
  hub_.Publish(HubMessage(LiveKind::kScan, 2));
  EXPECT_EQ(hub_.kept(), 1U);
  EXPECT_EQ(hub_.model(), 2U);
  ASSERT_NE(hub_.Kept(LiveKind::kScan), nullptr);
  EXPECT_EQ(hub_.Kept(LiveKind::kState), nullptr);
}

}  // namespace
}  // namespace isotherm
