#pragma once

#include <deque>
#include <map>
#include <memory>
#include <string>

#include "ground/console/foxglove_converter.h"
#include "ground/console/live_session.h"
#include "ground/console/web_server.h"

namespace isotherm {

/// A viewer that speaks the Foxglove WebSocket protocol (Foxglove, Lichtblick). Thread-bound to the
/// I/O thread.
class FoxgloveSession final : public WebSocketHandler {
 public:
  /// `context` must outlive it.
  FoxgloveSession(LiveSession::Context& context, live::Role role);
  ~FoxgloveSession() override;

  void OnOpen(WebSocketPeer& peer) override;
  void OnMessage(std::string_view bytes, bool is_text) override;
  void OnSent() override;
  void OnWake() override { Pump(); }

 private:
  struct Outgoing {
    std::shared_ptr<const std::string> bytes;
    bool is_text = false;
  };
  void Say(std::string text);
  void Send(const FoxgloveData& data);
  void Pump();
  void Handle(const FoxgloveRequest& request);
  void Subscribe(const FoxgloveRequest& request);
  void Call(const FoxgloveRequest& request);
  void Answer(std::uint32_t service, std::uint32_t call, const live::Answer& answer);
  bool Wants(FoxgloveTopic topic) const;
  /// Takes part while somebody has subscribed to something.
  void JoinOrLeave();
  void OfferCloud(SteadyTime now);

  LiveSession::Context& context_;
  const live::Role role_;
  WebSocketPeer* peer_ = nullptr;
  LiveClient client_;
  FoxgloveConverter converter_;
  std::map<std::uint32_t, FoxgloveTopic> subscriptions_;  ///< By the client's number.
  std::deque<Outgoing> outgoing_;  ///< The parts of the message that is under way.
  std::shared_ptr<FoxgloveSession*> self_;
  bool has_joined_ = false;
  bool is_raw_counted_ = false;
  bool is_sending_ = false;
  SteadyTime next_cloud_;
};

}  // namespace isotherm
