#pragma once

#include <string>

#include "ground/json/json.h"
#include "ground/offline/held_out_report.h"

namespace isotherm {

/// What `isotherm evaluate --held-out-views` says.
std::string ToText(const HeldOutReport& report);
Json ToJson(const HeldOutReport& report);

}  // namespace isotherm
