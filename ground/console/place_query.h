#pragma once

#include <functional>

#include "ground/console/console_inbox.h"
#include "ground/console/web_server.h"

namespace isotherm {

/// Address of questions about places, for programs: what a page asks with a Pick.
inline constexpr std::string_view kQueryPath = "/api/query";

/// Passes a question on to the console's thread. The body is a live::Pick as JSON, the answer a
/// measuring::VoxelRecord. `reply` is called once: at once if the question cannot be understood,
/// otherwise on the console's thread.
void AskForPlace(const WebRequest& request, ConsoleInbox& inbox,
                 std::function<void(WebReply)> reply);

}  // namespace isotherm
