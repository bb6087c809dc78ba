#pragma once

#include <map>
#include <string>
#include <string_view>

#include "common/messages/messages.h"

namespace isotherm {

/// Name of the metadata in a recording that tells how good the wall clock was that stamped its
/// frames.
inline constexpr std::string_view kClockMetadata = "clock";

/// `synchronised` (yes, no) and, if it is, `offset_s`, `estimated_error_s` and `max_error_s`.
std::map<std::string, std::string> ToMetadata(const ClockReport& clock);

}  // namespace isotherm
