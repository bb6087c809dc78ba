#pragma once

#include <string>
#include <string_view>

namespace google::protobuf {
class Descriptor;
}

namespace isotherm {

/// The present name of the option that `type` once called `name`; empty if it never had such a one.
std::string_view NameSinceRenaming(const google::protobuf::Descriptor& type, std::string_view name);

/// Options in text format, a field per line, as programs of earlier versions wrote them down: with
/// the present names.
std::string WithPresentNames(std::string text);

/// Returns the present name of the command-line flag that was once called `flag` ("--x" or
/// "--x=value"); empty if there was no such one.
std::string_view FlagSinceRenaming(std::string_view flag);

/// " It is called 'x' now." for an option that was renamed, else DidYouMean.
std::string SuggestOption(const google::protobuf::Descriptor& type, std::string_view name);

}  // namespace isotherm
