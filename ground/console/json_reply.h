#pragma once

#include <google/protobuf/message.h>

#include <string>

#include "ground/console/web_server.h"

namespace isotherm {

/// Returns a reply of JSON that no cache keeps.
WebReply JsonReply(std::string json);
/// Returns a reply that shows all fields of `message` by the names that they have in its file, as
/// JSON.
WebReply JsonReply(const google::protobuf::Message& message);

}  // namespace isotherm
