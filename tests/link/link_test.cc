// The edge's and the ground's end of the link together, over DDS on loopback, in one process and in
// two.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <condition_variable>
#include <csignal>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <tuple>
#include <vector>

#include "common/concurrency/latest_value.h"
#include "common/transport/testing/test_domain.h"
#include "tests/link/edge_side.h"
#include "tests/link/ground_side.h"
#include "tests/support/machine_load.h"
#include "tests/support/process.h"

namespace isotherm {
namespace {

using namespace std::chrono_literals;

class LinkTest : public ::testing::Test {
 protected:
  EdgePlan Plan(std::uint64_t depth, std::uint64_t thermal) const {
    EdgePlan plan;
    plan.domain = domain_.number();
    plan.depth_frames = depth;
    plan.thermal_frames = thermal;
    plan.wait_for_ground = kLinkPatience;
    return plan;
  }
  static system_test::Command Peer(const EdgePlan& plan) {
    return {.program = LINK_PEER,
            .arguments = {std::to_string(plan.domain), std::to_string(plan.session),
                          std::to_string(plan.depth_frames), std::to_string(plan.thermal_frames),
                          std::to_string(plan.depth_hz),
                          plan.policy == PublishPolicy::kLive ? "live" : "lossless",
                          std::to_string(plan.wait_for_ground / 1s)},
            .environment = {}};
  }
  std::unique_ptr<GroundSide> StartGround(Nanoseconds work_per_frame = Nanoseconds(0)) {
    return std::make_unique<GroundSide>(environment_, clock_, domain_.number(), work_per_frame);
  }
  static void ExpectEverything(const EdgePlan& plan, GroundSide& ground) {
    const auto counters = ground.AwaitSessionEnd();
    ASSERT_TRUE(counters.has_value());
    EXPECT_TRUE(counters->ended);
    EXPECT_EQ(counters->session, plan.session);
    EXPECT_EQ(counters->depth.published, plan.depth_frames);
    EXPECT_EQ(counters->depth.missing, 0U);
    EXPECT_EQ(counters->thermal.published, plan.thermal_frames);
    EXPECT_EQ(counters->thermal.missing, 0U);
    EXPECT_EQ(ground.depth(), Range(0, plan.depth_frames));
    EXPECT_EQ(ground.thermal(), Range(0, plan.thermal_frames));
    EXPECT_EQ(ground.corrupt(), 0);
    EXPECT_EQ(ground.subscriber().stats().refused, 0U);
  }

