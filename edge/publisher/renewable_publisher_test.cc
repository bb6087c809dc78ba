#include "edge/publisher/renewable_publisher.h"

#include <gtest/gtest.h>

#include <atomic>
#include <functional>
#include <memory>
#include <thread>

#include "edge/publisher/testing/fake_publisher.h"
#include "edge/publisher/testing/idle_publisher.h"

namespace isotherm {
namespace {

/// A network that is there when the test says so.
class RenewablePublisherTest : public testing::Test {
 protected:
  ~RenewablePublisherTest() override { thread_.request_stop(); }

  void Run() {
    thread_ = std::jthread([this](const std::stop_token& stop) { late_.Run(stop, {}); });
  }
  Result<std::shared_ptr<Publisher>> Connect(const std::stop_token& stop,
                                             const RenewablePublisher::Waiting& waiting) {
    waiting(Unavailable("eth9 is not there"));
    told_ = true;
    while (!is_there_ && !stop.stop_requested()) std::this_thread::yield();
    if (!is_there_) return Err(Unavailable("told to stop"));
    auto publisher = std::make_shared<FakePublisher>();
    publisher_ = publisher.get();
    return publisher;
  }
  static void Await(const std::atomic<bool>& what) {
    while (!what) std::this_thread::yield();
  }

