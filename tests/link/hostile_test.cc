// A ground station and a peer that sends frames that cannot be.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/transport/test_domain.h"
#include "ground/subscriber/subscriber.h"
#include "tests/link/edge_side.h"
#include "tests/system/process.h"

namespace isotherm {
namespace {

int Count(const std::string& text, std::string_view part) {
  int count = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) {
    ++count;
  }
  return count;
}

TEST(HostileTest, F60WhatCannotBeIsRefusedCountedAndLoggedOncePerCause) {
  constexpr std::uint64_t kRepeats = 3;  // As in hostile_peer.
  const SystemClock clock;
  const TransportEnvironment environment(clock);
  const TestDomain domain;
  const auto participant = std::move(*Participant::Create(environment, domain.number()));
  std::vector<std::uint64_t> depth_sessions;
  std::uint64_t thermal_frames = 0;
  SubscriberHandlers handlers;
  handlers.depth = [&](const ReceivedDepth& item) {
    depth_sessions.push_back(item.frame->header.session);
    EXPECT_EQ(item.frame->depth_raw.At(0, 0), 0x0707);
  };
  handlers.thermal = [&](const ReceivedThermal&) { ++thermal_frames; };
  SubscriberOptions options;
  options.edge_id = "test-edge";
  const auto subscriber = std::move(*Subscriber::Create(*participant, clock, options, handlers));

  ::testing::internal::CaptureStderr();
  {
    const std::jthread receiver([&](const std::stop_token& stop) { subscriber->Run(stop); });
    const auto peer = system_test::RunToEnd({.program = HOSTILE_PEER,
                                             .arguments = {std::to_string(domain.number())},
                                             .environment = {}},
                                            kLinkPatience);
    EXPECT_EQ(peer.status, 0) << peer.output;
  }
  const std::string log = ::testing::internal::GetCapturedStderr();

  // The good ones came through, each once; also the newer version's, whose extra member is ignored.
  EXPECT_THAT(depth_sessions, ::testing::ElementsAre(1, 2, 2));
  EXPECT_EQ(thermal_frames, 1U);
  const RefusalCounter& refusals = subscriber->refusals();
  EXPECT_EQ(refusals.count(RefusalCause::kImpossibleSize), 2 * kRepeats);
  EXPECT_EQ(refusals.count(RefusalCause::kUnknownEncoding), kRepeats);
  EXPECT_EQ(refusals.count(RefusalCause::kEmptyPayload), kRepeats);
  EXPECT_EQ(refusals.count(RefusalCause::kOversizePayload), kRepeats);
  EXPECT_EQ(refusals.count(RefusalCause::kNegativeTime), 2 * kRepeats);
  EXPECT_EQ(refusals.count(RefusalCause::kNotFinite), 3 * kRepeats);
  EXPECT_EQ(refusals.count(RefusalCause::kImpossibleNumber), 2 * kRepeats);
  EXPECT_EQ(refusals.count(RefusalCause::kOtherSession), kRepeats);
  EXPECT_EQ(refusals.count(RefusalCause::kUnknownValue), 2 * kRepeats);
  // The undecodable one has the number of a frame that is here: a duplicate, not even looked at.
  EXPECT_EQ(refusals.count(RefusalCause::kUndecodable), 0U);
  const SessionAccount account = subscriber->stats().account;
  EXPECT_EQ(account.depth.received, 2U);
  EXPECT_EQ(account.depth.missing, 0U);

  EXPECT_EQ(environment.refused().malformed, kRepeats);  // Beyond the bound of the type.
  EXPECT_EQ(environment.refused().oversize, kRepeats);   // Beyond MaxSampleSize.

  EXPECT_EQ(Count(log, "sample refused"), 9) << log;  // One line per cause.
  EXPECT_EQ(Count(log, "warning: Dds:"), 2) << log;
}

}  // namespace
}  // namespace isotherm
