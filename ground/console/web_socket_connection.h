#pragma once

// Parts of the server that only web_server.cc knows: connections, by Boost.Beast.

#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>

#include <algorithm>
#include <memory>
#include <string>
#include <utility>

#include "ground/console/web_server.h"

namespace isotherm::web {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;
using Error = beast::error_code;
using Request = http::request<http::string_body>;

/// Holds what connections share. For the I/O thread, but for the counters.
struct ServerState {
  WebServerOptions options;
  WebHandlers handlers;
  WebServerCounters counters;
};

/// A WebSocket: reads what comes, sends what its handler says.
template <typename Stream>
class SocketConnection : public std::enable_shared_from_this<SocketConnection<Stream>>,
                         public WebSocketPeer {
 public:
  SocketConnection(Stream stream, AcceptedSocket accepted, std::shared_ptr<ServerState> state)
      : socket_(std::move(stream)),
        wake_timer_(socket_.get_executor()),
        accepted_(std::move(accepted)),
        state_(std::move(state)) {
    ++state_->counters.open_connections;
  }
  ~SocketConnection() override {
    accepted_.handler.reset();
    --state_->counters.open_connections;
  }

  void Accept(const Request& request) {
    beast::get_lowest_layer(socket_).expires_never();
    websocket::stream_base::timeout timeouts{};
    timeouts.handshake_timeout = state_->options.request_patience;
    timeouts.idle_timeout = state_->options.silence_patience;
    timeouts.keep_alive_pings = true;
    socket_.set_option(timeouts);
    socket_.set_option(websocket::stream_base::decorator(
        [protocol = accepted_.subprotocol](websocket::response_type& response) {
          response.set(http::field::sec_websocket_protocol, protocol);
        }));
    socket_.read_message_max(state_->options.max_message_bytes);
    socket_.auto_fragment(false);
    socket_.async_accept(request, [self = this->shared_from_this()](const Error& error) {
      if (error) return self->End(error);
      self->accepted_.handler->OnOpen(*self);
      self->Read();
    });
  }

  void Send(std::shared_ptr<const std::string> bytes, bool is_text) override {
    if (is_over_ || sending_) return;
    sending_ = std::move(bytes);
    socket_.text(is_text);
    socket_.async_write(asio::buffer(*sending_),
                        [self = this->shared_from_this()](const Error& error, std::size_t count) {
                          self->sending_.reset();
                          if (error) return self->End(error);
                          self->state_->counters.sent_bytes += count;
                          if (!self->is_over_) self->accepted_.handler->OnSent();
                        });
  }

  void WakeAt(SteadyTime time) override {
    wake_timer_.expires_at(time);
    wake_timer_.async_wait([weak = this->weak_from_this()](const Error& error) {
      const auto self = weak.lock();
      if (!error && self && !self->is_over_) self->accepted_.handler->OnWake();
    });
  }

  void Close(std::string_view reason) override {
    if (is_over_) return;
    is_over_ = true;
    ++state_->counters.dropped_sockets;
    wake_timer_.cancel();
    // A peer that does not answer is dropped by the handshake's time limit.
    socket_.async_close(
        {websocket::close_code::policy_error,
         beast::string_view(reason.data(), std::min<std::size_t>(reason.size(), 120))},
        [self = this->shared_from_this()](const Error&) {});
  }

 private:
  void Read() {
    socket_.async_read(buffer_, [self = this->shared_from_this()](const Error& error, std::size_t) {
      if (error) return self->End(error);
      self->Take();
    });
  }
  void Take() {
    const auto data = buffer_.cdata();
    if (!is_over_) {
      accepted_.handler->OnMessage({static_cast<const char*>(data.data()), data.size()},
                                   socket_.got_text());
    }
    buffer_.consume(buffer_.size());
    Read();
  }
  void End(const Error& error) {
    if (!is_over_ && error != websocket::error::closed && error != asio::error::eof)
      ++state_->counters.dropped_sockets;
    is_over_ = true;
    wake_timer_.cancel();
    beast::get_lowest_layer(socket_).cancel();
  }

  websocket::stream<Stream, /*deflateSupported=*/false> socket_;  ///< Surface is packed already.
  asio::steady_timer wake_timer_;
  AcceptedSocket accepted_;
  std::shared_ptr<ServerState> state_;
  beast::flat_buffer buffer_;
  std::shared_ptr<const std::string> sending_;
  bool is_over_ = false;
};

}  // namespace isotherm::web
