#include "common/transport/endpoints.h"

#include <gtest/gtest.h>

#include <string>
#include <thread>

#include "common/transport/announced_peers.h"
#include "common/transport/instance_limit.h"
#include "common/transport/qos.h"
#include "common/transport/testing/example_messages.h"
#include "common/transport/testing/joined_ends.h"

namespace isotherm {
namespace {

using namespace std::chrono_literals;

class EndpointsTest : public JoinedEndsTest {};

TEST_F(EndpointsTest, LateJoinerGetsTheRigAndTheNewestFrames) {
  Writer<RigDescription> rig_writer;
  ASSERT_TRUE(rig_writer.Open(*edge_).ok());
  Writer<EncodedDepthFrame> depth_writer;
  ASSERT_TRUE(depth_writer.Open(*edge_).ok());
  ASSERT_TRUE(rig_writer.Write("edge-1", Good<RigDescription>()).ok());
  auto frame = Good<EncodedDepthFrame>();
  for (frame.header.frame_number = 0; frame.header.frame_number < 100; ++frame.header.frame_number)
    ASSERT_TRUE(depth_writer.Write("edge-1", frame).ok());

  Reader<RigDescription> rig_reader;
  ASSERT_TRUE(rig_reader.Open(*ground_, &refusals_).ok());
  ASSERT_TRUE(TakeOne(rig_reader).has_value());
  Reader<EncodedDepthFrame> depth_reader;
  ASSERT_TRUE(depth_reader.Open(*ground_, &refusals_).ok());
  const auto first = TakeOne(depth_reader);
  ASSERT_TRUE(first.has_value());
  EXPECT_EQ(first->message.header.frame_number, 100U - kFrameHistory);
}

TEST_F(EndpointsTest, WhatIsForgottenIsNotKeptForALateJoiner) {
  Reader<EncodedDepthFrame> early;
  ASSERT_TRUE(early.Open(*ground_, &refusals_).ok());
  Writer<EncodedDepthFrame> writer;
  ASSERT_TRUE(writer.Open(*edge_).ok());
  EXPECT_TRUE(writer.ForgetPast("edge-1").ok()) << "nothing yet";
  auto frame = Good<EncodedDepthFrame>();
  const auto write = [&](std::uint64_t number) {
    frame.header.frame_number = number;
    ASSERT_TRUE(writer.Write("edge-1", frame).ok());
  };
  for (std::uint64_t number = 0; number < 5; ++number) write(number);
  ASSERT_TRUE(writer.ForgetPast("edge-1").ok());
  Reader<EncodedDepthFrame> late;
  ASSERT_TRUE(late.Open(*ground_, &refusals_).ok());
  AwaitMatch(writer, 2);
  write(5);
  const auto first = TakeOne(late);
  ASSERT_TRUE(first.has_value());
  EXPECT_EQ(first->message.header.frame_number, 5U);
  for (std::uint64_t number = 0; number < 6; ++number) {
    const auto next = TakeOne(early);
    ASSERT_TRUE(next.has_value());
    EXPECT_EQ(next->message.header.frame_number, number) << "who was there gets all";
  }
}

TEST_F(EndpointsTest, WakeEndsTheWaitAtOnce) {
  WaitSet waiter;
  ASSERT_TRUE(waiter.Open(*ground_).ok());
  std::jthread waker([&] { waiter.Wake(); });
  const auto start = std::chrono::steady_clock::now();
  waiter.Wait(60s);
  EXPECT_LT(std::chrono::steady_clock::now() - start, 30s);
}

TEST_F(EndpointsTest, LeavingIsSeenByTheOtherSide) {
  Reader<Hello> reader;
  ASSERT_TRUE(reader.Open(*ground_, &refusals_).ok());
  {
    const auto peer = Join();
    Writer<Hello> writer;
    ASSERT_TRUE(writer.Open(*peer).ok());
    ASSERT_TRUE(writer.Write("edge-1", Hello{}).ok());
    ASSERT_TRUE(TakeOne(reader).has_value());
    EXPECT_EQ(reader.matched_writers(), 1);
  }
  const auto deadline = std::chrono::steady_clock::now() + kPatience;
  while (reader.matched_writers() > 0 && std::chrono::steady_clock::now() < deadline) {
    std::this_thread::yield();
  }
  EXPECT_EQ(reader.matched_writers(), 0);
}

TEST_F(EndpointsTest, F62OfTheNamesOfOneWriterSoManyAreTakenAndTheOthersAreCounted) {
  constexpr std::size_t kTooMany = 5;
  Reader<Hello> reader;
  ASSERT_TRUE(reader.Open(*ground_, &refusals_).ok());
  Writer<Hello> writer;
  ASSERT_TRUE(writer.Open(*edge_).ok());
  for (std::size_t i = 0; i < InstanceLimit::kPerWriter + kTooMany; ++i)
    ASSERT_TRUE(writer.Write("edge-" + std::to_string(i), Hello{}).ok());
  std::size_t taken = 0;
  const auto deadline = std::chrono::steady_clock::now() + kPatience;
  while (taken + refusals_.count(RefusalCause::kTooManyNames) <
             InstanceLimit::kPerWriter + kTooMany &&
         std::chrono::steady_clock::now() < deadline) {
    reader.Take([&](Received<Hello>&&) { ++taken; });
    std::this_thread::yield();
  }
  EXPECT_EQ(taken, InstanceLimit::kPerWriter);
  EXPECT_EQ(refusals_.count(RefusalCause::kTooManyNames), kTooMany);
}

TEST_F(EndpointsTest, F60OversizePayloadIsNotWritten) {
  Writer<EncodedDepthFrame> writer;
  ASSERT_TRUE(writer.Open(*edge_).ok());
  auto frame = Good<EncodedDepthFrame>();
  frame.image.payload.resize(kMaxPayloadBytes + 1);
  EXPECT_EQ(writer.Write("edge-1", frame).code(), StatusCode::kInvalidArgument);
}

TEST_F(EndpointsTest, EdgeIdMustFit) {
  Writer<Hello> writer;
  ASSERT_TRUE(writer.Open(*edge_).ok());
  EXPECT_EQ(writer.Write("", Hello{}).code(), StatusCode::kInvalidArgument);
  EXPECT_EQ(writer.Write(std::string(kMaxIdBytes + 1, 'x'), Hello{}).code(),
            StatusCode::kInvalidArgument);
  EXPECT_TRUE(writer.Write(std::string(kMaxIdBytes, 'x'), Hello{}).ok());
}

TEST_F(EndpointsTest, DomainMustExist) {
  EXPECT_EQ(Participant::Create(environment_, -1).error().code(), StatusCode::kInvalidArgument);
  EXPECT_EQ(Participant::Create(environment_, kMaxDomainId + 1).error().code(),
            StatusCode::kInvalidArgument);
}

TEST_F(EndpointsTest, AnnouncedPeersAreThereUntilTheyLeave) {
  const Announcement rig{Role::kEdge, "drone-2", "raspi"};
  const auto join = [&](const std::optional<Announcement>& announcement) {
    return std::move(*Participant::Create(environment_, domain_.number(), announcement));
  };
  const auto ground = join(Announcement{Role::kGround, "", "desk"});
  AnnouncedPeers peers;
  ASSERT_TRUE(peers.Open(*ground).ok());
  const auto wait_for = [&](std::size_t count) {
    const auto deadline = std::chrono::steady_clock::now() + kPatience;
    while (peers.Of(Role::kEdge).size() != count && std::chrono::steady_clock::now() < deadline)
      std::this_thread::sleep_for(10ms);
    return peers.Of(Role::kEdge);
  };
  {
    const auto silent = join(std::nullopt);
    const auto edge = join(rig);
    const auto found = wait_for(1);
    ASSERT_EQ(found.size(), 1U);
    EXPECT_EQ(found.begin()->second, rig);
    EXPECT_EQ(peers.Of(Role::kGround).size(), 1U) << "this one itself";
  }
  EXPECT_TRUE(wait_for(0).empty());
}

}  // namespace
}  // namespace isotherm
