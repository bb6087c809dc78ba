#include "ground/console/live_session.h"

#include <algorithm>
#include <utility>

#include "ground/console/group_codec.h"
#include "ground/console/live_convert.h"

namespace isotherm {
namespace {

/// Messages of a client: a pointer that moves makes 60 a second.
constexpr double kMessagesPerSecond = 120.0;
constexpr double kMessageBurst = 240.0;

bool IsOrder(const live::ClientMessage& message) {
  return message.has_order() || message.has_edit() || message.has_playback();
}

}  // namespace

LiveSession::LiveSession(Context& context, live::Role role)
    : context_(context),
      role_(role),
      client_{.mailbox = ClientMailbox(context.limits, context.clock.SteadyNow()),
              .wake = [this] { Pump(); }},
      self_(std::make_shared<LiveSession*>(this)),
      allowance_(kMessageBurst),
      allowed_at_(context.clock.SteadyNow()) {}

LiveSession::~LiveSession() {
  *self_ = nullptr;
  if (!has_joined_) return;
  context_.hub.Leave(client_);
  --context_.inbox.viewers;
}

void LiveSession::OnOpen(WebSocketPeer& peer) {
  peer_ = &peer;
  Welcome();
}

void LiveSession::Welcome() {
  live::ServerMessage message;
  *message.mutable_welcome() = context_.welcome;
  message.mutable_welcome()->set_protocol(kLiveProtocol);
  message.mutable_welcome()->set_role(role_);
  auto welcome = std::make_shared<LiveMessage>();
  welcome->bytes = message.SerializeAsString();
  client_.mailbox.Answer(std::move(welcome));
  Pump();
}

bool LiveSession::IsPatient() {
  const SteadyTime now = context_.clock.SteadyNow();
  allowance_ =
      std::min(kMessageBurst, allowance_ + kMessagesPerSecond * ToSeconds(now - allowed_at_)) - 1.0;
  allowed_at_ = now;
  return allowance_ >= 0.0;
}

void LiveSession::OnMessage(std::string_view bytes, bool is_text) {
  if (!IsPatient()) return peer_->Close("too many messages");
  live::ClientMessage message;
  if (is_text || !message.ParseFromArray(bytes.data(), static_cast<int>(bytes.size())))
    return peer_->Close("not a message of isotherm.live.v1");
  if (message.has_hello()) return Handle(message.hello());
  if (!has_joined_) return peer_->Close("the first message must be a Hello");
  if (message.has_view()) return Handle(message.view());
  if (IsOrder(message) && role_ != live::OPERATOR)
    return Refuse(message.number(), "viewers may look and read places, but change nothing");
  Ask(std::move(message));
}

void LiveSession::Handle(const live::Hello& hello) {
  if (has_joined_) return;
  if (hello.protocol() != kLiveProtocol) return peer_->Close("another protocol: reload the page");
  has_joined_ = true;
  if (hello.model() == context_.hub.model()) {
    for (const live::Hello::Have& have : hello.groups())
      client_.mailbox.Have(FromMessage(have.key()), have.version());
  }
  ++context_.inbox.viewers;
  context_.hub.Join(client_);
}

void LiveSession::Handle(const live::View& view) {
  if (view.has_eye()) client_.mailbox.set_eye(FromMessage(view.eye()));
  client_.mailbox.set_bytes_per_s(view.max_bytes_per_s());
  if (client_.mailbox.set_wants(view.details(), view.images())) context_.hub.OfferAll(client_);
}

void LiveSession::Ask(live::ClientMessage message) {
  ClientQuery query{.message = std::move(message), .reply = {}};
  query.reply = [post = context_.post, self = self_](live::Answer answer) {
    post([self, answer = std::move(answer)] {
      if (*self != nullptr) (*self)->Reply(answer);
    });
  };
  context_.inbox.Add(std::move(query));
}

void LiveSession::Refuse(std::uint64_t number, std::string_view why) {
  live::Answer answer;
  answer.set_number(number);
  answer.set_text(std::string(why));
  Reply(answer);
}

void LiveSession::Reply(const live::Answer& answer) {
  live::ServerMessage message;
  *message.mutable_answer() = answer;
  auto reply = std::make_shared<LiveMessage>();
  reply->bytes = message.SerializeAsString();
  if (!client_.mailbox.Answer(std::move(reply))) return peer_->Close("answers are not read");
  Pump();
}

void LiveSession::OnSent() {
  is_sending_ = false;
  Pump();
}

void LiveSession::Pump() {
  if (peer_ == nullptr || is_sending_) return;
  const SteadyTime now = context_.clock.SteadyNow();
  if (const LiveMessagePtr message = client_.mailbox.Take(now)) {
    is_sending_ = true;
    // The message owns its bytes.
    peer_->Send(std::shared_ptr<const std::string>(message, &message->bytes), false);
  } else if (const auto next = client_.mailbox.NextTake()) {
    peer_->WakeAt(std::max(*next, now));
  }
}

}  // namespace isotherm
