#pragma once

#include <memory>

#include "ground/console/access.h"
#include "ground/console/live_session.h"
#include "ground/console/result_downloads.h"
#include "ground/console/static_page.h"
#include "ground/console/web_server.h"
#include "ground/options/ground_options.pb.h"

namespace isotherm {

/// Says what is found where: the page, /api, /live; and who may come in. Thread-bound to the I/O
/// thread.
class ConsoleRoutes {
 public:
  /// `session` must outlive it.
  ConsoleRoutes(LiveSession::Context& session, const ConsoleOptions& options, Access access)
      : session_(session), options_(options), access_(std::move(access)) {}

  /// They refer to this.
  WebHandlers Handlers();

 private:
  using Reply = std::function<void(WebReply)>;
  void Answer(const WebRequest& request, const Reply& reply);
  std::variant<AcceptedSocket, WebReply> Accept(const WebRequest& request);
  std::variant<AcceptedSocket, WebReply> AcceptFoxglove(const WebRequest& request, live::Role role);
  WebReply AnswerFromKept(const WebRequest& request) const;
  /// Returns the scan that is shown; an empty one if there is none.
  live::Scan KeptScan() const;

  LiveSession::Context& session_;
  const ConsoleOptions options_;
  Access access_;
  const StaticPage page_{};
  const ResultDownloads downloads_{};
};

}  // namespace isotherm
