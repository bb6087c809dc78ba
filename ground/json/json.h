#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace isotherm {

/// A JSON document whose objects keep the order in which keys were first used. Sources that build
/// or read one include <nlohmann/json.hpp>.
using Json = nlohmann::ordered_json;

/// The text of `json`, indented and ending in a newline. NaN and infinity are written as null,
/// bytes that are not UTF-8 as U+FFFD; numbers do not depend on the locale and read back exactly.
std::string JsonText(const Json& json);

}  // namespace isotherm
