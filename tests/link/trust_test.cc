// Whom the edge believes: who is the ground station of this rig, and what it can have seen.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/base/mutex.h"
#include "common/transport/endpoints.h"
#include "common/transport/testing/test_domain.h"
#include "ground/subscriber/subscriber.h"
#include "tests/link/edge_side.h"

namespace isotherm {
namespace {

using namespace std::chrono_literals;
using ::testing::ElementsAre;

constexpr std::uint64_t kSession = 1;
constexpr std::uint64_t kFarAhead = std::uint64_t{1} << 40U;

/// Somebody on the network who reads frames and can write what a ground station writes.
class Peer {
 public:
  Peer(const TransportEnvironment& environment, int domain)
      : participant_(std::move(*Participant::Create(environment, domain))) {
    EXPECT_TRUE(depth_.Open(*participant_, &refusals_).ok());
    EXPECT_TRUE(thermal_.Open(*participant_, &refusals_).ok());
    EXPECT_TRUE(hello_.Open(*participant_).ok());
    EXPECT_TRUE(receipt_.Open(*participant_).ok());
    EXPECT_TRUE(feedback_.Open(*participant_).ok());
  }
  void SayHelloAsGround() {
    EXPECT_TRUE(hello_.Write("a ground", Hello{.role = Role::kGround}).ok());
  }
  void AwaitEdge() {
    const auto deadline = std::chrono::steady_clock::now() + kLinkPatience;
    while ((depth_.matched_writers() == 0 || thermal_.matched_writers() == 0 ||
            receipt_.matched_readers() == 0 || feedback_.matched_readers() == 0) &&
           std::chrono::steady_clock::now() < deadline) {
      std::this_thread::yield();
    }
  }
  void Send(const Receipt& receipt) { EXPECT_TRUE(receipt_.Write("test-edge", receipt).ok()); }
  void Send(const Feedback& feedback) { EXPECT_TRUE(feedback_.Write("test-edge", feedback).ok()); }

 private:
  RefusalCounter refusals_;
  std::unique_ptr<Participant> participant_;
  Reader<EncodedDepthFrame> depth_;
  Reader<EncodedThermalFrame> thermal_;
  Writer<Hello> hello_;
  Writer<Receipt> receipt_;
  Writer<Feedback> feedback_;
};

class TrustTest : public ::testing::Test {
 protected:
  EdgePlan Plan(std::uint64_t frames) const {
    return {.domain = domain_.number(),
            .session = kSession,
            .depth_frames = frames,
            .thermal_frames = frames,
            .policy = PublishPolicy::kLossless};
  }
  static Receipt MakeReceipt(std::uint64_t next) {
    Receipt receipt{.session = kSession, .depth = {}, .thermal = {}, .clock_ping = 0};
    receipt.depth = {.next = next, .handled = next, .received = 1, .holes = {}};
    return receipt;
  }
  static bool AwaitRefused(const Publisher& publisher, std::uint64_t count) {
    const auto deadline = std::chrono::steady_clock::now() + kLinkPatience;
    while (publisher.stats().refused < count && std::chrono::steady_clock::now() < deadline) {
      std::this_thread::yield();
    }
    return publisher.stats().refused == count;
  }

