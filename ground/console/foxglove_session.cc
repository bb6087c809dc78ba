#include "ground/console/foxglove_session.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

#include "ground/json/json.h"

namespace isotherm {
namespace {

/// Bounds what one session may have waiting beside its mailbox: answers to calls.
constexpr std::size_t kMaxOutgoing = 256;

enum Service : std::uint32_t { kNucNow = 1, kHoldNuc, kStartScan, kStopScan };

std::vector<FoxgloveService> Services() {
  constexpr const char* kNothing = R"({"type":"object"})";
  return {
      {kNucNow, "/nuc_now", kNothing},
      {kHoldNuc, "/hold_nuc", R"({"type":"object","properties":{"seconds":{"type":"number"}}})"},
      {kStartScan, "/start_scan", kNothing},
      {kStopScan, "/stop_scan", kNothing}};
}

std::optional<live::Order> OrderOf(const FoxgloveRequest& request) {
  live::Order order;
  switch (request.service) {
    case kNucNow:
      order.set_kind(live::Order::NUC_NOW);
      return order;
    case kHoldNuc: {
      const Json json = Json::parse(request.payload, nullptr, /*allow_exceptions=*/false);
      if (!json.is_object() || !json.contains("seconds") || !json["seconds"].is_number())
        return std::nullopt;
      order.set_kind(live::Order::HOLD_NUC);
      order.set_hold_s(json["seconds"]);
      return order;
    }
    case kStartScan:
      order.set_kind(live::Order::START_SCAN);
      return order;
    case kStopScan:
      order.set_kind(live::Order::STOP_SCAN);
      return order;
    default:
      return std::nullopt;
  }
}

}  // namespace

FoxgloveSession::FoxgloveSession(LiveSession::Context& context, live::Role role)
    : context_(context),
      role_(role),
      client_{.mailbox = ClientMailbox(context.limits, context.clock.SteadyNow()),
              .wake = [this] { Pump(); }},
      self_(std::make_shared<FoxgloveSession*>(this)) {}

FoxgloveSession::~FoxgloveSession() {
  *self_ = nullptr;
  subscriptions_.clear();
  JoinOrLeave();
}

void FoxgloveSession::OnOpen(WebSocketPeer& peer) {
  peer_ = &peer;
  Say(ServerInfoText("Isotherm " + context_.welcome.software_version(),
                     std::to_string(context_.clock.SteadyNow().time_since_epoch().count())));
  Say(AdvertiseText(FoxgloveChannels()));
  Say(AdvertiseServicesText(Services()));
}

void FoxgloveSession::Say(std::string text) {
  if (outgoing_.size() >= kMaxOutgoing) return peer_->Close("answers are not read");
  outgoing_.push_back({std::make_shared<const std::string>(std::move(text)), true});
  Pump();
}

bool FoxgloveSession::Wants(FoxgloveTopic topic) const {
  return std::ranges::any_of(subscriptions_,
                             [&](const auto& entry) { return entry.second == topic; });
}

void FoxgloveSession::Send(const FoxgloveData& data) {
  for (const auto& [id, topic] : subscriptions_) {
    if (topic != data.topic) continue;
    outgoing_.push_back(
        {std::make_shared<const std::string>(DataMessage(id, data.time_ns, data.payload)), false});
  }
}

void FoxgloveSession::OnMessage(std::string_view bytes, bool is_text) {
  const Result<FoxgloveRequest> request =
      is_text ? ParseFoxgloveText(bytes) : ParseFoxgloveBinary(bytes);
  if (!request) return peer_->Close(request.error().message());
  Handle(*request);
}

void FoxgloveSession::Handle(const FoxgloveRequest& request) {
  switch (request.kind) {
    case FoxgloveRequest::Kind::kSubscribe:
      return Subscribe(request);
    case FoxgloveRequest::Kind::kUnsubscribe:
      for (const auto& entry : request.subscriptions) subscriptions_.erase(entry.id);
      return JoinOrLeave();
    case FoxgloveRequest::Kind::kCall:
      return Call(request);
    case FoxgloveRequest::Kind::kOther:
      break;  // Something that we do not offer.
  }
}

void FoxgloveSession::Subscribe(const FoxgloveRequest& request) {
  constexpr std::size_t kMaxSubscriptions = 100;
  for (const auto& entry : request.subscriptions) {
    if (entry.channel < static_cast<std::uint32_t>(FoxgloveTopic::kDepth) ||
        entry.channel > static_cast<std::uint32_t>(FoxgloveTopic::kLog) ||
        subscriptions_.size() >= kMaxSubscriptions)
      return peer_->Close("no such channel, or too many subscriptions");
    subscriptions_[entry.id] = static_cast<FoxgloveTopic>(entry.channel);
  }
  const bool was_there = has_joined_;
  JoinOrLeave();
  // What is kept and was not wanted so far.
  if (was_there) context_.hub.OfferAll(client_);
}

void FoxgloveSession::JoinOrLeave() {
  const bool wants_raw = Wants(FoxgloveTopic::kDepth) || Wants(FoxgloveTopic::kThermal);
  if (wants_raw != is_raw_counted_) {
    context_.inbox.raw_viewers += wants_raw ? 1 : -1;
    is_raw_counted_ = wants_raw;
  }
  client_.mailbox.set_wants_raw(wants_raw);
  const bool should_join = !subscriptions_.empty();
  if (should_join == has_joined_) return;
  has_joined_ = should_join;
  if (should_join) {
    ++context_.inbox.viewers;
    client_.mailbox.set_wants(false, false);
    context_.hub.Join(client_);
  } else {
    context_.hub.Leave(client_);
    --context_.inbox.viewers;
  }
}

void FoxgloveSession::Call(const FoxgloveRequest& request) {
  const auto fail = [&](const std::string& why) {
    Say(CallFailureText(request.service, request.call, why));
  };
  if (role_ != live::OPERATOR) return fail("viewers may look, but change nothing");
  const std::optional<live::Order> order = OrderOf(request);
  if (!order) return fail("no such service, or a request that it does not understand");
  ClientQuery query;
  query.message.set_number(request.call);
  *query.message.mutable_order() = *order;
  query.reply = [post = context_.post, self = self_, service = request.service,
                 call = request.call](live::Answer answer) {
    post([self, service, call, answer = std::move(answer)] {
      if (*self != nullptr) (*self)->Answer(service, call, answer);
    });
  };
  context_.inbox.Add(std::move(query));
}

void FoxgloveSession::Answer(std::uint32_t service, std::uint32_t call,
                             const live::Answer& answer) {
  Json json;
  json["done"] = answer.done();
  json["text"] = answer.text();
  const std::string text = json.dump(-1, ' ', false, Json::error_handler_t::replace);
  outgoing_.push_back(
      {std::make_shared<const std::string>(CallResponse(service, call, text)), false});
  Pump();
}

void FoxgloveSession::OnSent() {
  is_sending_ = false;
  Pump();
}

void FoxgloveSession::OfferCloud(SteadyTime now) {
  constexpr Nanoseconds kCloudInterval = std::chrono::seconds(1);
  if (!Wants(FoxgloveTopic::kCloud) || now < next_cloud_) return;
  const std::optional<FoxgloveData> cloud = converter_.TakeCloud();
  if (!cloud) return;
  Send(*cloud);
  // A large cloud comes less often: at most a quarter of what the client may get.
  const double seconds =
      4.0 * static_cast<double>(cloud->payload.size()) / context_.limits.bytes_per_s;
  next_cloud_ = now + std::max(kCloudInterval, FromSeconds(seconds));
}

void FoxgloveSession::Pump() {
  if (peer_ == nullptr || is_sending_) return;
  const SteadyTime now = context_.clock.SteadyNow();
  while (outgoing_.empty()) {
    OfferCloud(now);
    if (!outgoing_.empty()) break;
    const LiveMessagePtr message = client_.mailbox.Take(now);
    if (!message) {
      if (const auto next = client_.mailbox.NextTake()) return peer_->WakeAt(std::max(*next, now));
      if (Wants(FoxgloveTopic::kCloud))
        peer_->WakeAt(std::max(next_cloud_, now + std::chrono::milliseconds(200)));
      return;
    }
    for (const FoxgloveData& data :
         converter_.Convert(*message, [this](FoxgloveTopic topic) { return Wants(topic); }))
      Send(data);
  }
  const Outgoing next = std::move(outgoing_.front());
  outgoing_.pop_front();
  is_sending_ = true;
  peer_->Send(next.bytes, next.is_text);
}

}  // namespace isotherm
