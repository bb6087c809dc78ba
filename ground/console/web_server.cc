#include "ground/console/web_server.h"

#include <fmt/format.h>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/ssl/context.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/ssl.hpp>
#include <boost/beast/websocket.hpp>
#include <boost/beast/websocket/ssl.hpp>

#include <algorithm>
#include <deque>
#include <optional>

namespace isotherm {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;
using Tcp = asio::ip::tcp;
using Error = beast::error_code;
using Request = http::request<http::string_body>;
using PlainStream = beast::tcp_stream;
using TlsStream = beast::ssl_stream<beast::tcp_stream>;

/// Bytes that a client has not read yet wait here, at most so many: half a second at 1 Mbit/s.
/// Larger: a slow client gets older surface; smaller: a fast one waits for the network's round
/// trip.
constexpr int kSendBuffer_bytes = 64 << 10;
constexpr std::uint32_t kMaxHeader_bytes = 16U << 10;

/// Holds what connections share. For the I/O thread, but for the counters.
struct ServerState {
  WebServerOptions options;
  WebHandlers handlers;
  WebServerCounters counters;
};

std::string Text(beast::string_view view) { return {view.data(), view.size()}; }

std::vector<std::string> SplitList(std::string_view text) {
  std::vector<std::string> parts;
  while (!text.empty()) {
    const std::size_t comma = text.find(',');
    std::string_view part = text.substr(0, comma);
    while (!part.empty() && part.front() == ' ') part.remove_prefix(1);
    while (!part.empty() && part.back() == ' ') part.remove_suffix(1);
    if (!part.empty()) parts.emplace_back(part);
    if (comma == std::string_view::npos) break;
    text.remove_prefix(comma + 1);
  }
  return parts;
}

WebRequest ToRequest(const Request& message) {
  WebRequest request;
  request.method = Text(message.method_string());
  const std::string target = Text(message.target());
  const std::size_t mark = target.find('?');
  request.path = target.substr(0, mark);
  if (mark != std::string::npos) request.query = target.substr(mark + 1);
  request.host = Text(message[http::field::host]);
  request.origin = Text(message[http::field::origin]);
  request.cookie = Text(message[http::field::cookie]);
  request.authorization = Text(message[http::field::authorization]);
  request.if_none_match = Text(message[http::field::if_none_match]);
  request.subprotocols = SplitList(Text(message[http::field::sec_websocket_protocol]));
  request.accepts_gzip =
      Text(message[http::field::accept_encoding]).find("gzip") != std::string::npos;
  request.body = message.body();
  return request;
}

http::response<http::string_body> ToResponse(const WebReply& reply, const Request& request) {
  http::response<http::string_body> response{static_cast<http::status>(reply.status),
                                             request.version()};
  response.set(http::field::content_type, reply.content_type);
  for (const auto& [name, value] : reply.headers) response.set(name, value);
  if (reply.body) response.body() = *reply.body;
  response.keep_alive(request.keep_alive());
  response.prepare_payload();
  if (request.method() == http::verb::head) response.body().clear();
  return response;
}

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

/// A connection that asks by HTTP, until it ends or becomes a WebSocket.
template <typename Stream>
class HttpConnection : public std::enable_shared_from_this<HttpConnection<Stream>> {
 public:
  HttpConnection(Stream stream, std::shared_ptr<ServerState> state)
      : stream_(std::move(stream)), state_(std::move(state)) {
    ++state_->counters.open_connections;
  }
  ~HttpConnection() { --state_->counters.open_connections; }

  void Read() {
    parser_.emplace();
    parser_->header_limit(kMaxHeader_bytes);
    parser_->body_limit(state_->options.max_body_bytes);
    beast::get_lowest_layer(stream_).expires_after(state_->options.request_patience);
    http::async_read(stream_, buffer_, *parser_,
                     [self = this->shared_from_this()](const Error& error, std::size_t) {
                       self->OnRead(error);
                     });
  }

 private:
  void OnRead(const Error& error) {
    if (error == http::error::end_of_stream || error == beast::error::timeout) return Shutdown();
    if (error) {
      ++state_->counters.refused_requests;
      return Shutdown();
    }
    const Request& message = parser_->get();
    const WebRequest request = ToRequest(message);
    if (websocket::is_upgrade(message)) return Upgrade(request);
    beast::get_lowest_layer(stream_).expires_after(state_->options.silence_patience);
    state_->handlers.request(request, [self = this->shared_from_this()](WebReply reply) {
      asio::post(self->stream_.get_executor(),
                 [self, reply = std::move(reply)] { self->Write(reply); });
    });
  }

  void Upgrade(const WebRequest& request) {
    std::variant<AcceptedSocket, WebReply> taken = state_->handlers.socket(request);
    if (auto* refusal = std::get_if<WebReply>(&taken)) return Write(*refusal);
    auto socket = std::make_shared<SocketConnection<Stream>>(
        std::move(stream_), std::move(std::get<AcceptedSocket>(taken)), state_);
    socket->Accept(parser_->get());
  }

  void Write(const WebReply& reply) {
    if (reply.status >= 400) ++state_->counters.refused_requests;
    response_ = ToResponse(reply, parser_->get());
    beast::get_lowest_layer(stream_).expires_after(state_->options.request_patience);
    http::async_write(stream_, response_,
                      [self = this->shared_from_this()](const Error& error, std::size_t) {
                        if (error || self->response_.need_eof()) return self->Shutdown();
                        self->Read();
                      });
  }

  void Shutdown() {
    Error ignored;
    beast::get_lowest_layer(stream_).socket().shutdown(Tcp::socket::shutdown_both, ignored);
  }