  SystemClock clock_;
  TransportEnvironment environment_{clock_};
  TestDomain domain_;
};

TEST_F(TrustTest, AnOnlookerIsNotWaitedFor) {
  Peer onlooker(environment_, domain_.number());
  EdgeSide edge(environment_, clock_, Plan(100));
  onlooker.AwaitEdge();
  EXPECT_FALSE(edge.publisher().WaitForGround(1ms, {}));
  edge.Begin();
  edge.SendFrames(0, 100);
  EXPECT_TRUE(edge.End());
  EXPECT_LE(edge.publisher().stats().flow_waits, 2U) << "for half a second: it may yet say hello";
  EXPECT_EQ(edge.publisher().stats().flow_timeouts, 0U);
}

TEST_F(TrustTest, TheGroundOfAnotherRigIsNotWaitedFor) {
  const auto participant = std::move(*Participant::Create(environment_, domain_.number()));
  SubscriberOptions options;
  options.edge_id = "another-rig";
  const auto subscriber = std::move(*Subscriber::Create(*participant, clock_, options, {}));
  const std::jthread receiver([&](const std::stop_token& stop) { subscriber->Run(stop); });
  EdgeSide edge(environment_, clock_, Plan(100));
  edge.Begin();
  edge.SendFrames(0, 100);
  EXPECT_FALSE(edge.publisher().WaitForGround(1ms, {}));
  EXPECT_TRUE(edge.End());
  EXPECT_EQ(edge.publisher().stats().flow_timeouts, 0U);
}

TEST_F(TrustTest, F60AReceiptOfMoreThanThereWasOpensNothing) {
  constexpr std::uint64_t kFrames = 24;  // As many as may be under way.
  Peer ground(environment_, domain_.number());
  ground.SayHelloAsGround();
  EdgeSide edge(environment_, clock_, Plan(kFrames));
  ground.AwaitEdge();
  edge.Begin();
  edge.SendFrames(0, kFrames);
  ground.Send(MakeReceipt(1));
  ASSERT_TRUE(edge.publisher().WaitForGround(kLinkPatience, {}));
  ground.Send(MakeReceipt(kFarAhead));
  EXPECT_TRUE(AwaitRefused(edge.publisher(), 1));
  Receipt too_many = MakeReceipt(2);
  too_many.thermal = {.next = kFrames + 1, .handled = 0, .received = kFrames + 1, .holes = {}};
  ground.Send(too_many);
  EXPECT_TRUE(AwaitRefused(edge.publisher(), 2));
  EXPECT_EQ(edge.publisher().receipt()->depth.next, 1U);

  // One of the window was handled: there is room for one, and for no more. Whoever is told to stop
  // waits for a moment only.
  std::stop_source stop;
  stop.request_stop();
  for (std::uint64_t i = kFrames; i < kFrames + 2; ++i) {
    EXPECT_TRUE(edge.publisher()
                    .Publish(MakeFrame<EncodedDepthFrame>(kSession, i, 8, 6), stop.get_token())
                    .ok());
    EXPECT_EQ(edge.publisher().stats().flow_waits, i - kFrames);
  }
}

TEST_F(TrustTest, F60WhoIsNotAGroundStationIsNotBelieved) {
  Peer somebody(environment_, domain_.number());
  EdgeSide edge(environment_, clock_, Plan(2));
  somebody.AwaitEdge();
  edge.Begin();
  edge.SendFrames(0, 2);
  somebody.Send(MakeReceipt(2));
  EXPECT_TRUE(AwaitRefused(edge.publisher(), 1));
  EXPECT_FALSE(edge.publisher().receipt().has_value());
  EXPECT_FALSE(edge.publisher().stats().ground_present);
}

TEST_F(TrustTest, F60OnlyFeedbackOnAFrameThatWasPublishedIsTaken) {
  Mutex mutex;
  std::vector<std::uint64_t> taken;
  PublisherHandlers handlers;
  handlers.feedback = [&](const Feedback& feedback, CaptureTime, bool) {
    const MutexLock lock(mutex);
    taken.push_back(feedback.frame_number);
  };
  Peer ground(environment_, domain_.number());
  Peer somebody(environment_, domain_.number());
  EdgeSide edge(environment_, clock_, Plan(10), handlers);
  ground.AwaitEdge();
  somebody.AwaitEdge();
  ground.SayHelloAsGround();
  edge.Begin();
  edge.SendFrames(0, 10);
  ground.Send(MakeReceipt(1));
  ASSERT_TRUE(edge.publisher().WaitForGround(kLinkPatience, {}));

  Feedback good;
  good.session = kSession;
  good.frame_number = 7;
  good.capture_time = MakeFrame<EncodedDepthFrame>(kSession, 7, 8, 6).header.capture_time;
  somebody.Send(good);
  EXPECT_TRUE(AwaitRefused(edge.publisher(), 1)) << "not from a ground station";
  const std::vector<std::function<void(Feedback&)>> forgeries = {
      [](Feedback& f) { f.session = kSession + 1; },
      [](Feedback& f) { f.frame_number = 10; },
      [](Feedback& f) { f.frame_number = kFarAhead; },
      [](Feedback& f) { f.capture_time += 24h * 365 * 200; },
      [](Feedback& f) { f.capture_time += 1ns; },
  };
  for (std::size_t i = 0; i < forgeries.size(); ++i) {
    Feedback forged = good;
    forgeries[i](forged);
    ground.Send(forged);
    EXPECT_TRUE(AwaitRefused(edge.publisher(), 2 + i)) << "forgery " << i;
  }
  ground.Send(good);
  Feedback last = good;
  last.session = kSession + 1;
  ground.Send(last);  // In order: when this one has been refused, the one before has been taken.
  EXPECT_TRUE(AwaitRefused(edge.publisher(), 2 + forgeries.size()));
  const MutexLock lock(mutex);
  EXPECT_THAT(taken, ElementsAre(7));
}

}  // namespace
}  // namespace isotherm
