#pragma once

#include <span>
#include <string>
#include <string_view>

namespace isotherm {

/// The candidate that `name` is most likely a misspelling of (few edits, case ignored); empty if
/// none is close.
std::string NearestName(std::string_view name, std::span<const std::string> candidates);

/// " Did you mean 'x'?" or nothing, to be appended to a message.
std::string DidYouMean(std::string_view name, std::span<const std::string> candidates);

/// "a, b, c".
std::string JoinNames(std::span<const std::string> names);

}  // namespace isotherm
