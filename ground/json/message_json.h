#pragma once

#include <string_view>

#include "common/base/status.h"
#include "ground/json/json.h"

namespace google::protobuf {
class Message;
}

namespace isotherm {

/// `message` as a JSON object, defaults included, with the field names of its text format. Enums
/// are written by name, 64-bit integers as numbers; NaN and infinity as the strings "NaN",
/// "Infinity" and "-Infinity", as Protobuf's own JSON has them.
Json ToJson(const google::protobuf::Message& message);

/// Reads back what ToJson has written. A field or a value that `message` does not know is an error
/// that begins with `source_name`.
Status FromJson(const Json& json, std::string_view source_name, google::protobuf::Message& message);

}  // namespace isotherm
