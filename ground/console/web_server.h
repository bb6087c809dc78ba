#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <stop_token>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "common/base/status.h"
#include "common/time/time_types.h"

namespace isotherm {

/// An HTTP request, as far as anybody here asks.
struct WebRequest {
  std::string method;
  std::string path;   ///< Without the query.
  std::string query;  ///< Follows the question mark.
  std::string host, origin, cookie, authorization, if_none_match;
  std::vector<std::string> subprotocols;  ///< Offered for a WebSocket, in the client's order.
  bool accepts_gzip = false;
  std::string body;
};

struct WebReply {
  int status = 200;
  std::string content_type = "text/plain; charset=utf-8";
  std::shared_ptr<const std::string> body;
  std::filesystem::path file{};  ///< Sent instead of the body, in pieces, if it is not empty.
  std::vector<std::pair<std::string, std::string>> headers;
};

/// The other end of a WebSocket. For the I/O thread.
class WebSocketPeer {
 public:
  virtual ~WebSocketPeer() = default;
  /// Sends a message. One at a time: the next one after WebSocketHandler::OnSent.
  virtual void Send(std::shared_ptr<const std::string> bytes, bool is_text) = 0;
  /// Has OnWake called at `time`, instead of what was asked for before.
  virtual void WakeAt(SteadyTime time) = 0;
  virtual void Close(std::string_view reason) = 0;
};

/// Takes part in what is said on a WebSocket. Called on the I/O thread; destroyed when the
/// connection ends.
class WebSocketHandler {
 public:
  virtual ~WebSocketHandler() = default;
  /// `peer` outlives the handler.
  virtual void OnOpen(WebSocketPeer& peer) = 0;
  virtual void OnMessage(std::string_view bytes, bool is_text) = 0;
  virtual void OnSent() = 0;
  virtual void OnWake() = 0;
};

struct AcceptedSocket {
  std::unique_ptr<WebSocketHandler> handler;
  std::string subprotocol;
};

/// Says what a server is to do. Called on the I/O thread.
struct WebHandlers {
  /// `reply` may be called later, and on any thread; once.
  std::function<void(const WebRequest&, std::function<void(WebReply)> reply)> request;
  /// Takes a WebSocket or says why not.
  std::function<std::variant<AcceptedSocket, WebReply>(const WebRequest&)> socket;
};

struct WebServerOptions {
  std::string address = "127.0.0.1";
  int port = 0;  ///< 0 = any.
  std::size_t max_connections = 128;
  std::size_t max_body_bytes = 1U << 20;     ///< In a request.
  std::size_t max_message_bytes = 1U << 20;  ///< From a client, on a WebSocket.
  Nanoseconds request_patience = std::chrono::seconds(10);
  Nanoseconds silence_patience = std::chrono::seconds(30);  ///< On a WebSocket.
  /// Reads further files: certificate chain and key, PEM. Empty: plain.
  std::string certificate_file, key_file;
};

/// Counted since the start. Thread-safe.
struct WebServerCounters {
  std::atomic<std::uint64_t> connections{0};
  std::atomic<std::uint64_t> refused_connections{0};  ///< Too many at the same time.
  std::atomic<std::uint64_t> refused_requests{0};     ///< Malformed, too large, not allowed.
  std::atomic<std::uint64_t> dropped_sockets{0};      ///< Slow, silent, or against the rules.
  std::atomic<std::uint64_t> sent_bytes{0};           ///< On WebSockets.
  std::atomic<int> open_connections{0};
};

/// Serves HTTP and WebSockets on one thread. What is asked and said is for the handlers.
class WebServer {
 public:
  /// Listens. kUnavailable: the port is taken, or there is no such address.
  static Result<std::unique_ptr<WebServer>> Open(const WebServerOptions& options,
                                                 WebHandlers handlers);
  virtual ~WebServer() = default;

  /// Serves until stop is requested.
  virtual void Run(const std::stop_token& stop) = 0;
  /// Has `work` done on the I/O thread. Thread-safe.
  virtual void Post(std::function<void()> work) = 0;
  virtual int port() const = 0;
  virtual const WebServerCounters& counters() const = 0;
};

}  // namespace isotherm
