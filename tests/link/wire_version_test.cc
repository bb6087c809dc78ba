// A peer that was built with the types of another version and we, over the middleware, in two
// processes.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <optional>

#include "common/transport/endpoints.h"
#include "common/transport/testing/test_domain.h"
#include "common/transport/wait_set.h"
#include "tests/support/process.h"

namespace isotherm {
namespace {

using namespace std::chrono_literals;
using ::testing::HasSubstr;

constexpr auto kPatience = 20s;  // Far above anything measured; only a failure waits this long.

/// Our end of one topic.
template <typename Message>
struct Ends {
  Ends(const Participant& participant, WaitSet& waiter, RefusalCounter* refusals) {
    EXPECT_TRUE(writer.Open(participant).ok());
    EXPECT_TRUE(reader.Open(participant, refusals).ok());
    EXPECT_TRUE(waiter.Attach(reader).ok());
  }
  void Take() {
    reader.Take([this](Received<Message>&& received) {
      EXPECT_EQ(received.edge_id, "edge");
      got = std::move(received.message);
    });
  }
  Writer<Message> writer;
  Reader<Message> reader;
  std::optional<Message> got;
};

class WireVersionTest : public ::testing::Test {
 protected:
  WireVersionTest()
      : participant_(std::move(*Participant::Create(environment_, domain_.number()))) {
    EXPECT_TRUE(waiter_.Open(*participant_).ok());
  }

  static EdgeStatus OwnStatus() {
    EdgeStatus status;
    status.session = 21;
    status.depth.published = status.depth.next_frame_number = 60;
    status.clock = {.synchronised = true, .estimated_error_s = 1e-4, .max_error_s = 0.25};
    status.clock_echo = {.ping = 5, .received = {}, .sent = {}};
    status.feedback = {.count = 9, .p50_s = 0.05, .p99_s = 0.5};
    status.nuc.reason = "drift";
    return status;
  }
  static Receipt OwnReceipt() {
    Receipt receipt{.session = 23, .depth = {}, .thermal = {}, .clock_ping = 99};
    receipt.thermal = {.next = 50, .handled = 50, .received = 48, .holes = {{7, 8}}};
    return receipt;
  }

