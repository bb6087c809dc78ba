#pragma once

#include <functional>
#include <string_view>

#include "common/time/time_types.h"
#include "ground/console/console_inbox.h"
#include "ground/console/web_server.h"

namespace isotherm {

/// Address of questions about places, for programs: what a page asks with a Pick.
inline constexpr std::string_view kQueryPath = "/api/query";

/// Says whom a question about a place goes to.
struct QueryContext {
  ConsoleInbox& inbox;
  SteadyTime now;
  bool is_growing = false;  ///< The scan goes on: its surface is copied only while somebody looks.
};

/// Passes a question on to the console's thread. The body is a live::Pick as JSON, the answer a
/// measuring::VoxelRecord. `reply` is called at once if the question cannot be understood or
/// nobody has looked at a scan that goes on, otherwise on the console's thread; never, if that is
/// so far behind that it leaves questions out.
void AskForPlace(const WebRequest& request, const QueryContext& context,
                 std::function<void(WebReply)> reply);

}  // namespace isotherm
