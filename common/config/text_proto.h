#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "common/base/status.h"
#include "common/geometry/camera.h"

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

/// Applies `stage.field=value` (any depth: `a.b.c=value`). Of repeated fields only those of strings
/// are supported: the value is added. Names the stage or field that does not exist and lists those
/// that do, or says what it is called now.
Status ApplyOverride(std::string_view assignment, google::protobuf::Message& message);

/// rig.textproto, checked (Validate) and converted. Messages name the file and the field.
Result<Rig> LoadRigCalibration(const std::filesystem::path& path);
Result<Rig> ParseRigCalibration(const std::string& text, std::string_view source_name);
std::string ToText(const Rig& rig);

}  // namespace isotherm
