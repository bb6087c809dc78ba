#include "ground/console/web_server.h"

#include <fmt/format.h>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ssl/context.hpp>
#include <boost/beast/ssl.hpp>
#include <boost/beast/websocket/ssl.hpp>

#include <optional>

#include "ground/console/http_connection.h"

namespace isotherm {
namespace {

namespace asio = web::asio;
namespace beast = web::beast;
using web::Error;
using web::HttpConnection;
using web::ServerState;
using web::Tcp;
using PlainStream = beast::tcp_stream;
using TlsStream = beast::ssl_stream<beast::tcp_stream>;

/// Bytes that a client has not read yet wait here, at most so many: half a second at 1 Mbit/s.
/// Larger: a slow client gets older surface; smaller: a fast one waits for the network's round
/// trip.
constexpr int kSendBuffer_bytes = 64 << 10;

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
