#pragma once

#include <string>
#include <string_view>

namespace isotherm {

/// `text` (protobuf text format, known to be well-formed) with the single-valued field `name` at
/// its top level set to `value`; comments and everything else stay as they are. A field that is not
/// there is added at the end.
std::string WithFieldSet(const std::string& text, std::string_view name, std::string_view value);

}  // namespace isotherm
