#pragma once

#include <string>
#include <string_view>

namespace isotherm {

/// A page that needs nothing else. `title` is text, `body` HTML.
std::string HtmlPage(std::string_view title, std::string_view body);

/// A plot with what it shows below it; both are HTML.
std::string HtmlFigure(std::string_view svg, std::string_view caption);

}  // namespace isotherm
