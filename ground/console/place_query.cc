#include "ground/console/place_query.h"

#include <fmt/format.h>
#include <google/protobuf/util/json_util.h>

#include <utility>

#include "ground/console/json_reply.h"
#include "ground/console/text_reply.h"

namespace isotherm {

void AskForPlace(const WebRequest& request, const QueryContext& context,
                 std::function<void(WebReply)> reply) {
  if (request.method != "POST")
    return reply(TextReply(405, "POST a ray as JSON: docs/console.md shows one\n"));
  ClientQuery query;
  live::Pick& pick = *query.message.mutable_pick();
  const auto parsed = google::protobuf::util::JsonStringToMessage(request.body, &pick);
  if (!parsed.ok())
    return reply(TextReply(400, fmt::format("not a question: {}\n", parsed.message().ToString())));
  if (!pick.ray().has_origin() || !pick.ray().has_direction())
    return reply(TextReply(400, "not a question: ray.origin or ray.direction is missing\n"));
  if (!context.inbox.LookOn(context.now) && context.is_growing) {
    WebReply later = TextReply(
        503,
        "nobody looked at this scan, so that its surface was not copied; it is from now on for "
        "ten seconds after each question: ask again\n");
    later.headers = {{"Retry-After", "1"}};
    return reply(std::move(later));
  }
  query.reply = [reply = std::move(reply)](const live::Answer& answer) {
    reply(JsonReply(answer.record()));
  };
  context.inbox.Add(std::move(query));
}

}  // namespace isotherm
