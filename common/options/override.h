#pragma once

#include <string_view>

#include "common/base/status.h"

namespace google::protobuf {
class Message;
}

namespace isotherm {

/// Applies `stage.field=value` (any depth: `a.b.c=value`). Of repeated fields only those of strings
/// are supported: the value is added. Names the stage or field that does not exist and lists those
/// that do, or says what it is called now.
Status ApplyOverride(std::string_view assignment, google::protobuf::Message& message);

}  // namespace isotherm
