#pragma once

#include <string>
#include <string_view>

namespace isotherm {

/// Returns `text` for a terminal or a log, whoever wrote it: control characters, which a terminal
/// would carry out, bytes that are no UTF-8, and characters that change the direction of writing
/// become `\x1b` and the like. A line break too, so that no text can pretend to be a line of its
/// own.
std::string Printable(std::string_view text);

/// The same, but line breaks stay: for texts of ours that quote others.
std::string PrintableLines(std::string_view text);

}  // namespace isotherm
