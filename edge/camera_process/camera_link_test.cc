#include "edge/camera_process/camera_link.h"

#include <gtest/gtest.h>
#include <sys/socket.h>

#include <memory>
#include <string>

#include "edge/camera_process/camera_link.pb.h"

namespace isotherm {
namespace {

using Received = CameraLink::Received;

constexpr Nanoseconds kWait = std::chrono::seconds(5);

struct Ends {
  std::unique_ptr<CameraLink> edge, camera;
};

Ends Connect() {
  int ends[2];
  EXPECT_EQ(::socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, ends), 0);
  return {std::make_unique<CameraLink>(ends[0]), std::make_unique<CameraLink>(ends[1])};
}

FromCamera Failure(const std::string& why) {
  FromCamera message;
  ToLink(DataLoss(why), message.mutable_failed());
  return message;
}

TEST(CameraLinkTest, MessagesArriveWholeAndInOrder) {
  const Ends ends = Connect();
  ASSERT_TRUE(ends.camera->Send(Failure("first")));
  ASSERT_TRUE(ends.camera->Send(Failure("second")));
  for (const char* expected : {"first", "second"}) {
    FromCamera message;
    ASSERT_EQ(ends.edge->Receive(&message, kWait), Received::kMessage);
    EXPECT_EQ(message.failed().message(), expected);
  }
  FromCamera message;
  EXPECT_EQ(ends.edge->Receive(&message, Nanoseconds(0)), Received::kNothingYet);
}

TEST(CameraLinkTest, LastWordsOfAProcessThatLeavesWithoutReadingItsOrdersArrive) {
  Ends ends = Connect();
  ToCamera order;
  order.set_free_slot(1);
  ASSERT_TRUE(ends.edge->Send(order));
  ASSERT_TRUE(ends.camera->Send(Failure("first")));
  ASSERT_TRUE(ends.camera->Send(Failure("the camera sends nonsense")));
  ends.camera.reset();  // The order lies there unread: the kernel tells the edge of a reset.
  for (const char* expected : {"first", "the camera sends nonsense"}) {
    FromCamera message;
    ASSERT_EQ(ends.edge->Receive(&message, kWait), Received::kMessage) << expected;
    EXPECT_EQ(message.failed().message(), expected);
  }
  FromCamera message;
  EXPECT_EQ(ends.edge->Receive(&message, kWait), Received::kClosed);
}

}  // namespace
}  // namespace isotherm