  SystemClock clock_;
  TransportEnvironment environment_{clock_};
  TestDomain domain_;
  RefusalCounter refusals_;
  std::unique_ptr<Participant> participant_;
  WaitSet waiter_;
};

/// Our ends of the topics that the peers have.
struct OwnEnds {
  OwnEnds(const Participant& participant, WaitSet& waiter, RefusalCounter* refusals)
      : status(participant, waiter, refusals),
        command(participant, waiter, refusals),
        receipt(participant, waiter, refusals),
        hello(participant, waiter, refusals) {}
  void Take() {
    status.Take();
    command.Take();
    receipt.Take();
    hello.Take();
  }
  Ends<EdgeStatus> status;
  Ends<Command> command;
  Ends<Receipt> receipt;
  // Last: an edge that has met this one has met the others, announced in order by the middleware.
  Ends<Hello> hello;
};

// Each side repeats what it says until the other one has heard it. The peer leaves when it has
// heard all.
TEST_F(WireVersionTest, APeerOfANewerMinorAndWeUnderstandEachOther) {
  OwnEnds own(*participant_, waiter_, &refusals_);
  system_test::Process peer(
      {.program = PEER_NEXT, .arguments = {std::to_string(domain_.number())}, .environment = {}});
  const auto deadline = std::chrono::steady_clock::now() + kPatience;
  bool heard = false;
  while (!heard && std::chrono::steady_clock::now() < deadline) {
    ASSERT_TRUE(own.hello.writer.Write("new", Hello{.role = Role::kGround}).ok());
    ASSERT_TRUE(own.status.writer.Write("new", OwnStatus()).ok());
    ASSERT_TRUE(own.receipt.writer.Write("new", OwnReceipt()).ok());
    // Kept back until we have heard all.
    if (own.hello.got && own.status.got && own.command.got && own.receipt.got) {
      const Command last{.number = 22, .kind = CommandKind::kHoldNuc, .hold_s = 9};
      ASSERT_TRUE(own.command.writer.Write("new", last).ok());
    }
    waiter_.Wait(50ms);
    own.Take();
    heard = peer.output().find("got all") != std::string::npos;
  }
  EXPECT_EQ(peer.WaitForExit(kPatience), 0) << peer.output();

  EXPECT_THAT(peer.output(), HasSubstr(fmt::format("hello {}.{}\n", kWireMajor, kWireMinor)));
  EXPECT_THAT(peer.output(), HasSubstr("status 21 published 60 error 0.25 feedback 9 p99 0.5\n"));
  EXPECT_THAT(peer.output(), HasSubstr("command 22 kind 5\n"));
  EXPECT_THAT(peer.output(), HasSubstr("receipt 23 thermal 48 hole 8\n"));
  EXPECT_THAT(peer.output(), HasSubstr("shared: status 1 command 1 receipt 1\n"));

  ASSERT_TRUE(own.hello.got.has_value());
  EXPECT_EQ(own.hello.got->wire_minor, 7U);
  EXPECT_TRUE(CheckCompatible(Hello{}, *own.hello.got).ok());
  ASSERT_TRUE(own.status.got.has_value());
  EXPECT_EQ(own.status.got->session, 11U);
  EXPECT_EQ(own.status.got->depth.published, 90U);
  EXPECT_EQ(own.status.got->nuc.state, NucState::kIdle);
  EXPECT_EQ(own.status.got->feedback.p99_s, 0.11);
  EXPECT_EQ(own.status.got->clock.max_error_s, 0.002);
  ASSERT_TRUE(own.command.got.has_value());
  EXPECT_EQ(own.command.got->number, 12U);
  EXPECT_EQ(own.command.got->kind, CommandKind::kTriggerNuc);
  ASSERT_TRUE(own.receipt.got.has_value());
  EXPECT_EQ(own.receipt.got->thermal.received, 40U);
  EXPECT_EQ(refusals_.total(), 0U);
}

TEST_F(WireVersionTest, F63OfAnotherMajorOnlyTheHelloCrossesAndSaysWhichSideIsOld) {
  OwnEnds own(*participant_, waiter_, &refusals_);
  // The newest of these is kept for who comes later: it would be read if the topics were the same.
  ASSERT_TRUE(own.status.writer.Write("new", OwnStatus()).ok());
  system_test::Process peer({.program = PEER_1_1,
                             .arguments = {std::to_string(domain_.number()), "1"},
                             .environment = {}});
  const auto deadline = std::chrono::steady_clock::now() + kPatience;
  bool heard = false;
  while (!(heard && own.hello.got) && std::chrono::steady_clock::now() < deadline) {
    ASSERT_TRUE(own.hello.writer.Write("new", Hello{.role = Role::kGround}).ok());
    waiter_.Wait(50ms);
    own.Take();
    heard = peer.output().find("got all") != std::string::npos;
  }
  EXPECT_THAT(peer.output(), HasSubstr(fmt::format("hello {}.{}\n", kWireMajor, kWireMinor)));
  EXPECT_THAT(peer.output(), HasSubstr("shared: status 0 command 0 receipt 0\n"));
  EXPECT_EQ(own.status.writer.matched_readers() + own.command.writer.matched_readers() +
                own.receipt.writer.matched_readers(),
            0);
  EXPECT_FALSE(own.status.got || own.command.got || own.receipt.got);
  EXPECT_EQ(peer.WaitForExit(kPatience), 0) << peer.output();

  ASSERT_TRUE(own.hello.got.has_value());
  const Status compatible = CheckCompatible(Hello{.role = Role::kGround}, *own.hello.got);
  EXPECT_EQ(compatible.code(), StatusCode::kFailedPrecondition);
  EXPECT_THAT(compatible.message(), HasSubstr("wire 1.1"));
  EXPECT_THAT(compatible.message(), HasSubstr(fmt::format("wire {}.{}", kWireMajor, kWireMinor)));
  EXPECT_THAT(compatible.message(),
              ::testing::EndsWith(own.hello.got->role == Role::kEdge ? "update the edge"
                                                                     : "update the ground"));
}

}  // namespace
}  // namespace isotherm