  SystemClock clock_;
  TransportEnvironment environment_{clock_};
  TestDomain domain_;
};

TEST_F(LinkTest, GroundFirstLosesNothingInOneProcess) {
  const EdgePlan plan = Plan(90, 120);
  const auto ground = StartGround();
  EdgeSide edge(environment_, clock_, plan);
  EXPECT_TRUE(edge.SendAll());
  ExpectEverything(plan, *ground);
}

TEST_F(LinkTest, GroundFirstLosesNothingBetweenTwoProcesses) {
  const EdgePlan plan = Plan(210, 280);
  const auto ground = StartGround();
  system_test::Process edge(Peer(plan));
  ExpectEverything(plan, *ground);
  EXPECT_TRUE(edge.WaitForOutput("\ndrained", kLinkPatience)) << edge.output();
  EXPECT_EQ(edge.WaitForExit(kLinkPatience), 0);
}

TEST_F(LinkTest, EdgeFirstLosesNothingBetweenTwoProcesses) {
  const EdgePlan plan = Plan(210, 280);
  system_test::Process edge(Peer(plan));
  ASSERT_TRUE(edge.WaitForOutput("started", kLinkPatience));
  const auto ground = StartGround();
  ExpectEverything(plan, *ground);
  EXPECT_EQ(edge.WaitForExit(kLinkPatience), 0);
}

TEST_F(LinkTest, ASlowGroundPacesALosslessEdge) {
  const EdgePlan plan = Plan(90, 120);
  const auto ground = StartGround(2ms);
  system_test::Process edge(Peer(plan));
  ExpectEverything(plan, *ground);
}

/// Nothing waits at the camera's rate, so that frames are lost, and counted, while others keep the
/// computer busy.
TEST_F(LinkTest, LiveVgaAtThirtyHertzLosesNothing) {
  EdgePlan plan = Plan(75, 100);
  plan.depth_hz = 30.0;
  plan.policy = PublishPolicy::kLive;
  const system_test::MachineLoad load;
  const auto ground = StartGround();
  system_test::Process edge(Peer(plan));
  const auto counters = ground->AwaitSessionEnd();
  ASSERT_TRUE(counters.has_value());
  for (const auto& [sent, arrived, stream] :
       {std::tuple(plan.depth_frames, ground->depth().size(), counters->depth),
        std::tuple(plan.thermal_frames, ground->thermal().size(), counters->thermal)}) {
    EXPECT_EQ(stream.published, sent);
    EXPECT_EQ(stream.received, arrived);
    EXPECT_EQ(stream.received + stream.missing, sent);
    EXPECT_LE(static_cast<double>(stream.missing),
              load.excused_fraction() * static_cast<double>(sent))
        << load.ToText();
  }
}

TEST_F(LinkTest, F19AGroundThatJoinsLateKnowsExactlyWhatItMissed) {
  EdgePlan plan = Plan(200, 200);
  plan.policy = PublishPolicy::kLive;
  EdgeSide edge(environment_, clock_, plan);
  edge.Begin();
  edge.SendFrames(0, 100);
  const auto ground = StartGround();
  ASSERT_TRUE(edge.publisher().WaitForGround(kLinkPatience, {}));
  ASSERT_TRUE(ground->AwaitDepth(1));
  const std::uint64_t first = ground->depth().front();
  EXPECT_GT(first, 0U);
  EXPECT_LT(first, 100U);  // The last ones are kept for late joiners.
  edge.publisher().SetPolicy(PublishPolicy::kLossless);
  edge.SendFrames(100, 200);
  EXPECT_TRUE(edge.End());
  const auto counters = ground->AwaitSessionEnd();
  ASSERT_TRUE(counters.has_value());
  EXPECT_EQ(counters->depth.published, 200U);
  EXPECT_EQ(counters->depth.received + counters->depth.missing, 200U);
  EXPECT_EQ(counters->depth.missing, first);
  EXPECT_EQ(ground->depth(), Range(first, 200));
  EXPECT_EQ(ground->rig_session(), plan.session);  // Written before the ground was there.
}

TEST_F(LinkTest, WhatTheGroundLacksComesOnAWayOfItsOwnAndIsConfirmed) {
  EdgePlan plan = Plan(40, 40);
  plan.policy = PublishPolicy::kLive;
  const auto ground = StartGround();
  EdgeSide edge(environment_, clock_, plan);
  Publisher& publisher = edge.publisher();
  edge.Begin();
  ASSERT_TRUE(publisher.WaitForGround(kLinkPatience, {}));
  EXPECT_TRUE(publisher.stats().takes_backfill);
  edge.SendFrames(0, 10);
  edge.SendFrames(15, 25);
  const auto await_receipt = [&](const auto& is_wanted) {
    const SteadyTime deadline = clock_.SteadyNow() + kLinkPatience;
    while (clock_.SteadyNow() < deadline) {
      const std::optional<Receipt> receipt = publisher.receipt();
      if (receipt && is_wanted(*receipt)) return true;
      std::this_thread::sleep_for(10ms);
    }
    return false;
  };
  const std::vector<FrameRange> hole = {{10, 14}};
  ASSERT_TRUE(await_receipt([&](const Receipt& receipt) {
    return receipt.depth.handled == 25 && receipt.depth.holes == hole;
  })) << "the ground does not say what it lacks";
  EXPECT_EQ(publisher.stats().depth.published, 20U);
  for (std::uint64_t number = 10; number < 15; ++number) {
    const auto depth =
        publisher.Backfill(MakeFrame<EncodedDepthFrame>(plan.session, number, 64, 48), 0, {});
    ASSERT_TRUE(depth) << depth.error().message();
    EXPECT_TRUE(*depth) << "it had not been published before";
  }
  ASSERT_TRUE(ground->AwaitLateDepth(5));
  EXPECT_EQ(ground->late_depth(), Range(10, 15));
  EXPECT_EQ(publisher.stats().depth.published, 25U);
  EXPECT_TRUE(await_receipt([](const Receipt& receipt) {
    return receipt.depth.received == 25 && receipt.depth.holes.empty();
  }));
  // Once more: it was lost on the way, for all that the edge knows.
  EXPECT_FALSE(*publisher.Backfill(MakeFrame<EncodedDepthFrame>(plan.session, 10, 64, 48), 0, {}));
  EXPECT_FALSE(
      publisher.Backfill(MakeFrame<EncodedDepthFrame>(plan.session + 1, 10, 64, 48), 0, {}))
      << "of another session";
  EXPECT_TRUE(edge.End());
  const auto counters = ground->AwaitSessionEnd();
  ASSERT_TRUE(counters.has_value());
  EXPECT_EQ(counters->depth.published, 25U);
  EXPECT_EQ(counters->depth.received, 25U);
  EXPECT_EQ(counters->depth.missing, 0U);
  EXPECT_EQ(counters->depth.late, 5U);
  EXPECT_EQ(ground->corrupt(), 0);
}

/// Receipts are sent sooner when many frames come, which must not put off those after them.
TEST_F(LinkTest, ReceiptsGoOnWhenAStreamHasEnded) {
  EdgePlan plan = Plan(1, 1);
  const auto ground = StartGround();
  EdgeSide edge(environment_, clock_, plan);
  edge.Begin();
  ASSERT_TRUE(edge.publisher().WaitForGround(kLinkPatience, {}));
  // A hundred receipts for these would be 20 s at their own rate.
  for (std::uint64_t number = 0; number < 800; ++number) {
    ASSERT_TRUE(edge.publisher()
                    .Publish(MakeFrame<EncodedThermalFrame>(plan.session, number, 38, 28), {})
                    .ok());
  }
  const SteadyTime ended = clock_.SteadyNow();
  std::this_thread::sleep_for(1s);  // Nothing is sent: that is what is tested.
  int receipts = 0;
  for (auto before = edge.publisher().stats().receipt_age;
       receipts < 3 && clock_.SteadyNow() - ended < 15s; std::this_thread::sleep_for(20ms)) {
    const auto age = edge.publisher().stats().receipt_age;
    receipts += age < before ? 1 : 0;
    before = age;
  }
  EXPECT_EQ(receipts, 3) << "three in a second and a half, when all is well";
  // The thread sanitizer does not see the middleware's lock between a receipt and the reader's end.
  ground->Stop();
}

TEST_F(LinkTest, ARestartedEdgeIsANewSession) {
  const auto ground = StartGround();
  EdgePlan plan = Plan(40, 40);
  EXPECT_EQ(system_test::RunToEnd(Peer(plan), kLinkPatience).status, 0);
  ASSERT_TRUE(ground->AwaitSessionEnd(1).has_value());
  plan.session = 2;
  EXPECT_EQ(system_test::RunToEnd(Peer(plan), kLinkPatience).status, 0);
  const auto counters = ground->AwaitSessionEnd(2);
  ASSERT_TRUE(counters.has_value());
  EXPECT_EQ(counters->session, 2U);
  EXPECT_EQ(counters->depth.missing, 0U);
  EXPECT_EQ(ground->depth().size(), 80U);
}

TEST_F(LinkTest, ARestartedGroundGoesOnWithTheSession) {
  const EdgePlan plan = Plan(150, 150);
  EdgeSide edge(environment_, clock_, plan);
  auto ground = StartGround();
  ASSERT_TRUE(edge.publisher().WaitForGround(kLinkPatience, {}));
  edge.Begin();
  edge.SendFrames(0, 50);
  ASSERT_TRUE(ground->AwaitDepth(50));
  ground.reset();
  ground = StartGround();
  ASSERT_TRUE(ground->AwaitDepth(1));
  edge.SendFrames(50, 150);
  EXPECT_TRUE(edge.End());
  const auto counters = ground->AwaitSessionEnd();
  ASSERT_TRUE(counters.has_value());
  EXPECT_EQ(counters->depth.received + counters->depth.missing, 150U);
  EXPECT_EQ(ground->depth(), Range(counters->depth.missing, 150));
}

TEST_F(LinkTest, AnEdgeThatIsKilledIsSeenToBeGone) {
  EdgePlan plan = Plan(100'000, 0);
  plan.depth_hz = 30.0;
  const auto ground = StartGround();
  system_test::Process edge(Peer(plan));
  ASSERT_TRUE(ground->AwaitDepth(5));
  EXPECT_TRUE(ground->subscriber().stats().edge_present);
  edge.Signal(SIGKILL);
  const auto deadline = std::chrono::steady_clock::now() + kLinkPatience;
  while (ground->subscriber().stats().edge_present && std::chrono::steady_clock::now() < deadline) {
    std::this_thread::yield();
  }
  EXPECT_FALSE(ground->subscriber().stats().edge_present);
}

TEST_F(LinkTest, F38StopEndsBothReceiversAtOnce) {
  const auto ground = StartGround();
  auto edge = std::make_unique<EdgeSide>(environment_, clock_, Plan(1, 1));
  ASSERT_TRUE(edge->publisher().WaitForGround(kLinkPatience, {}));
  const auto start = std::chrono::steady_clock::now();
  ground->Stop();
  edge.reset();
  EXPECT_LT(std::chrono::steady_clock::now() - start, 1s);
}

TEST_F(LinkTest, NobodyThereEndsTheWaitForGround) {
  EdgeSide edge(environment_, clock_, Plan(1, 1));
  EXPECT_FALSE(edge.publisher().WaitForGround(1ms, {}));
  std::stop_source stop;
  stop.request_stop();
  EXPECT_FALSE(edge.publisher().WaitForGround(1h, stop.get_token()));
  EXPECT_TRUE(edge.publisher().Drain(1ms));  // Nobody listens: nothing to wait for.
}

TEST_F(LinkTest, OdometryPosesArriveInOrder) {
  constexpr std::uint64_t kPoses = 300;  // Fewer than the history, so that none may be missing.
  const auto ground = StartGround();
  EdgeSide edge(environment_, clock_, Plan(1, 1));
  ASSERT_TRUE(edge.publisher().WaitForGround(kLinkPatience, {}));
  edge.Begin();
  for (std::uint64_t i = 0; i < kPoses; ++i) {
    ExternalOdometrySample sample{.session = 1, .number = i, .pose = {}};
    sample.pose.source = "vio";
    sample.pose.time = CaptureTimeFromNanoseconds(static_cast<std::int64_t>(i));
    ASSERT_TRUE(edge.publisher().Publish(sample, {}).ok());
  }
  EXPECT_EQ(ground->AwaitExternalOdometry(kPoses), Range(0, kPoses));
}

TEST_F(LinkTest, F38PosesFromOutsideDoNotHoldUpAStop) {
  EdgeSide edge(environment_, clock_, Plan(1, 1));
  edge.Begin();
  std::stop_source stop;
  stop.request_stop();
  ExternalOdometrySample sample{.session = 1, .number = 0, .pose = {}};
  sample.pose.source = "vio";
  sample.pose.time = CaptureTimeFromNanoseconds(1);
  EXPECT_TRUE(edge.publisher().Publish(sample, stop.get_token()).ok()) << "there is some time left";
  // However many there are, and however long each takes. The test's own time limit is the bound.
  Status published = OkStatus();
  while (published.ok()) published = edge.publisher().Publish(sample, stop.get_token());
  EXPECT_EQ(published.code(), StatusCode::kUnavailable);
  EXPECT_TRUE(edge.publisher().Publish(sample, {}).ok()) << "only a stop has an end";
}

TEST_F(LinkTest, ACommandIsAnsweredAndFeedbackArrives) {
  const auto ground = StartGround();
  auto participant = std::move(*Participant::Create(environment_, domain_.number()));
  PublisherOptions options;
  options.edge_id = "test-edge";
  const auto publisher = std::move(*Publisher::Create(*participant, clock_, options));
  RigDescription rig;
  rig.session = 5;
  ASSERT_TRUE(publisher->BeginSession(rig, {}).ok());
  LatestValue<Feedback> newest;
  std::jthread receiver([&](const std::stop_token& stop) {
    PublisherHandlers handlers;
    handlers.command = [&](const Command& command) {
      EXPECT_EQ(command.kind, CommandKind::kTriggerNuc);
      EXPECT_TRUE(publisher
                      ->Answer({.number = command.number,
                                .outcome = CommandOutcome::kRefused,
                                .text = "no shutter"})
                      .ok());
    };
    handlers.feedback = [&](const Feedback& feedback, CaptureTime, bool) { newest.Set(feedback); };
    publisher->Run(stop, handlers);
  });
  ASSERT_TRUE(publisher->WaitForGround(kLinkPatience, {}));
  const auto number = ground->subscriber().Send({.kind = CommandKind::kTriggerNuc});
  ASSERT_TRUE(number.has_value());
  const auto result = ground->AwaitResult();
  ASSERT_TRUE(result.has_value());
  EXPECT_EQ(result->number, *number);
  EXPECT_EQ(result->text, "no shutter");

  const auto frame = MakeFrame<EncodedDepthFrame>(rig.session, 12, 8, 6);
  ASSERT_TRUE(publisher->Publish(frame, {}).ok());
  Feedback feedback;
  feedback.session = rig.session;
  feedback.frame_number = frame.header.frame_number;
  feedback.capture_time = frame.header.capture_time;
  ASSERT_TRUE(ground->subscriber().Publish(feedback).ok());
  const auto deadline = std::chrono::steady_clock::now() + kLinkPatience;
  while (!newest.Get() && std::chrono::steady_clock::now() < deadline) std::this_thread::yield();
  ASSERT_TRUE(newest.Get().has_value());
  EXPECT_EQ(newest.Get()->frame_number, 12U);
}

}  // namespace
}  // namespace isotherm
