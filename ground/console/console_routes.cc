#include "ground/console/console_routes.h"

#include <algorithm>

#include "ground/console/foxglove_session.h"
#include "ground/console/json_reply.h"
#include "ground/console/place_query.h"
#include "ground/console/text_reply.h"

namespace isotherm {

WebHandlers ConsoleRoutes::Handlers() {
  return {
      .request = [this](const WebRequest& request, const Reply& reply) { Answer(request, reply); },
      .socket = [this](const WebRequest& request) { return Accept(request); }};
}

live::Scan ConsoleRoutes::KeptScan() const {
  live::ServerMessage message;
  if (const LiveMessagePtr kept = session_.hub.Kept(LiveKind::kScan))
    message.ParseFromString(kept->bytes);
  return message.scan();
}

WebReply ConsoleRoutes::AnswerFromKept(const WebRequest& request) const {
  live::ServerMessage message;
  const LiveKind kind = request.path == "/api/state"  ? LiveKind::kState
                        : request.path == "/api/scan" ? LiveKind::kScan
                                                      : LiveKind::kMeasurements;
  if (const LiveMessagePtr kept = session_.hub.Kept(kind)) message.ParseFromString(kept->bytes);
  if (kind == LiveKind::kState) return JsonReply(message.state());
  if (kind == LiveKind::kScan) return JsonReply(message.scan());
  return JsonReply(message.measurements());
}

void ConsoleRoutes::Answer(const WebRequest& request, const Reply& reply) {
  WebReply answer;
  const bool is_api = request.path.starts_with("/api/");
  if (std::optional<WebReply> refusal = access_.Refusal(request)) {
    answer = std::move(*refusal);
  } else if (request.path == "/api/login") {
    answer = access_.LogIn(request);
  } else if (is_api && !access_.RoleOf(request)) {
    answer = TextReply(401, "log in first: POST the code to /api/login\n");
  } else if (request.path == kQueryPath) {
    const QueryContext context{.inbox = session_.inbox,
                               .now = session_.clock.SteadyNow(),
                               .is_growing = KeptScan().phase() == live::Scan::RUNNING};
    return AskForPlace(request, context, [reply](WebReply record) {
      AddSafetyHeaders(record);
      reply(std::move(record));
    });
  } else if (ResultDownloads::IsFor(request)) {
    answer = downloads_.Answer(request, KeptScan());
  } else if (request.path == "/api/state" || request.path == "/api/scan" ||
             request.path == "/api/measurements") {
    answer = AnswerFromKept(request);
  } else {
    answer = page_.Answer(request);
  }
  AddSafetyHeaders(answer);
  reply(std::move(answer));
}

std::variant<AcceptedSocket, WebReply> ConsoleRoutes::AcceptFoxglove(const WebRequest& request,
                                                                     live::Role role) {
  for (const std::string& offered : request.subprotocols) {
    if (std::ranges::find(kFoxgloveSubprotocols, offered) == std::end(kFoxgloveSubprotocols))
      continue;
    return AcceptedSocket{.handler = std::make_unique<FoxgloveSession>(session_, role),
                          .subprotocol = offered};
  }
  return TextReply(400, "the subprotocol must be foxglove.sdk.v1 or foxglove.websocket.v1\n");
}

std::variant<AcceptedSocket, WebReply> ConsoleRoutes::Accept(const WebRequest& request) {
  if (std::optional<WebReply> refusal = access_.Refusal(request)) return std::move(*refusal);
  const std::optional<live::Role> role = access_.RoleOf(request);
  if (!role) return TextReply(401, "log in first: POST the code to /api/login\n");
  if (session_.hub.clients() >= static_cast<std::size_t>(options_.expert().max_viewers()))
    return TextReply(503, "too many viewers (console.expert.max_viewers)\n");
  if (request.path == "/foxglove") return AcceptFoxglove(request, *role);
  if (request.path != "/live") return TextReply(404, "there is no such socket\n");
  if (std::ranges::find(request.subprotocols, kLiveSubprotocol) == request.subprotocols.end())
    return TextReply(400, "the subprotocol must be isotherm.live.v1\n");
  return AcceptedSocket{.handler = std::make_unique<LiveSession>(session_, *role),
                        .subprotocol = std::string(kLiveSubprotocol)};
}

}  // namespace isotherm
