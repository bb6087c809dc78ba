#pragma once

// Parts of the server that only web_server.cc knows: a connection that asks by HTTP.

#include <fmt/format.h>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>

#include <optional>
#include <string_view>
#include <variant>
#include <vector>

#include "ground/console/web_socket_connection.h"

namespace isotherm::web {

using Tcp = asio::ip::tcp;

inline constexpr std::uint32_t kMaxHeader_bytes = 16U << 10;

inline std::string Text(beast::string_view view) { return {view.data(), view.size()}; }

inline std::vector<std::string> SplitList(std::string_view text) {
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

inline WebRequest ToRequest(const Request& message) {
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

/// Makes the response to a request, without its body.
template <typename Body>
http::response<Body> MakeResponse(const WebReply& reply, const Request& request) {
  http::response<Body> response{static_cast<http::status>(reply.status), request.version()};
  response.set(http::field::content_type, reply.content_type);
  for (const auto& [name, value] : reply.headers) response.set(name, value);
  response.keep_alive(request.keep_alive());
  return response;
}

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
  /// A serializer refers to its response, whose file is open by then.
  struct FileBeingSent {
    http::response<http::file_body> response;
    http::response_serializer<http::file_body> serializer{response};
  };

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
    if (!reply.file.empty()) return WriteFile(reply);
    response_ = MakeResponse<http::string_body>(reply, parser_->get());
    if (reply.body) response_.body() = *reply.body;
    response_.prepare_payload();
    if (parser_->get().method() == http::verb::head) response_.body().clear();
    beast::get_lowest_layer(stream_).expires_after(state_->options.request_patience);
    http::async_write(stream_, response_,
                      [self = this->shared_from_this()](const Error& error, std::size_t) {
                        self->OnWritten(error, self->response_.need_eof());
                      });
  }
  void OnWritten(const Error& error, bool is_last) {
    if (error || is_last) return Shutdown();
    Read();
  }

  void WriteFile(const WebReply& reply) {
    Error error;
    http::file_body::value_type file;
    file.open(reply.file.c_str(), beast::file_mode::scan, error);
    if (error) return Write({.status = 404, .body = {}, .headers = {}});
    http::response<http::file_body> response = MakeResponse<http::file_body>(reply, parser_->get());
    response.body() = std::move(file);
    response.prepare_payload();
    file_.reset(new FileBeingSent{.response = std::move(response)});
    file_->serializer.split(parser_->get().method() == http::verb::head);
    WriteSome();
  }
  /// Each piece has the patience of a request: a file may take longer, a client that rests may not.
  void WriteSome() {
    const bool is_head = parser_->get().method() == http::verb::head;
    if (file_->serializer.is_done() || (is_head && file_->serializer.is_header_done())) {
      const bool is_last = file_->response.need_eof();
      file_.reset();
      return OnWritten({}, is_last);
    }
    beast::get_lowest_layer(stream_).expires_after(state_->options.request_patience);
    http::async_write_some(stream_, file_->serializer,
                           [self = this->shared_from_this()](const Error& error, std::size_t) {
                             if (error) return self->Shutdown();
                             self->WriteSome();
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
  std::unique_ptr<FileBeingSent> file_;  ///< nullptr if none is.
};

}  // namespace isotherm::web
