// A peer that was built with the types of wire 1.1 and we, over the middleware, in two processes.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <optional>

#include "common/transport/endpoints.h"
#include "common/transport/test_domain.h"
#include "common/transport/wait_set.h"
#include "tests/system/process.h"

namespace isotherm {
namespace {

using namespace std::chrono_literals;
using ::testing::HasSubstr;

constexpr auto kPatience = 20s;  // Far above anything measured; only a failure waits so long.

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
      EXPECT_EQ(received.edge_id, "old");
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

TEST_F(WireVersionTest, APeerOfWire11AndWeUnderstandEachOther) {
  Ends<Hello> hello(*participant_, waiter_, &refusals_);
  Ends<EdgeStatus> status(*participant_, waiter_, &refusals_);
  Ends<Command> command(*participant_, waiter_, &refusals_);
  Ends<Receipt> receipt(*participant_, waiter_, &refusals_);
  system_test::Process peer(
      {.program = PEER_1_1, .arguments = {std::to_string(domain_.number())}, .environment = {}});

  // Each side repeats what it says until the other one has heard it. The peer leaves when it has
  // heard all, so the command is kept back until we have.
  bool heard = false;
  const auto deadline = std::chrono::steady_clock::now() + kPatience;
  while (!heard && std::chrono::steady_clock::now() < deadline) {
    ASSERT_TRUE(hello.writer.Write("new", Hello{.role = Role::kGround}).ok());
    ASSERT_TRUE(status.writer.Write("new", OwnStatus()).ok());
    ASSERT_TRUE(receipt.writer.Write("new", OwnReceipt()).ok());
    if (hello.got && status.got && command.got && receipt.got) {
      const Command last{.number = 22, .kind = CommandKind::kHoldNuc, .hold_s = 9};
      ASSERT_TRUE(command.writer.Write("new", last).ok());
    }
    waiter_.Wait(50ms);
    hello.Take();
    status.Take();
    command.Take();
    receipt.Take();
    heard = peer.output().find("got all") != std::string::npos;
  }
  EXPECT_EQ(peer.WaitForExit(kPatience), 0) << peer.output();

  EXPECT_THAT(peer.output(), HasSubstr("hello 1." + std::to_string(kWireMinor) + "\n"));
  EXPECT_THAT(peer.output(), HasSubstr("status 21 published 60 error 0.25 feedback 9 p99 0.5\n"));
  EXPECT_THAT(peer.output(), HasSubstr("command 22 kind 5\n"));
  EXPECT_THAT(peer.output(), HasSubstr("receipt 23 thermal 48 hole 8\n"));

  ASSERT_TRUE(hello.got.has_value());
  EXPECT_EQ(hello.got->wire_minor, 1U);
  EXPECT_TRUE(CheckCompatible(Hello{}, *hello.got).ok());
  ASSERT_TRUE(status.got.has_value());
  EXPECT_EQ(status.got->session, 11U);
  EXPECT_EQ(status.got->depth.published, 90U);
  EXPECT_EQ(status.got->nuc.state, NucState::kIdle);
  EXPECT_EQ(status.got->feedback.p99_s, 0.11);
  EXPECT_TRUE(status.got->clock.synchronised);
  EXPECT_TRUE(std::isnan(status.got->clock.estimated_error_s)) << "not known to wire 1.1";
  EXPECT_FALSE(status.got->clock_echo.has_value());
  ASSERT_TRUE(command.got.has_value());
  EXPECT_EQ(command.got->number, 12U);
  EXPECT_EQ(command.got->kind, CommandKind::kTriggerNuc);
  EXPECT_EQ(command.got->hold_s, 0.0);
  ASSERT_TRUE(receipt.got.has_value());
  EXPECT_EQ(receipt.got->thermal.received, 40U);
  EXPECT_EQ(receipt.got->clock_ping, 0U);
  EXPECT_EQ(refusals_.total(), 0U);
}

}  // namespace
}  // namespace isotherm
