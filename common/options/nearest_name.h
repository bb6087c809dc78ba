#pragma once

#include <functional>
#include <map>
#include <span>
#include <string>
#include <string_view>

namespace isotherm {

/// The candidate that `name` is most likely a misspelling of (few edits, case ignored); empty if
/// none is close.
std::string NearestName(std::string_view name, std::span<const std::string> candidates);

/// " Did you mean 'x'?" or nothing, to be appended to a message.
std::string DidYouMean(std::string_view name, std::span<const std::string> candidates);

/// For a command line that takes one of several names: replaces the name (case ignored) by its
/// number and returns nothing, or returns what is wrong and which names there are.
std::function<std::string(std::string&)> NumberOfName(std::map<std::string, int> names);

/// "a, b, c".
std::string JoinNames(std::span<const std::string> names);

}  // namespace isotherm
