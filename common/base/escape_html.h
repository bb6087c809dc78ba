#pragma once

#include <string>
#include <string_view>

namespace isotherm {

/// Returns the text with &, <, > and " as entities, for text and quoted attributes of HTML and SVG.
std::string EscapeHtml(std::string_view text);

}  // namespace isotherm