  std::atomic<bool> is_there_{false};
  std::atomic<bool> told_{false};
  FakePublisher* publisher_ = nullptr;
  SystemClock clock_;
  RenewablePublisher late_{
      [this](const std::stop_token& stop, const RenewablePublisher::Waiting& waiting) {
        return Connect(stop, waiting);
      },
      [] { return std::string("eth9 192.168.50.1"); }, clock_};
  std::jthread thread_;
};

TEST_F(RenewablePublisherTest, F31WithoutANetworkFramesAreRefusedAndTheReasonIsKnown) {
  Run();
  Await(told_);
  EXPECT_EQ(late_.Publish(EncodedDepthFrame{}, {}).code(), StatusCode::kUnavailable);
  EXPECT_EQ(late_.stats().problem, "eth9 is not there");
  EXPECT_FALSE(late_.WaitForGround(std::chrono::milliseconds(1), {}));
  EXPECT_TRUE(late_.Drain(std::chrono::hours(1))) << "there is nothing to wait for";
}

TEST_F(RenewablePublisherTest, F31WhenTheNetworkIsThereFramesFlowWithTheChosenPolicy) {
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

TEST_F(RenewablePublisherTest, WhatWasAnnouncedWithoutANetworkIsTheSessionsRigOnceItIsThere) {
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

TEST_F(RenewablePublisherTest, F38AStopWhileThereIsNoNetworkIsServed) {
  Run();
  Await(told_);
  thread_.request_stop();
  thread_.join();
  EXPECT_EQ(late_.Publish(EncodedThermalFrame{}, {}).code(), StatusCode::kUnavailable);
}

/// A link that counts what it publishes, and keeps what it was told of the links before.
class CountingLink final : public IdlePublisher {
 public:
  void Run(std::stop_token stop, const PublisherHandlers&) override {
    while (!stop.stop_requested()) std::this_thread::yield();
  }
  Status BeginSession(const RigDescription&, const SessionBefore& before) override {
    before_ = before;
    published_ = before.depth.frames;
    return OkStatus();
  }
  Status Publish(const EncodedDepthFrame& frame, std::stop_token) override {
    ++published_;
    next_ = frame.header.frame_number + 1;
    return OkStatus();
  }
  Result<bool> Backfill(const EncodedDepthFrame&, int, const std::stop_token&) override {
    return false;
  }
  Result<bool> Backfill(const EncodedThermalFrame&, int, const std::stop_token&) override {
    return false;
  }
  PublisherStats stats() const override {
    PublisherStats stats;
    stats.depth = {.published = published_, .next_frame_number = next_};
    if (is_heard) stats.receipt_age = Nanoseconds(0);
    return stats;
  }
  std::optional<Receipt> receipt() const override { return std::nullopt; }
  SessionBefore so_far() const override {
    SessionBefore so_far = before_;
    so_far.depth.frames = published_;
    for (std::uint64_t number = 0; number < next_; ++number) so_far.depth.numbers.Add(number);
    return so_far;
  }
  SessionBefore before() const { return before_; }

  std::atomic<bool> is_heard{true};

 private:
  SessionBefore before_;
  std::atomic<std::uint64_t> published_{0}, next_{0};
};

/// A computer whose addresses change when the test says so.
class MovedComputerTest : public testing::Test {
 protected:
  ~MovedComputerTest() override { thread_.request_stop(); }

  void Start() {
    link_.Start(first_, "wlan0 192.168.50.1");
    ASSERT_TRUE(link_.BeginSession({}, {}).ok());
    thread_ = std::jthread([this](const std::stop_token& stop) { link_.Run(stop, {}); });
  }
  void Publish(std::uint64_t number) {
    EncodedDepthFrame frame;
    frame.header.frame_number = number;
    EXPECT_TRUE(link_.Publish(frame, {}).ok());
  }
  /// Lets time go on until `what`, or until the addresses were looked at that often.
  bool LooksUntil(const std::function<bool()>& what, int looks) {
    for (const int end = looks_ + looks; looks_ < end;) {
      if (what()) return true;
      clock_.Advance(std::chrono::seconds(1));
      const int seen = looks_;
      while (looks_ == seen && !what()) std::this_thread::yield();
    }
    return what();
  }

  FakeClock clock_;
  std::atomic<bool> has_moved_{false};
  std::atomic<int> looks_{0}, links_{1};
  std::shared_ptr<CountingLink> first_ = std::make_shared<CountingLink>();
  const std::shared_ptr<CountingLink> second_ = std::make_shared<CountingLink>();
  RenewablePublisher link_{
      [this](const std::stop_token&,
             const RenewablePublisher::Waiting&) -> Result<std::shared_ptr<Publisher>> {
        ++links_;
        return second_;
      },
      [this] {
        ++looks_;
        return std::string(has_moved_ ? "wlan0 10.0.0.7" : "wlan0 192.168.50.1");
      },
      clock_};
  std::jthread thread_;
};

TEST_F(MovedComputerTest, F30AChangedAddressMakesTheLinkAnewAndTheCountsGoOn) {
  ASSERT_NO_FATAL_FAILURE(Start());
  for (std::uint64_t number = 0; number < 5; ++number) Publish(number);
  const std::weak_ptr<CountingLink> old = first_;
  first_->is_heard = false;
  first_.reset();
  has_moved_ = true;
  ASSERT_TRUE(LooksUntil([this] { return links_ == 2; }, 20));
  ASSERT_TRUE(link_.WaitForGround(std::chrono::hours(1), {}));
  EXPECT_TRUE(old.expired()) << "the old one is gone: the middleware is joined once only";
  EXPECT_EQ(second_->before().depth.frames, 5U);
  EXPECT_EQ(second_->before().depth.numbers.next(), 5U);
  Publish(5);
  EXPECT_EQ(link_.stats().depth.published, 6U);
}

TEST_F(MovedComputerTest, F30AnAddressThatDoesNoHarmChangesNothing) {
  ASSERT_NO_FATAL_FAILURE(Start());
  has_moved_ = true;
  EXPECT_FALSE(LooksUntil([this] { return links_ == 2; }, 7)) << "the ground is heard";
}

TEST_F(MovedComputerTest, ASilentGroundAloneChangesNothing) {
  ASSERT_NO_FATAL_FAILURE(Start());
  first_->is_heard = false;
  EXPECT_FALSE(LooksUntil([this] { return links_ == 2; }, 7));
}

}  // namespace
}  // namespace isotherm
