#include "ground/console/live_session.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <deque>

namespace isotherm {
namespace {

using namespace std::chrono_literals;
using ::testing::HasSubstr;

/// The other end of a socket that takes a message at a time.
class FakePeer final : public WebSocketPeer {
 public:
  void Send(std::shared_ptr<const std::string> bytes, bool is_text) override {
    EXPECT_FALSE(is_sending) << "one at a time";
    EXPECT_FALSE(is_text);
    is_sending = true;
    sent.push_back(*bytes);
  }
  void WakeAt(SteadyTime time) override { wake_at = time; }
  void Close(std::string_view reason) override { closed = reason; }

  std::deque<std::string> sent;
  bool is_sending = false;
  std::optional<SteadyTime> wake_at;
  std::string closed;
};

class LiveSessionTest : public ::testing::Test {
 protected:
  LiveSessionTest() {
    context_.post = [](const std::function<void()>& work) { work(); };
  }
  std::unique_ptr<LiveSession> Open(live::Role role = live::OPERATOR) {
    auto session = std::make_unique<LiveSession>(context_, role);
    session->OnOpen(peer_);
    return session;
  }
  void Say(LiveSession& session, const live::ClientMessage& message) {
    session.OnMessage(message.SerializeAsString(), false);
  }
  void SayHello(LiveSession& session, std::uint32_t protocol = kLiveProtocol) {
    live::ClientMessage message;
    message.mutable_hello()->set_protocol(protocol);
    Say(session, message);
  }
  /// Returns what the peer gets next; the peer has then read it.
  live::ServerMessage Next(LiveSession& session) {
    live::ServerMessage message;
    if (peer_.sent.empty()) return message;
    EXPECT_TRUE(message.ParseFromString(peer_.sent.front()));
    peer_.sent.pop_front();
    peer_.is_sending = false;
    session.OnSent();
    return message;
  }
  void Publish(LiveKind kind) {
    live::ServerMessage message;
    message.mutable_state();
    auto published = std::make_shared<LiveMessage>();
    published->slot.kind = kind;
    published->bytes = message.SerializeAsString();
    hub_.Publish(published);
  }

  FakeClock clock_;
  LiveHub hub_;
  ConsoleInbox inbox_;
  LiveSession::Context context_{
      .clock = clock_, .hub = hub_, .inbox = inbox_, .limits = {}, .welcome = {}, .post = {}};
  FakePeer peer_;
};

TEST_F(LiveSessionTest, ItBeginsWithAWelcomeThatSaysTheRole) {
  const auto session = Open(live::VIEWER);
  const live::ServerMessage message = Next(*session);
  ASSERT_TRUE(message.has_welcome());
  EXPECT_EQ(message.welcome().role(), live::VIEWER);
  EXPECT_EQ(message.welcome().protocol(), kLiveProtocol);
}

TEST_F(LiveSessionTest, NothingIsShownBeforeTheHello) {
  Publish(LiveKind::kState);
  const auto session = Open();
  Next(*session);
  EXPECT_TRUE(peer_.sent.empty());
  EXPECT_EQ(inbox_.viewers, 0);
  SayHello(*session);
  EXPECT_TRUE(Next(*session).has_state());
  EXPECT_EQ(inbox_.viewers, 1);
}

TEST_F(LiveSessionTest, WhoLeavesIsNoLongerCounted) {
  auto session = Open();
  SayHello(*session);
  EXPECT_EQ(hub_.clients(), 1U);
  session.reset();
  EXPECT_EQ(hub_.clients(), 0U);
  EXPECT_EQ(inbox_.viewers, 0);
}

TEST_F(LiveSessionTest, ViewersMayNeitherOrderNorChange) {
  const auto session = Open(live::VIEWER);
  SayHello(*session);
  Next(*session);
  live::ClientMessage order;
  order.set_number(4);
  order.mutable_order()->set_kind(live::Order::NUC_NOW);
  Say(*session, order);
  const live::ServerMessage answer = Next(*session);
  ASSERT_TRUE(answer.has_answer());
  EXPECT_EQ(answer.answer().number(), 4U);
  EXPECT_FALSE(answer.answer().done());
  order.mutable_edit()->set_clear(true);
  Say(*session, order);
  EXPECT_FALSE(Next(*session).answer().done());
  EXPECT_TRUE(inbox_.TakeEvents().empty());
}

TEST_F(LiveSessionTest, WhatAnOperatorAsksIsAnsweredByTheConsole) {
  auto session = Open();
  SayHello(*session);
  Next(*session);
  live::ClientMessage order;
  order.set_number(4);
  order.mutable_order()->set_kind(live::Order::NUC_NOW);
  Say(*session, order);
  std::vector<ConsoleEvent> events = inbox_.TakeEvents();
  ASSERT_EQ(events.size(), 1U);
  const auto& query = std::get<ClientQuery>(events[0]);
  live::Answer answer;
  answer.set_number(4);
  answer.set_text("done");
  query.reply(answer);
  EXPECT_EQ(Next(*session).answer().text(), "done");
  session.reset();
  query.reply(answer);  // Too late: nobody is there.
}

TEST_F(LiveSessionTest, MalformedMessagesEndTheConnection) {
  const auto session = Open();
  session->OnMessage("\xFF\xFF\xFF\xFF garbage", false);
  EXPECT_THAT(peer_.closed, HasSubstr("not a message"));
}

TEST_F(LiveSessionTest, TextEndsTheConnection) {
  const auto session = Open();
  session->OnMessage("{}", true);
  EXPECT_THAT(peer_.closed, HasSubstr("not a message"));
}

TEST_F(LiveSessionTest, QuestionsBeforeTheHelloEndTheConnection) {
  const auto session = Open();
  live::ClientMessage message;
  message.mutable_order()->set_kind(live::Order::NUC_NOW);
  Say(*session, message);
  EXPECT_THAT(peer_.closed, HasSubstr("Hello"));
}

TEST_F(LiveSessionTest, APageOfAnotherProtocolIsSentAway) {
  const auto session = Open();
  SayHello(*session, kLiveProtocol + 1);
  EXPECT_THAT(peer_.closed, HasSubstr("reload"));
}

TEST_F(LiveSessionTest, AFloodEndsTheConnection) {
  const auto session = Open();
  SayHello(*session);
  live::ClientMessage view;
  view.mutable_view();
  for (int i = 0; i < 1000 && peer_.closed.empty(); ++i) Say(*session, view);
  EXPECT_THAT(peer_.closed, HasSubstr("too many"));
}

TEST_F(LiveSessionTest, AHandThatMovesIsNoFlood) {
  const auto session = Open();
  SayHello(*session);
  live::ClientMessage view;
  view.mutable_view();
  for (int i = 0; i < 2000; ++i) {
    Say(*session, view);
    clock_.Advance(10ms);
  }
  EXPECT_EQ(peer_.closed, "");
}

TEST_F(LiveSessionTest, OneMessageIsUnderWayAtATimeAndTheNewestIsNext) {
  const auto session = Open();
  SayHello(*session);
  Publish(LiveKind::kPose);
  Publish(LiveKind::kState);
  Publish(LiveKind::kState);
  EXPECT_EQ(peer_.sent.size(), 1U);
  Next(*session);
  Next(*session);
  Next(*session);
  EXPECT_TRUE(peer_.sent.empty());
}

}  // namespace
}  // namespace isotherm
