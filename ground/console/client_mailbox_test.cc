#include "ground/console/client_mailbox.h"

#include <gtest/gtest.h>

#include <vector>

namespace isotherm {
namespace {

using namespace std::chrono_literals;

constexpr double kBytesPerSecond = 1000.0;

LiveMessagePtr Message(LiveKind kind, std::size_t bytes = 10, std::uint64_t model = 1) {
  auto message = std::make_shared<LiveMessage>();
  message->slot.kind = kind;
  message->model = model;
  message->bytes.assign(bytes, 'x');
  return message;
}

/// A group at `x` metres from the origin.
LiveMessagePtr Group(int x, std::uint32_t version = 1, std::size_t bytes = 10,
                     LiveKind kind = LiveKind::kGroup) {
  auto message = std::make_shared<LiveMessage>();
  message->slot = {kind, {.map = 0, .x = x, .y = 0, .z = 0}};
  message->version = version;
  message->centre_world = Eigen::Vector3d(x, 0.0, 0.0);
  message->bytes.assign(bytes, 'g');
  return message;
}

class ClientMailboxTest : public ::testing::Test {
 protected:
  std::vector<LiveKind> TakeKinds(SteadyTime now) {
    std::vector<LiveKind> kinds;
    while (const LiveMessagePtr message = mailbox_.Take(now)) kinds.push_back(message->slot.kind);
    return kinds;
  }
  std::vector<int> TakeGroups(SteadyTime now) {
    std::vector<int> places;
    while (const LiveMessagePtr message = mailbox_.Take(now))
      places.push_back(message->slot.group.x);
    return places;
  }
  const SteadyTime start_{1h};
  ClientMailbox mailbox_{{.bytes_per_s = kBytesPerSecond, .max_answers = 3}, start_};
};

TEST_F(ClientMailboxTest, AnEmptyOneGivesNothingAndAsksForNoCall) {
  EXPECT_EQ(mailbox_.Take(start_), nullptr);
  EXPECT_FALSE(mailbox_.NextTake());
}

TEST_F(ClientMailboxTest, TheNewestReplacesWhatWasNotSent) {
  mailbox_.Offer(Message(LiveKind::kPose, 11));
  mailbox_.Offer(Message(LiveKind::kPose, 12));
  mailbox_.Offer(Group(3, 1));
  mailbox_.Offer(Group(3, 2));
  EXPECT_EQ(mailbox_.Take(start_)->bytes.size(), 12U);
  EXPECT_EQ(mailbox_.Take(start_)->version, 2U);
  EXPECT_EQ(mailbox_.Take(start_), nullptr);
  EXPECT_EQ(mailbox_.replaced(), 2U);
}

TEST_F(ClientMailboxTest, SmallAndUrgentMessagesComeBeforeSurface) {
  mailbox_.Offer(Message(LiveKind::kScan));  // Another model later would void the others.
  mailbox_.Offer(Message(LiveKind::kPath));
  mailbox_.Offer(Group(1));
  mailbox_.Offer(Message(LiveKind::kState));
  mailbox_.Offer(Message(LiveKind::kScan));
  EXPECT_EQ(TakeKinds(start_),
            (std::vector{LiveKind::kScan, LiveKind::kState, LiveKind::kGroup, LiveKind::kPath}));
}

TEST_F(ClientMailboxTest, TheNearestGroupComesFirst) {
  mailbox_.set_eye({5.2, 0.0, 0.0});
  for (const int x : {0, 9, 5, 6}) mailbox_.Offer(Group(x));
  EXPECT_EQ(TakeGroups(start_), (std::vector{5, 6, 9, 0}));
}

TEST_F(ClientMailboxTest, SurfaceThatIsNewToTheClientComesBeforeBetterSurface) {
  mailbox_.Offer(Group(1, 1));
  TakeGroups(start_);
  mailbox_.Offer(Group(1, 2));
  mailbox_.Offer(Group(40, 1));
  EXPECT_EQ(TakeGroups(start_), (std::vector{40, 1}));
}

TEST_F(ClientMailboxTest, AClientGetsNoMoreThanItsBytesPerSecond) {
  constexpr std::size_t kBytes = 100;
  for (int x = 0; x < 100; ++x) mailbox_.Offer(Group(x, 1, kBytes));
  std::size_t sent = 0;
  SteadyTime now = start_;
  for (int turn = 0; turn < 1000; ++turn) {  // Five seconds.
    while (const LiveMessagePtr message = mailbox_.Take(now)) sent += message->bytes.size();
    now += 5ms;
  }
  EXPECT_GE(sent, 4900U);
  EXPECT_LE(sent, 5000U + 250U + kBytes);  // A burst of a quarter of a second, and a message.
}

TEST_F(ClientMailboxTest, ASlowClientIsToldWhenToComeAgain) {
  mailbox_.Offer(Group(1, 1, 2000));
  mailbox_.Offer(Group(2, 1, 10));
  ASSERT_NE(mailbox_.Take(start_), nullptr);
  EXPECT_EQ(mailbox_.Take(start_), nullptr);
  ASSERT_TRUE(mailbox_.NextTake());
  EXPECT_GT(*mailbox_.NextTake(), start_ + 1500ms);
  EXPECT_EQ(mailbox_.Take(*mailbox_.NextTake())->slot.group.x, 2);
}

TEST_F(ClientMailboxTest, WhatIsUrgentDoesNotWaitForTheBudget) {
  mailbox_.Offer(Group(1, 1, 5000));
  ASSERT_NE(mailbox_.Take(start_), nullptr);
  mailbox_.Offer(Message(LiveKind::kPose));
  ASSERT_TRUE(mailbox_.Answer(Message(LiveKind::kState, 77)));
  EXPECT_EQ(mailbox_.Take(start_)->bytes.size(), 77U);  // Answers first.
  EXPECT_EQ(mailbox_.Take(start_)->slot.kind, LiveKind::kPose);
}

TEST_F(ClientMailboxTest, ANewModelVoidsWhatWaits) {
  mailbox_.Offer(Message(LiveKind::kScan, 10, 1));
  mailbox_.Offer(Group(1));
  mailbox_.Offer(Message(LiveKind::kScan, 10, 2));
  EXPECT_EQ(TakeKinds(start_), std::vector{LiveKind::kScan});
}

TEST_F(ClientMailboxTest, WhatAClientHasIsNotSentAgain) {
  mailbox_.Have({.map = 0, .x = 1, .y = 0, .z = 0}, 4);
  mailbox_.Offer(Message(LiveKind::kScan, 10, 1));
  mailbox_.Offer(Group(1, 4));
  mailbox_.Offer(Group(2, 4));
  mailbox_.Take(start_);
  EXPECT_EQ(TakeGroups(start_), std::vector{2});
  mailbox_.Offer(Group(1, 5));
  EXPECT_EQ(TakeGroups(start_), std::vector{1});
}

TEST_F(ClientMailboxTest, DetailsAndImagesAreSentToWhoWantsThem) {
  EXPECT_FALSE(mailbox_.set_wants(false, false));
  mailbox_.Offer(Group(1, 1, 10, LiveKind::kDetails));
  mailbox_.Offer(Message(LiveKind::kDepthImage));
  EXPECT_EQ(mailbox_.Take(start_), nullptr);
  EXPECT_TRUE(mailbox_.set_wants(true, true));
  mailbox_.Offer(Group(1, 1, 10, LiveKind::kDetails));
  mailbox_.Offer(Message(LiveKind::kDepthImage));
  EXPECT_EQ(TakeKinds(start_).size(), 2U);
}

TEST_F(ClientMailboxTest, ImagesLeaveMostOfTheBytesToSurface) {
  double image_bytes = 0.0, surface_bytes = 0.0;
  SteadyTime now = start_;
  std::uint32_t version = 0;
  for (int turn = 0; turn < 400; ++turn, now += 100ms) {
    for (int x = 0; x < 5; ++x) mailbox_.Offer(Group(x, ++version, 60));
    mailbox_.Offer(Message(LiveKind::kThermalImage, 60));
    while (const LiveMessagePtr message = mailbox_.Take(now)) {
      (message->slot.kind == LiveKind::kGroup ? surface_bytes : image_bytes) +=
          static_cast<double>(message->bytes.size());
    }
  }
  EXPECT_GT(image_bytes, 0.2 * surface_bytes);
  EXPECT_LT(image_bytes, 0.4 * surface_bytes);
}

TEST_F(ClientMailboxTest, WhoAsksFasterThanItReadsIsRefused) {
  for (int i = 0; i < 3; ++i) EXPECT_TRUE(mailbox_.Answer(Message(LiveKind::kState)));
  EXPECT_FALSE(mailbox_.Answer(Message(LiveKind::kState)));
}

TEST_F(ClientMailboxTest, AClientMayLimitItselfButNotUnlimitItself) {
  mailbox_.set_bytes_per_s(1e9);
  mailbox_.Offer(Group(1, 1, 1000));
  mailbox_.Offer(Group(2, 1, 10));
  ASSERT_NE(mailbox_.Take(start_), nullptr);
  EXPECT_EQ(mailbox_.Take(start_ + 700ms), nullptr);
  EXPECT_NE(mailbox_.Take(start_ + 1s), nullptr);
}

}  // namespace
}  // namespace isotherm
