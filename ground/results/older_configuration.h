#pragma once

#include <string>

#include "ground/json/json.h"

namespace google::protobuf {
class Descriptor;
}

namespace isotherm {

/// Options as an object that an older version has written, with the names that they have in `type`
/// now. What belongs to the rig file now, and what was text and is a group now, is left out.
Json WithPresentNames(const Json& options, const google::protobuf::Descriptor& type);

/// Options in text format, a field per line, as versions before 0.2 wrote them into stats.json, as
/// an object.
Json OptionsFromLines(const std::string& text);

}  // namespace isotherm
