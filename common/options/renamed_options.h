#pragma once

#include <span>
#include <string>
#include <string_view>

namespace google::protobuf {
class Descriptor;
}

namespace isotherm {

/// Names an option that was called or placed differently once.
struct RenamedOption {
  /// Tells where the option was written: in options, or in the rig file.
  enum class Place { kOptions, kRigFile };

  std::string_view type;    ///< The message that it was in, without the package.
  std::string_view before;  ///< Its name there, which is reserved now.
  std::string_view now;  ///< Its name now, dotted, seen from that message (or from the rig file).
  Place place = Place::kOptions;
};

/// Returns the present name of the command-line flag that was once called `flag` ("--x" or
/// "--x=value"); empty if there was no such one.
std::string_view FlagSinceRenaming(std::string_view flag);

std::span<const RenamedOption> RenamedOptions();

/// Returns what `type` once called `name`; nullptr if it never had such a one.
const RenamedOption* FindRenamed(const google::protobuf::Descriptor& type, std::string_view name);

/// Returns " It is called 'x' now." for an option that was renamed, else DidYouMean. `parent` is
/// where the message stands, if that is known: "tsdf".
std::string SuggestOption(const google::protobuf::Descriptor& type, std::string_view name,
                          std::string_view parent = {});

}  // namespace isotherm