  Stream stream_;
  std::shared_ptr<ServerState> state_;
  beast::flat_buffer buffer_;
  std::optional<http::request_parser<http::string_body>> parser_;
  http::response<http::string_body> response_;
};

/// A connection whose encryption is being agreed on.
class TlsBeginning : public std::enable_shared_from_this<TlsBeginning> {
 public:
  TlsBeginning(TlsStream stream, std::shared_ptr<ServerState> state)
      : stream_(std::move(stream)), state_(std::move(state)) {
    ++state_->counters.open_connections;
  }
  ~TlsBeginning() { --state_->counters.open_connections; }

  void Begin() {
    beast::get_lowest_layer(stream_).expires_after(state_->options.request_patience);
    stream_.async_handshake(asio::ssl::stream_base::server, [self = shared_from_this()](
                                                                const Error& error) {
      if (error) {
        ++self->state_->counters.refused_requests;
        return;
      }
      std::make_shared<HttpConnection<TlsStream>>(std::move(self->stream_), self->state_)->Read();
    });
  }

 private:
  TlsStream stream_;
  std::shared_ptr<ServerState> state_;
};

class BeastServer final : public WebServer {
 public:
  BeastServer(const WebServerOptions& options, WebHandlers handlers)
      : state_(std::make_shared<ServerState>()), acceptor_(context_), pause_(context_) {
    state_->options = options;
    state_->handlers = std::move(handlers);
  }

  Status UseCertificate() {
    if (state_->options.certificate_file.empty()) return OkStatus();
    Error error;
    tls_.emplace(asio::ssl::context::tls_server);
    tls_->set_options(asio::ssl::context::default_workarounds | asio::ssl::context::no_sslv2 |
                          asio::ssl::context::no_sslv3 | asio::ssl::context::no_tlsv1 |
                          asio::ssl::context::no_tlsv1_1,
                      error);
    if (!error) tls_->use_certificate_chain_file(state_->options.certificate_file, error);
    if (!error) {
      tls_->use_private_key_file(state_->options.key_file, asio::ssl::context::pem, error);
    }
    if (!error) return OkStatus();
    return FailedPrecondition(fmt::format("{}, {}: {}", state_->options.certificate_file,
                                          state_->options.key_file, error.message()));
  }

  Status Listen() {
    Error error;
    const asio::ip::address address = asio::ip::make_address(state_->options.address, error);
    if (error) {
      return InvalidArgument(
          fmt::format("console.address: \"{}\" is no IP address", state_->options.address));
    }
    const Tcp::endpoint endpoint(address, static_cast<std::uint16_t>(state_->options.port));
    acceptor_.open(endpoint.protocol(), error);
    if (!error) acceptor_.set_option(asio::socket_base::reuse_address(true), error);
    if (!error) acceptor_.bind(endpoint, error);
    if (!error) acceptor_.listen(asio::socket_base::max_listen_connections, error);
    if (error) {
      return Unavailable(
          fmt::format("{}:{}: {}", state_->options.address, state_->options.port, error.message()));
    }
    port_ = acceptor_.local_endpoint(error).port();
    return OkStatus();
  }

  void Run(const std::stop_token& stop) override {
    const std::stop_callback on_stop(stop, [this] { context_.stop(); });
    Accept();
    const auto keep_running = asio::make_work_guard(context_);
    if (!stop.stop_requested()) context_.run();
    Error ignored;
    acceptor_.close(ignored);
  }

  void Post(std::function<void()> work) override { asio::post(context_, std::move(work)); }
  int port() const override { return port_; }
  const WebServerCounters& counters() const override { return state_->counters; }

 private:
  void Accept() {
    acceptor_.async_accept([this](const Error& error, Tcp::socket socket) {
      if (error == asio::error::operation_aborted) return;
      if (error) return AcceptLater();  // Too many open files, for example.
      Take(std::move(socket));
      Accept();
    });
  }
  void AcceptLater() {
    pause_.expires_after(std::chrono::milliseconds(100));
    pause_.async_wait([this](const Error& error) {
      if (!error) Accept();
    });
  }
  void Take(Tcp::socket socket) {
    WebServerCounters& counters = state_->counters;
    ++counters.connections;
    if (counters.open_connections >= static_cast<int>(state_->options.max_connections)) {
      ++counters.refused_connections;
      return;  // Closed as it goes out of scope.
    }
    Error ignored;
    socket.set_option(Tcp::no_delay(true), ignored);
    socket.set_option(asio::socket_base::send_buffer_size(kSendBuffer_bytes), ignored);
    PlainStream stream(std::move(socket));
    if (tls_) {
      std::make_shared<TlsBeginning>(TlsStream(std::move(stream), *tls_), state_)->Begin();
    } else {
      std::make_shared<HttpConnection<PlainStream>>(std::move(stream), state_)->Read();
    }
  }

  std::optional<asio::ssl::context> tls_;  ///< Outlives the connections.
  asio::io_context context_{1};
  std::shared_ptr<ServerState> state_;
  Tcp::acceptor acceptor_;
  asio::steady_timer pause_;
  int port_ = 0;
};

}  // namespace

Result<std::unique_ptr<WebServer>> WebServer::Open(const WebServerOptions& options,
                                                   WebHandlers handlers) {
  auto server = std::make_unique<BeastServer>(options, std::move(handlers));
  if (Status certified = server->UseCertificate(); !certified.ok())
    return Err(std::move(certified));
  if (Status listening = server->Listen(); !listening.ok()) return Err(std::move(listening));
  return server;
}

}  // namespace isotherm
