#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string_view>

#include "common/time/clock.h"
#include "ground/console/console_inbox.h"
#include "ground/console/live_hub.h"
#include "ground/console/web_server.h"

namespace isotherm {

inline constexpr std::uint32_t kLiveProtocol = 1;
inline constexpr std::string_view kLiveSubprotocol = "isotherm.live.v1";

/// One page on its WebSocket: what it is told (its mailbox), what it asks. Thread-bound to the I/O
/// thread; what it asks is answered by the console's thread.
class LiveSession final : public WebSocketHandler {
 public:
  struct Context {
    const Clock& clock;
    LiveHub& hub;
    ConsoleInbox& inbox;
    ClientMailbox::Limits limits;
    live::Welcome welcome;
    /// Has work done on the I/O thread, from any thread.
    std::function<void(std::function<void()>)> post;
  };

  /// `context` must outlive it.
  LiveSession(Context& context, live::Role role);
  ~LiveSession() override;

  void OnOpen(WebSocketPeer& peer) override;
  void OnMessage(std::string_view bytes, bool is_text) override;
  void OnSent() override;
  void OnWake() override { Pump(); }

 private:
  /// Sends the next message if the last one is out.
  void Pump();
  void Welcome();
  void Handle(const live::Hello& hello);
  void Handle(const live::View& view);
  void Ask(live::ClientMessage message);
  void Refuse(std::uint64_t number, std::string_view why);
  void Reply(const live::Answer& answer);
  /// Returns false if a client says more than a person can.
  bool IsPatient();

  Context& context_;
  const live::Role role_;
  WebSocketPeer* peer_ = nullptr;
  LiveClient client_;
  std::shared_ptr<LiveSession*> self_;  ///< Empty for replies that come too late.
  bool has_joined_ = false;
  bool is_sending_ = false;
  double allowance_ = 0.0;  ///< Messages that it may send at once.
  SteadyTime allowed_at_;
};

}  // namespace isotherm
