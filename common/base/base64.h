#pragma once

#include <string>
#include <string_view>

namespace isotherm {

/// RFC 4648, section 4: letters, digits, + and /, padded.
std::string EncodeBase64(std::string_view bytes);

}  // namespace isotherm
