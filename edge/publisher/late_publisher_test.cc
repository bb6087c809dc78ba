#include "edge/publisher/late_publisher.h"

#include <gtest/gtest.h>

#include <thread>

#include "edge/publisher/testing/fake_publisher.h"

namespace isotherm {
namespace {

/// A network that is there when the test says so.
class LatePublisherTest : public testing::Test {
 protected:
  ~LatePublisherTest() override { thread_.request_stop(); }

  void Run() {
    thread_ = std::jthread([this](const std::stop_token& stop) { late_.Run(stop, {}); });
  }
  Result<std::unique_ptr<Publisher>> Connect(const std::stop_token& stop,
                                             const LatePublisher::Waiting& waiting) {
    waiting(Unavailable("eth9 is not there"));
    told_ = true;
    while (!is_there_ && !stop.stop_requested()) std::this_thread::yield();
    if (!is_there_) return Err(Unavailable("told to stop"));
    auto publisher = std::make_unique<FakePublisher>();
    publisher_ = publisher.get();
    return publisher;
  }
  static void Await(const std::atomic<bool>& what) {
    while (!what) std::this_thread::yield();
  }

  std::atomic<bool> is_there_{false};
  std::atomic<bool> told_{false};
  FakePublisher* publisher_ = nullptr;
  LatePublisher late_{[this](const std::stop_token& stop, const LatePublisher::Waiting& waiting) {
    return Connect(stop, waiting);
  }};
  std::jthread thread_;
};

TEST_F(LatePublisherTest, F31WithoutANetworkFramesAreRefusedAndTheReasonIsKnown) {
  Run();
  Await(told_);
  EXPECT_EQ(late_.Publish(EncodedDepthFrame{}, {}).code(), StatusCode::kUnavailable);
  EXPECT_EQ(late_.stats().problem, "eth9 is not there");
  EXPECT_FALSE(late_.WaitForGround(std::chrono::milliseconds(1), {}));
  EXPECT_TRUE(late_.Drain(std::chrono::hours(1))) << "there is nothing to wait for";
}

TEST_F(LatePublisherTest, F31WhenTheNetworkIsThereFramesFlowWithTheChosenPolicy) {
  ASSERT_TRUE(late_.BeginSession({}, {}).ok());
  late_.SetPolicy(PublishPolicy::kLive);
  Run();
  is_there_ = true;
  ASSERT_TRUE(late_.WaitForGround(std::chrono::hours(1), {}));
  EXPECT_TRUE(late_.Publish(EncodedDepthFrame{}, {}).ok());
  EXPECT_EQ(publisher_->depth().size(), 1U);
  EXPECT_EQ(publisher_->policy(), PublishPolicy::kLive);
  EXPECT_EQ(publisher_->sessions(), 1);
  EXPECT_EQ(late_.stats().problem, "");
}

TEST_F(LatePublisherTest, WhatWasAnnouncedWithoutANetworkIsTheSessionsRigOnceItIsThere) {
  RigDescription rig;
  ASSERT_TRUE(late_.BeginSession(rig, {}).ok());
  rig.thermal.serial = "before";
  ASSERT_TRUE(late_.Announce(rig).ok());
  Run();
  is_there_ = true;
  ASSERT_TRUE(late_.WaitForGround(std::chrono::hours(1), {}));
  EXPECT_EQ(publisher_->session_rig().thermal.serial, "before");
  rig.thermal.serial = "after";
  ASSERT_TRUE(late_.Announce(rig).ok());
  ASSERT_EQ(publisher_->announced().size(), 1U);
  EXPECT_EQ(publisher_->announced()[0].thermal.serial, "after");
}

TEST_F(LatePublisherTest, F38AStopWhileThereIsNoNetworkIsServed) {
  Run();
  Await(told_);
  thread_.request_stop();
  thread_.join();
  EXPECT_EQ(late_.Publish(EncodedThermalFrame{}, {}).code(), StatusCode::kUnavailable);
}

}  // namespace
}  // namespace isotherm
