#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "common/base/status.h"

namespace google::protobuf {
class Message;
}

namespace isotherm {

/// Reads protobuf text format strictly: an unknown field, a wrong type or a missing required field
/// is an error that names file, line and column; all of them are listed, not only the first.
Status ParseTextProto(const std::string& text, std::string_view source_name,
                      google::protobuf::Message& message);
Status LoadTextProto(const std::filesystem::path& path, google::protobuf::Message& message);

/// Text format of `message`, defaults included, as it goes into logs and recordings.
std::string ToTextProto(const google::protobuf::Message& message);

}  // namespace isotherm
